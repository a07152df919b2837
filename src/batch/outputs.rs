//! The columns that a call writes, and how they are split.

use super::{Pad, Run};
use crate::simd::MOST_LANES;
use core::ops::Range;

/// The columns that a call writes, wherever they are.
pub(crate) trait Outputs {
    type At<'a>: Send;

    /// Their first `k` values, and the rest.
    fn split_at<'a>(out: Self::At<'a>, k: usize) -> (Self::At<'a>, Self::At<'a>);

    /// Those of `range`, borrowed.
    fn part<'b>(out: &'b mut Self::At<'_>, range: Range<usize>) -> Self::At<'b>;

    /// Has `write` write the values of a run, which for it lie next to each other.
    fn of_run<R>(out: &mut Self::At<'_>, run: Run<'_>, write: impl FnOnce(Self::At<'_>) -> R) -> R;

    /// Has `write` write to pads, and takes from there as many values as there are.
    fn by_pads<R>(out: Self::At<'_>, write: impl FnOnce(Self::At<'_>) -> R) -> R;
}

/// One column.
pub(crate) struct Column;

impl Outputs for Column {
    type At<'a> = &'a mut [f32];

    fn split_at<'a>(out: Self::At<'a>, k: usize) -> (Self::At<'a>, Self::At<'a>) {
        out.split_at_mut(k)
    }

    fn part<'b>(out: &'b mut Self::At<'_>, range: Range<usize>) -> Self::At<'b> {
        &mut out[range]
    }

    fn of_run<R>(out: &mut Self::At<'_>, run: Run<'_>, write: impl FnOnce(&mut [f32]) -> R) -> R {
        match run.together() {
            Some(range) => write(&mut out[range]),
            None => run.scatter(out, write),
        }
    }

    fn by_pads<R>(out: &mut [f32], write: impl FnOnce(&mut [f32]) -> R) -> R {
        let mut pad: Pad = [0.0; MOST_LANES];
        let result = write(&mut pad);
        out.copy_from_slice(&pad[..out.len()]);
        result
    }
}
