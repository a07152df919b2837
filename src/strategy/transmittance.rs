//! `p(t) = mu_t exp(-mu_t (t - t_min)) / (1 - exp(-mu_t (t_max - t_min)))`: free-flight sampling, cut off at `t_max`.

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
    const EXTENT: Extent = Extent::Lit;
    /// The distance from `t_min` \[m\].
    type Place = I::V;
    type SetUps = Records<SetUp<I, Self>>;

    /// Asks the emitter only whether it faces the ray, not how much of it.
    #[cfg_attr(optimized, inline(always))]
    fn new(
        isa: I,
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
        // 1 - u (1 - e) = (1 - u) + u e, exact where it is small; the floor keeps the pdf of u = 1 above 0.
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
