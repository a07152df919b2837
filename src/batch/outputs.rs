//! The columns that a call writes, and how they are split.

use super::runs::RunPad;
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

    /// Has `write` write to pads, and takes from there as many values as there are.
    fn by_pads<R>(out: Self::At<'_>, write: impl FnOnce(Self::At<'_>) -> R) -> R;
}

/// Those of a task that has several values for a ray.
pub(crate) trait OfRuns: Outputs {
    /// Has `write` write the values of a run, which for it lie next to each other.
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

/// Some columns, of which some are wanted.
pub(crate) struct Columns<const N: usize>;

/// The first ones of `N` columns.
pub(crate) fn columns<'a, const N: usize, const C: usize>(given: [&'a mut [f32]; C]) -> [Option<&'a mut [f32]>; N] {
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

/// Which entry of a table was chosen for each ray, and with what probability.
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
