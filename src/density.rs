//! The interface of a sampled density to the kernels: set-up, draw, point, pdf and CDF.

use crate::Precision;
use crate::geometry::{Extent, Geometry, Point, RayLanes};
use crate::integrand::{ChannelLanes, MediumLanes};
use crate::simd::{Isa, Lanes, Room};

/// A density, generic over the instruction set.
pub(crate) trait Kind {
    type On<I: Isa>: Density<I>;
}

/// A density over the distances of a lane group of rays, set up for one geometry and medium.
pub(crate) trait Density<I: Isa>: Copy {
    /// The part of the geometry that samples and their pdf need.
    const EXTENT: Extent;
    /// The part of the geometry that the pdf and the CDF at a given distance need.
    const EXTENT_AT_DISTANCE: Extent = Self::EXTENT;
    /// Whether the set-up depends on the precision; then the set-up alone is compiled for both. A density of which more depends on it
    /// has a type for each precision.
    const HAS_FAST_SET_UP: bool = false;
    /// The place of a variate, in the terms of the density; [`point`](Self::point) makes a point of the ray of it.
    type Place: Copy;
    /// Storage for the set-ups of a block. Its capacity limits the lane groups of a block where set-ups are large.
    type SetUps: Room<SetUp<I, Self>>;

    /// The set-up: what does not depend on the variate, and which lanes can be sampled. For coloured media `medium` is the mean.
    fn new(
        isa: I,
        precision: Precision,
        ray: &RayLanes<I>,
        geometry: Geometry<'_, I>,
        medium: &MediumLanes<I>,
        channels: Option<&ChannelLanes<I>>,
    ) -> (Self, I::Mask);

    /// The place where the CDF is `u`; it increases with `u`.
    fn draw(&self, isa: I, geometry: Geometry<'_, I>, u: I::V) -> Self::Place;

    /// The point of the ray at a place, and the density there.
    fn point(&self, isa: I, geometry: Geometry<'_, I>, place: &Self::Place) -> Drawn<I>;

    /// The density at a point of the sampled interval.
    fn pdf(&self, isa: I, geometry: Geometry<'_, I>, point: &Point<I>) -> Pdf<I>;

    /// The distribution function at a point of the sampled interval, which may lie outside by rounding.
    fn cdf(&self, isa: I, geometry: Geometry<'_, I>, point: &Point<I>) -> I::V;

    /// Whether `t` is at or before the start of the sampled interval, and at or beyond its end. Unlike
    /// [`support`](Self::support) this compares with ends that are not rounded.
    #[cfg_attr(optimized, inline(always))]
    fn outside(&self, isa: I, geometry: Geometry<'_, I>, t: I::V) -> [I::Mask; 2] {
        [geometry.way_from_a(isa, t).le(isa.splat(0.0)), geometry.way_to_b(isa, t).le(isa.splat(0.0))]
    }

    /// The sampled interval `[low, high]` of distances \[m\].
    #[cfg_attr(optimized, inline(always))]
    fn support(&self, geometry: Geometry<'_, I>) -> [I::V; 2] {
        [geometry.lit.a, geometry.lit.b]
    }
}

/// The density of a lane group.
#[derive(Clone, Copy)]
pub(crate) struct SetUp<I: Isa, D> {
    pub(crate) density: D,
    /// Which lanes hold a valid ray, emitter and medium.
    pub(crate) valid: I::Mask,
    /// Which lanes can be sampled.
    pub(crate) lit: I::Mask,
}

impl<I: Isa, D: Density<I>> SetUp<I, D> {
    #[cfg_attr(optimized, inline(always))]
    pub(crate) fn new(
        isa: I,
        precision: Precision,
        ray: &RayLanes<I>,
        geometry: Geometry<'_, I>,
        medium: &MediumLanes<I>,
        channels: Option<&ChannelLanes<I>>,
    ) -> Self {
        let (density, lit) = D::new(isa, precision, ray, geometry, medium, channels);
        Self { density, valid: geometry.valid & medium.valid, lit }
    }
}

/// A sampled point.
#[derive(Clone, Copy)]
pub(crate) struct Drawn<I: Isa> {
    pub(crate) point: Point<I>,
    pub(crate) pdf: Pdf<I>,
    /// Which lanes fell back to bisection.
    pub(crate) bisected: I::Mask,
}

/// A density at a point.
#[derive(Clone, Copy)]
pub(crate) struct Pdf<I: Isa> {
    /// Over distance \[1/m\].
    pub(crate) over_t: I::V,
    /// The same times `r^2` \[m\]: next to the emitter it cancels the integrand's `1/r^2` before that overflows.
    pub(crate) times_r2: I::V,
}

impl<I: Isa> Pdf<I> {
    /// (1.8): from a density `p / mass` over the angle at the emitter, `dtheta = h dt / r^2`.
    #[cfg_attr(optimized, inline(always))]
    pub(crate) fn over_angle(p: I::V, mass: I::V, geometry: Geometry<'_, I>, point: &Point<I>) -> Self {
        let p_h = p * geometry.foot.h;
        // In this order no intermediate result leaves f32 before the density does.
        Self { over_t: (p_h / geometry.foot.r_squared(point.t_prime)) / mass, times_r2: p_h / mass }
    }

    /// From a density over distance.
    #[cfg_attr(optimized, inline(always))]
    pub(crate) fn over_distance(over_t: I::V, r: I::V) -> Self {
        Self { over_t, times_r2: (over_t * r) * r }
    }
}
