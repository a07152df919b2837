//! `p(theta) = 1/Theta`: uniform in the angle at the emitter, so proportional to `1/r^2`.

use crate::density::{self, Density, Drawn, Pdf, SetUp};
use crate::geometry::{Angle, BIAS, Extent, Geometry, Point, RayLanes};
use crate::integrand::{ChannelLanes, MediumLanes};
use crate::simd::math::{angle_of, tan};
use crate::simd::{Isa, Lanes, Records, none};

pub(crate) struct Kind;

impl density::Kind for Kind {
    type On<I: Isa> = EquiAngular<I>;
}

#[derive(Clone, Copy)]
pub(crate) struct EquiAngular<I: Isa> {
    /// `Theta` \[rad\].
    subtended: I::V,
    /// Up to which variate the angle is measured from `a`.
    turn: I::V,
}

/// The widest angle \[rad\] of which the share `0.5 + BIAS` is at most a right angle, so that `tan(delta/2) <= 1`.
const WIDEST: f32 = core::f32::consts::FRAC_PI_2 / (0.5 + BIAS);

impl<I: Isa> Density<I> for EquiAngular<I> {
    const EXTENT: Extent = Extent::Foot;
    type Place = Angle<I>;
    type SetUps = Records<SetUp<I, Self>>;

    #[cfg_attr(optimized, inline(always))]
    fn new(
        isa: I,
        _: &RayLanes<I>,
        geometry: Geometry<'_, I>,
        _: &MediumLanes<I>,
        _: Option<&ChannelLanes<I>>,
    ) -> (Self, I::Mask) {
        let half = isa.splat(0.5);
        let subtended = geometry.subtended(isa);
        let turn = I::V::select(subtended.lt(isa.splat(WIDEST)), half + geometry.bias_to_a(isa), half);
        (Self { subtended, turn }, geometry.lit_by_angle(isa, subtended))
    }

    #[cfg_attr(optimized, inline(always))]
    fn draw(&self, isa: I, _: Geometry<'_, I>, u: I::V) -> Angle<I> {
        let from_a = u.le(self.turn);
        let share = I::V::select(from_a, u, isa.splat(1.0) - u);
        Angle { from_a, tan_half: tan(isa, isa.splat(0.5) * self.subtended * share) }
    }

    #[cfg_attr(optimized, inline(always))]
    fn point(&self, isa: I, geometry: Geometry<'_, I>, angle: &Angle<I>) -> Drawn<I> {
        let point = geometry.point_at_angle(isa, angle);
        Drawn { point, pdf: self.pdf(isa, geometry, &point), bisected: none(isa) }
    }

    #[cfg_attr(optimized, inline(always))]
    fn pdf(&self, isa: I, geometry: Geometry<'_, I>, point: &Point<I>) -> Pdf<I> {
        Pdf::over_angle(isa.splat(1.0), self.subtended, geometry, point)
    }

    #[cfg_attr(optimized, inline(always))]
    fn cdf(&self, isa: I, geometry: Geometry<'_, I>, point: &Point<I>) -> I::V {
        let [across, along] = geometry.seen_from(isa, !none(isa), point);
        angle_of(isa, across, along) / self.subtended
    }
}
