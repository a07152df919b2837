//! What every sampled density is to the kernels: a set-up, an inverse and a pdf.

use crate::geometry::{Geometry, Point};
use crate::integrand::MediumLanes;
use crate::simd::Isa;

/// A density of which the instruction set is open.
pub(crate) trait Kind {
    type On<I: Isa>: Density<I>;
}

/// A density over the distances of a lane group of rays, set up for one geometry and medium.
pub(crate) trait Density<I: Isa>: Sized {
    /// What does not depend on the variate.
    fn new(isa: I, geometry: &Geometry<I>, medium: &MediumLanes<I>) -> Self;

    /// The point where the CDF is `u`, increasing in `u`.
    fn invert(&self, isa: I, geometry: &Geometry<I>, u: I::V) -> Drawn<I>;

    /// The density at a point of the support.
    fn pdf(&self, isa: I, geometry: &Geometry<I>, point: &Point<I>) -> Pdf<I>;

    /// Which lanes can be sampled.
    #[cfg_attr(optimized, inline(always))]
    fn lit(_: I, geometry: &Geometry<I>) -> I::Mask {
        geometry.lit
    }

    /// The distances `[low, high]` that are sampled \[m\].
    #[cfg_attr(optimized, inline(always))]
    fn support(geometry: &Geometry<I>) -> [I::V; 2] {
        [geometry.a.t, geometry.b.t]
    }
}

/// A point that was drawn.
pub(crate) struct Drawn<I: Isa> {
    pub(crate) point: Point<I>,
    pub(crate) pdf: Pdf<I>,
    /// Which lanes fell back to bisection.
    pub(crate) bisected: I::Mask,
}

/// A density at a point.
pub(crate) struct Pdf<I: Isa> {
    /// Over distance \[1/m\].
    pub(crate) over_t: I::V,
    /// The same times `r^2` \[m\]: where it is known as such, `1/r^2` cancels against the integrand's.
    pub(crate) times_r2: I::V,
}

impl<I: Isa> Pdf<I> {
    /// From a density over the angle at the emitter, `dtheta = h dt / r^2`.
    #[cfg_attr(optimized, inline(always))]
    pub(crate) fn over_angle(p_theta: I::V, geometry: &Geometry<I>, point: &Point<I>) -> Self {
        let times_r2 = p_theta * geometry.h;
        Self { over_t: times_r2 / geometry.r_squared(point.t_prime), times_r2 }
    }

    /// From a density over distance.
    #[cfg_attr(optimized, inline(always))]
    pub(crate) fn over_distance(over_t: I::V, r: I::V) -> Self {
        Self { over_t, times_r2: over_t * (r * r) }
    }
}
