//! `p(t) = mu_t exp(-mu_t (t - t_min)) / (1 - exp(-mu_t (t_max - t_min)))`: free-flight sampling, cut off at `t_max`.

use crate::density::{self, Density, Drawn, Pdf};
use crate::geometry::{Geometry, Point};
use crate::integrand::MediumLanes;
use crate::simd::math::{exp, neg_ln_1m, one_minus_exp};
use crate::simd::{Isa, Lanes, Number, none};

pub(crate) struct Kind;

impl density::Kind for Kind {
    type On<I: Isa> = Transmittance<I>;
}

pub(crate) struct Transmittance<I: Isa> {
    mu_t: I::V,
    /// `1 - exp(-mu_t L)`, and the exponential itself.
    absorbed: I::V,
    passed: I::V,
    length: I::V,
    /// Where `mu_t L` is so small that the density is constant.
    uniform: I::Mask,
}

impl<I: Isa> Transmittance<I> {
    /// The density at the distance `s` from `t_min` \[1/m\].
    #[cfg_attr(optimized, inline(always))]
    fn at(&self, isa: I, s: I::V) -> I::V {
        let falling = exp(isa, -(self.mu_t.widen() * s.widen())) * (self.mu_t / self.absorbed);
        I::V::select(self.uniform, isa.splat(1.0) / self.length, falling)
    }
}

impl<I: Isa> Density<I> for Transmittance<I> {
    #[cfg_attr(optimized, inline(always))]
    fn new(isa: I, geometry: &Geometry<I>, medium: &MediumLanes<I>) -> Self {
        let length = geometry.t_max - geometry.t_min;
        let depth = medium.mu_t * length;
        let (absorbed, passed) = one_minus_exp(isa, depth);
        Self { mu_t: medium.mu_t, absorbed, passed, length, uniform: depth.lt(isa.splat(1e-30)) }
    }

    #[cfg_attr(optimized, inline(always))]
    fn invert(&self, isa: I, geometry: &Geometry<I>, u: I::V) -> Drawn<I> {
        // 1 - u (1 - e) = (1 - u) + u e, exact where it is small; the floor keeps the pdf of u = 1 above 0.
        let remaining = u.mul_add(self.passed, isa.splat(1.0) - u).max(isa.splat(1e-37));
        let depth = neg_ln_1m(isa, u * self.absorbed, remaining);
        let s = I::V::select(self.uniform, u * self.length, depth / self.mu_t).min(self.length);
        let point = geometry.point_from_t_min(isa, s);
        let pdf = Pdf::over_distance(self.at(isa, s), point.r);
        Drawn { point, pdf, bisected: none(isa) }
    }

    #[cfg_attr(optimized, inline(always))]
    fn pdf(&self, isa: I, geometry: &Geometry<I>, point: &Point<I>) -> Pdf<I> {
        Pdf::over_distance(self.at(isa, point.t - geometry.t_min), point.r)
    }

    /// Asks the emitter only whether it faces the ray, not how much of it.
    #[cfg_attr(optimized, inline(always))]
    fn lit(_: I, geometry: &Geometry<I>) -> I::Mask {
        geometry.faced
    }

    #[cfg_attr(optimized, inline(always))]
    fn support(geometry: &Geometry<I>) -> [I::V; 2] {
        [geometry.t_min, geometry.t_max]
    }
}
