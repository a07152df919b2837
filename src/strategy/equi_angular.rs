//! `p(theta) = 1/Theta`: uniform in the angle at the emitter, so proportional to `1/r^2`.

use crate::density::{self, Density, Drawn, Pdf};
use crate::geometry::{BIAS, Geometry, Point};
use crate::integrand::MediumLanes;
use crate::simd::math::tan;
use crate::simd::{Isa, Lanes, none};

pub(crate) struct Kind;

impl density::Kind for Kind {
    type On<I: Isa> = EquiAngular<I>;
}

pub(crate) struct EquiAngular<I: Isa> {
    /// `Theta` \[rad\].
    subtended: I::V,
    /// Up to which variate the angle is measured from `a`.
    turn: I::V,
}

/// The widest angle \[rad\] of which the share `0.5 + BIAS` is at most a right angle, so that `tan(delta/2) <= 1`.
const WIDEST: f32 = core::f32::consts::FRAC_PI_2 / (0.5 + BIAS);

impl<I: Isa> Density<I> for EquiAngular<I> {
    #[cfg_attr(optimized, inline(always))]
    fn new(isa: I, geometry: &Geometry<I>, _: &MediumLanes<I>) -> Self {
        let half = isa.splat(0.5);
        let subtended = geometry.subtended(isa);
        let turn = I::V::select(subtended.lt(isa.splat(WIDEST)), half + geometry.bias_to_a(isa), half);
        Self { subtended, turn }
    }

    #[cfg_attr(optimized, inline(always))]
    fn invert(&self, isa: I, geometry: &Geometry<I>, u: I::V) -> Drawn<I> {
        let rest = isa.splat(1.0) - u;
        let from_a = u.le(self.turn);
        let tan_half = tan(isa, isa.splat(0.5) * self.subtended * I::V::select(from_a, u, rest));
        let point = geometry.point_at_angle(isa, from_a, tan_half);
        let pdf = self.pdf(isa, geometry, &point);
        Drawn { point, pdf, bisected: none(isa) }
    }

    #[cfg_attr(optimized, inline(always))]
    fn pdf(&self, isa: I, geometry: &Geometry<I>, point: &Point<I>) -> Pdf<I> {
        Pdf::over_angle(isa.splat(1.0) / self.subtended, geometry, point)
    }
}
