//! Free-flight sampling, cut off at `t_max`.
//!
//! With `s = t - t_min` and `l = t_max - t_min`, equations of `docs/mathematics.md`:
//!
//! ```text
//! p_t = mu_t exp(-mu_t s) / (1 - exp(-mu_t l))                             (3.1)
//! s = -ln(1 - u (1 - exp(-mu_t l))) / mu_t                                 (3.2)
//! CDF = (1 - exp(-mu_t s)) / (1 - exp(-mu_t l))
//! ```
//!
//! Departures from this, and why:
//!
//! 1. The argument of the logarithm is `(1 - u) + u exp(-mu_t l)`, exact where it is small.
//! 2. Where `mu_t l` is below 1e-30 the density is constant: (3.1) would divide 0 by 0.
//! 3. The argument of the logarithm is at least 1e-37, so that the pdf of `u` = 1 is not 0.

use crate::Precision;
use crate::density::{self, Density, Drawn, Pdf, SetUp};
use crate::geometry::{Extent, Geometry, Point, RayLanes};
use crate::integrand::{ChannelLanes, MediumLanes};
use crate::simd::math::{exp, neg_ln_1m, one_minus_exp};
use crate::simd::{Isa, Lanes, Number, Records, none};

pub(crate) struct Kind;

impl density::Kind for Kind {
    type On<I: Isa> = Transmittance<I>;
}

#[derive(Clone, Copy)]
pub(crate) struct Transmittance<I: Isa> {
    mu_t: I::V,
    t_min: I::V,
    t_max: I::V,
    /// `1 - exp(-mu_t l)`, and `exp(-mu_t l)`.
    absorbed: I::V,
    passed: I::V,
    /// `l`
    length: I::V,
    /// Which lanes have so small a `mu_t l` that the density is constant.
    uniform: I::Mask,
}

impl<I: Isa> Transmittance<I> {
    /// The density at the distance `s` from `t_min` \[1/m\].
    #[cfg_attr(optimized, inline(always))]
    fn at(&self, isa: I, s: I::V) -> I::V {
        // (3.1)
        let falling = exp(isa, -(self.mu_t.widen() * s.widen())) * (self.mu_t / self.absorbed);
        I::V::select(self.uniform, isa.splat(1.0) / self.length, falling)
    }
}

impl<I: Isa> Density<I> for Transmittance<I> {
    const EXTENT: Extent = Extent::Lit;
    /// The distance from `t_min` \[m\].
    type Place = I::V;
    type SetUps = Records<SetUp<I, Self>>;

    /// A lane is sampled if any part of its ray is lit; which part does not matter.
    #[cfg_attr(optimized, inline(always))]
    fn new(
        isa: I,
        _: Precision,
        ray: &RayLanes<I>,
        geometry: Geometry<'_, I>,
        medium: &MediumLanes<I>,
        _: Option<&ChannelLanes<I>>,
    ) -> (Self, I::Mask) {
        let (mu_t, t_min, t_max) = (medium.mu_t, ray.t_min, ray.end(isa));
        let length = t_max - t_min;
        let depth = mu_t * length;
        let (absorbed, passed) = one_minus_exp(isa, depth);
        let uniform = depth.lt(isa.splat(1e-30));
        (Self { mu_t, t_min, t_max, absorbed, passed, length, uniform }, geometry.faced(isa))
    }

    #[cfg_attr(optimized, inline(always))]
    fn draw(&self, isa: I, _: Geometry<'_, I>, u: I::V) -> I::V {
        // (3.2)
        let remaining = u.mul_add(self.passed, isa.splat(1.0) - u).max(isa.splat(1e-37));
        let depth = neg_ln_1m(isa, u * self.absorbed, remaining);
        I::V::select(self.uniform, u * self.length, depth / self.mu_t).min(self.length)
    }

    #[cfg_attr(optimized, inline(always))]
    fn point(&self, isa: I, geometry: Geometry<'_, I>, s: &I::V) -> Drawn<I> {
        let point = geometry.point_beyond(isa, self.t_min, *s, self.t_max);
        let pdf = Pdf::over_distance(self.at(isa, *s), point.r);
        Drawn { point, pdf, bisected: none(isa) }
    }

    #[cfg_attr(optimized, inline(always))]
    fn pdf(&self, isa: I, _: Geometry<'_, I>, point: &Point<I>) -> Pdf<I> {
        Pdf::over_distance(self.at(isa, point.t - self.t_min), point.r)
    }

    #[cfg_attr(optimized, inline(always))]
    fn cdf(&self, isa: I, _: Geometry<'_, I>, point: &Point<I>) -> I::V {
        let s = point.t - self.t_min;
        let (absorbed, _) = one_minus_exp(isa, self.mu_t * s);
        I::V::select(self.uniform, s / self.length, absorbed / self.absorbed)
    }

    #[cfg_attr(optimized, inline(always))]
    fn outside(&self, _: I, _: Geometry<'_, I>, t: I::V) -> [I::Mask; 2] {
        [t.le(self.t_min), self.t_max.le(t)]
    }

    #[cfg_attr(optimized, inline(always))]
    fn support(&self, _: Geometry<'_, I>) -> [I::V; 2] {
        [self.t_min, self.t_max]
    }
}
