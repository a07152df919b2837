//! The output columns of a call, and their division into parts.

use super::runs::RunPad;
use super::{Pad, Run};
use crate::simd::MOST_LANES;
use core::ops::Range;

/// The output columns of a task.
pub(crate) trait Outputs {
    type At<'a>: Send;

    /// The first `k` values, and the rest.
    fn split_at<'a>(out: Self::At<'a>, k: usize) -> (Self::At<'a>, Self::At<'a>);

    /// The values of `range`, borrowed.
    fn part<'b>(out: &'b mut Self::At<'_>, range: Range<usize>) -> Self::At<'b>;

    /// Calls `write` with pads, and copies from these as many values as the columns have.
    fn by_pads<R>(out: Self::At<'_>, write: impl FnOnce(Self::At<'_>) -> R) -> R;
}

/// The output columns of a task that may have several values per ray.
pub(crate) trait OfRuns: Outputs {
    /// Calls `write` with columns in which the values of a run lie next to each other.
    fn of_run<R>(out: &mut Self::At<'_>, run: Run<'_>, write: impl FnOnce(Self::At<'_>) -> R) -> R;
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

    fn by_pads<R>(out: &mut [f32], write: impl FnOnce(&mut [f32]) -> R) -> R {
        let mut pad: Pad = [0.0; MOST_LANES];
        let result = write(&mut pad);
        out.copy_from_slice(&pad[..out.len()]);
        result
    }
}

impl OfRuns for Column {
    fn of_run<R>(out: &mut Self::At<'_>, run: Run<'_>, write: impl FnOnce(&mut [f32]) -> R) -> R {
        match run.together() {
            Some(range) => write(&mut out[range]),
            None => run.scatter(out, write),
        }
    }
}

/// `N` optional columns.
pub(crate) struct Columns<const N: usize>;

/// The given columns as the first ones of `N` optional columns.
pub(crate) fn columns<const N: usize, const C: usize>(given: [&mut [f32]; C]) -> [Option<&mut [f32]>; N] {
    let mut given = given.into_iter();
    [(); N].map(|()| given.next())
}

impl<const N: usize> Outputs for Columns<N> {
    type At<'a> = [Option<&'a mut [f32]>; N];

    fn split_at<'a>(out: Self::At<'a>, k: usize) -> (Self::At<'a>, Self::At<'a>) {
        let mut rest = [const { None }; N];
        let mut at = 0;
        let low = out.map(|column| {
            let (low, high) = column.map(|column| column.split_at_mut(k)).unzip();
            rest[at] = high;
            at += 1;
            low
        });
        (low, rest)
    }

    fn part<'b>(out: &'b mut Self::At<'_>, range: Range<usize>) -> Self::At<'b> {
        out.each_mut().map(|column| column.as_mut().map(|column| &mut column[range.clone()]))
    }

    fn by_pads<R>(out: Self::At<'_>, write: impl FnOnce(Self::At<'_>) -> R) -> R {
        let mut pads: [Pad; N] = [[0.0; MOST_LANES]; N];
        let wanted = out.each_ref().map(Option::is_some);
        let mut is_wanted = wanted.into_iter();
        let result = write(pads.each_mut().map(|pad| is_wanted.next().unwrap_or(false).then_some(&mut pad[..])));
        for (column, pad) in out.into_iter().zip(pads) {
            if let Some(column) = column {
                column.copy_from_slice(&pad[..column.len()]);
            }
        }
        result
    }
}

impl<const N: usize> OfRuns for Columns<N> {
    fn of_run<R>(out: &mut Self::At<'_>, run: Run<'_>, write: impl FnOnce(Self::At<'_>) -> R) -> R {
        if let Some(range) = run.together() {
            return write(Self::part(out, range));
        }
        let mut pads = out.each_ref().map(|column| column.is_some().then(RunPad::new));
        let result = write(pads.each_mut().map(|pad| pad.as_mut().map(|pad| pad.of(run))));
        for (column, pad) in out.iter_mut().zip(&pads) {
            if let (Some(column), Some(pad)) = (column, pad) {
                run.copy(pad, column);
            }
        }
        result
    }
}

/// The entry of a table that was chosen for each ray, and its probability.
pub(crate) struct Choices;

impl Outputs for Choices {
    type At<'a> = (&'a mut [u32], &'a mut [f32]);

    fn split_at<'a>((index, probability): Self::At<'a>, k: usize) -> (Self::At<'a>, Self::At<'a>) {
        let (index, index_rest) = index.split_at_mut(k);
        let (probability, probability_rest) = probability.split_at_mut(k);
        ((index, probability), (index_rest, probability_rest))
    }

    fn part<'b>((index, probability): &'b mut Self::At<'_>, range: Range<usize>) -> Self::At<'b> {
        (&mut index[range.clone()], &mut probability[range])
    }

    fn by_pads<R>((index, probability): Self::At<'_>, write: impl FnOnce(Self::At<'_>) -> R) -> R {
        let mut pad = [0; MOST_LANES];
        let result = Column::by_pads(probability, |probability| write((&mut pad, probability)));
        index.copy_from_slice(&pad[..index.len()]);
        result
    }
}
