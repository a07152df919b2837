//! The source of each ray's emitter or medium: one for all, columns, or a table with an index per ray.

use super::{MOST_RAYS, cut};
use crate::Error;
use crate::simd::{Isa, Lanes};
use core::ops::Range;

/// An emitter or a medium, described by `K` numbers.
pub(crate) trait Entry<const K: usize>: Copy {
    /// The names in errors of its columns, of a table, and of the index into a table.
    const COLUMNS: [&'static str; K];
    const TABLE: &'static str;
    const INDEX: &'static str;

    /// Its numbers, in the order of the columns.
    fn row(&self) -> [f32; K];
}

/// One `T` for each ray.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Source<'a, T, const K: usize> {
    /// The same for all.
    One(T),
    /// As columns of the batch's length.
    Each([&'a [f32]; K]),
    /// An index into a table; an index out of range makes the ray invalid.
    Table { table: &'a [T], index: &'a [u32] },
}

impl<'a, T: Entry<K>, const K: usize> Source<'a, T, K> {
    /// `Ok` if there is one for each of `rays` rays.
    pub(super) fn check(&self, rays: usize) -> Result<(), Error> {
        match *self {
            Self::One(_) => Ok(()),
            Self::Each(columns) => {
                let mut columns = T::COLUMNS.into_iter().zip(columns);
                columns.try_for_each(|(field, column)| Error::unless_length(field, column.len(), rays))
            }
            Self::Table { table: [], .. } => Err(Error::Empty { field: T::TABLE }),
            Self::Table { index, .. } => Error::unless_length(T::INDEX, index.len(), rays),
        }
    }

    /// The source of the rays of `range`.
    pub(super) fn part(&self, range: Range<usize>) -> Self {
        match *self {
            Self::One(one) => Self::One(one),
            Self::Each(columns) => Self::Each(columns.map(|column| &column[range.clone()])),
            Self::Table { table, index } => Self::Table { table, index: &index[range] },
        }
    }

    /// Whether rays may differ.
    pub(crate) fn differs(&self) -> bool {
        !matches!(self, Self::One(_))
    }

    /// The rows of the rays of `range`, at most [`MOST_RAYS`]; entries of a table are gathered in `place`.
    pub(crate) fn rows<'r, const MOST: usize>(&self, range: Range<usize>, place: &'r mut Gathered<MOST>) -> Rows<'r, K>
    where
        'a: 'r,
    {
        match *self {
            Self::One(one) => Rows::One(one.row()),
            Self::Each(columns) => Rows::Each(columns.map(|column| &column[range.clone()])),
            Self::Table { table, index } => Rows::Each(place.gather(table, &index[range])),
        }
    }
}

/// The numbers of `table[index]`; NaN for an index out of range.
pub(super) fn row_of<T: Entry<K>, const K: usize>(table: &[T], index: u32) -> [f32; K] {
    table.get(index as usize).map_or([f32::NAN; K], T::row)
}

/// Storage for at most `K` columns of some rays.
pub(crate) struct Gathered<const K: usize>(Option<[[f32; MOST_RAYS]; K]>);

impl<const K: usize> Gathered<K> {
    /// Empty storage.
    pub(crate) fn new() -> Self {
        Self(None)
    }

    /// The entries `table[index]` as columns.
    fn gather<T: Entry<J>, const J: usize>(&mut self, table: &[T], index: &[u32]) -> [&[f32]; J] {
        self.fill(index.len(), |ray| row_of(table, index[ray]))
    }

    /// A row for each of `rays` rays, as columns.
    #[inline]
    pub(super) fn fill<const J: usize>(&mut self, rays: usize, row: impl Fn(usize) -> [f32; J]) -> [&[f32]; J] {
        const { assert!(J <= K) };
        let columns = match &mut self.0 {
            Some(columns) => columns,
            none => none.insert([[0.0; MOST_RAYS]; K]),
        };
        for ray in 0..rays {
            for (column, value) in columns.iter_mut().zip(row(ray)) {
                column[ray] = value;
            }
        }
        std::array::from_fn(|k| &columns[k][..rays])
    }
}

/// The numbers of the emitters or media of some rays.
#[derive(Clone, Copy)]
pub(crate) enum Rows<'r, const K: usize> {
    /// The same for all.
    One([f32; K]),
    Each([&'r [f32]; K]),
}

impl<'r, const K: usize> Rows<'r, K> {
    /// The rows of the rays of `range`.
    pub(crate) fn part(&self, range: Range<usize>) -> Self {
        match *self {
            Self::One(row) => Self::One(row),
            Self::Each(columns) => Self::Each(columns.map(|column| &column[range.clone()])),
        }
    }

    /// Some of the numbers. No closure: kernels call this.
    #[cfg_attr(optimized, inline(always))]
    pub(super) fn select<const J: usize>(&self, numbers: [usize; J]) -> Rows<'r, J> {
        let mut j = 0;
        match self {
            Self::One(row) => {
                let mut some = [0.0; J];
                while j < J {
                    some[j] = row[numbers[j]];
                    j += 1;
                }
                Rows::One(some)
            }
            Self::Each(columns) => {
                let mut some = [columns[0]; J];
                while j < J {
                    some[j] = columns[numbers[j]];
                    j += 1;
                }
                Rows::Each(some)
            }
        }
    }

    /// The rows in lane groups. No closure: one that is not inlined costs more than the load.
    #[cfg_attr(optimized, inline(always))]
    pub(crate) fn groups<I: Isa>(&self, isa: I) -> RowGroups<'r, I, K> {
        match *self {
            Self::One(row) => {
                let mut lanes = [isa.splat(0.0); K];
                let mut k = 0;
                while k < K {
                    lanes[k] = isa.splat(row[k]);
                    k += 1;
                }
                RowGroups::One(lanes)
            }
            Self::Each(columns) => {
                // Equal lengths remove bounds checks.
                let count = columns[0].len() / I::V::N;
                let mut groups = [cut::<I>(columns[0], count); K];
                let mut k = 1;
                while k < K {
                    groups[k] = cut::<I>(columns[k], count);
                    k += 1;
                }
                RowGroups::Each(groups)
            }
        }
    }
}

/// The same in lane groups.
pub(crate) enum RowGroups<'r, I: Isa, const K: usize> {
    One([I::V; K]),
    Each([&'r [I::Group]; K]),
}

impl<I: Isa, const K: usize> RowGroups<'_, I, K> {
    /// Whether rays may differ.
    #[cfg_attr(optimized, inline(always))]
    pub(crate) fn differ(&self) -> bool {
        matches!(self, Self::Each(_))
    }

    /// The numbers of lane group `index`.
    #[cfg_attr(optimized, inline(always))]
    pub(crate) fn lanes(&self, isa: I, index: usize) -> [I::V; K] {
        match self {
            Self::One(lanes) => *lanes,
            Self::Each(groups) => {
                let mut lanes = [isa.splat(0.0); K];
                let mut k = 0;
                while k < K {
                    lanes[k] = isa.load(&groups[k][index]);
                    k += 1;
                }
                lanes
            }
        }
    }
}
