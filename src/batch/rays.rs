//! Columns of rays.

use super::cut;
use crate::geometry::RayLanes;
use crate::simd::{Isa, Lanes};
use core::ops::Range;

/// A batch of rays as a structure of arrays; every column has the length of the batch and any alignment.
///
/// The values are those of [`Ray::new`](crate::Ray::new). A ray with a value out of the range given there is *invalid*: it is
/// counted, and its outputs are 0. (The tolerance of lengths of directions and normals is checked by their squares, with a slack
/// of 1e-6.)
///
/// Only [`Rays::new`] makes rays, so that later versions can add columns.
#[derive(Clone, Copy, Debug)]
#[non_exhaustive]
pub struct Rays<'a> {
    /// Origins: x, y, z \[m\].
    pub origin: [&'a [f32]; 3],
    /// Directions: x, y, z, of length 1 within [`UNIT_TOLERANCE`](crate::UNIT_TOLERANCE).
    pub direction: [&'a [f32]; 3],
    /// Distances at which the rays enter the medium \[m\].
    pub t_min: &'a [f32],
    /// Distances at which the rays leave the medium \[m\]; may be infinite.
    pub t_max: &'a [f32],
}

impl<'a> Rays<'a> {
    /// Rays from `origin` along `direction` (x, y, z each), in the medium from `t_min` to `t_max`. The calls that take them
    /// check the lengths of the columns.
    ///
    /// ```
    /// # use airlight::Rays;
    /// let (zero, one, t_max) = ([0.0; 2], [1.0; 2], [4.0, f32::INFINITY]);
    /// let rays = Rays::new([&zero; 3], [&zero, &zero, &one], &zero, &t_max);
    /// assert_eq!(rays.len(), 2);
    /// ```
    #[must_use]
    pub fn new(origin: [&'a [f32]; 3], direction: [&'a [f32]; 3], t_min: &'a [f32], t_max: &'a [f32]) -> Self {
        Self { origin, direction, t_min, t_max }
    }

    /// The number of rays: the length of `origin[0]`.
    #[must_use]
    pub fn len(&self) -> usize {
        self.origin[0].len()
    }

    /// Whether there are no rays.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    pub(super) fn part(&self, range: Range<usize>) -> Self {
        Self {
            origin: self.origin.map(|column| &column[range.clone()]),
            direction: self.direction.map(|column| &column[range.clone()]),
            t_min: &self.t_min[range.clone()],
            t_max: &self.t_max[range],
        }
    }

    /// The rays in lane groups.
    #[cfg_attr(optimized, inline(always))]
    pub(super) fn groups<I: Isa>(&self) -> RayGroups<'a, I> {
        let count = self.len() / I::V::N;
        let [ox, oy, oz] = self.origin;
        let [dx, dy, dz] = self.direction;
        RayGroups {
            origin: [cut::<I>(ox, count), cut::<I>(oy, count), cut::<I>(oz, count)],
            direction: [cut::<I>(dx, count), cut::<I>(dy, count), cut::<I>(dz, count)],
            t_min: cut::<I>(self.t_min, count),
            t_max: cut::<I>(self.t_max, count),
        }
    }
}

/// Columns of rays cut into lane groups, all of the same number.
pub(crate) struct RayGroups<'a, I: Isa> {
    origin: [&'a [I::Group]; 3],
    direction: [&'a [I::Group]; 3],
    t_min: &'a [I::Group],
    t_max: &'a [I::Group],
}

impl<I: Isa> RayGroups<'_, I> {
    /// Prefetches the rays of the group `ahead` groups after `index`.
    #[cfg_attr(optimized, inline(always))]
    pub(crate) fn prefetch(&self, isa: I, index: usize, ahead: usize) {
        let ([ox, oy, oz], [dx, dy, dz]) = (&self.origin, &self.direction);
        for column in [ox, oy, oz, dx, dy, dz, &self.t_min, &self.t_max] {
            isa.prefetch(&column[index], ahead);
        }
    }

    /// The rays of one group.
    #[cfg_attr(optimized, inline(always))]
    pub(crate) fn lanes(&self, isa: I, index: usize) -> RayLanes<I> {
        RayLanes {
            origin: load(isa, &self.origin, index),
            direction: load(isa, &self.direction, index),
            t_min: isa.load(&self.t_min[index]),
            t_max: isa.load(&self.t_max[index]),
        }
    }
}

/// One group of each column.
#[cfg_attr(optimized, inline(always))]
fn load<I: Isa>(isa: I, [x, y, z]: &[&[I::Group]; 3], index: usize) -> [I::V; 3] {
    [isa.load(&x[index]), isa.load(&y[index]), isa.load(&z[index])]
}
