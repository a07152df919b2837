//! Uniform in the angle at the emitter, so proportional to `1/r^2`.
//!
//! Equations of `docs/mathematics.md`:
//!
//! ```text
//! Theta = atan2(h l, h^2 + t'_a t'_b)                                      (2.7)
//! p_theta = 1/Theta,  p_t = h / (Theta r^2)                                (3.3)
//! CDF = atan2(h (t - t_a), h^2 + t'_a t') / Theta                          (3.4)
//! delta = u Theta from a, or (1 - u) Theta from b                          (3.5)
//! t, t' from tan(delta/2)                                                  (2.8), (2.9)
//! ```
//!
//! Departure: the angle is measured from `a` for `u` up to 1/2 + [`BIAS`] or 1/2 - `BIAS`, so that more of the variates are
//! measured from the end nearer to the foot of the perpendicular. From there the way is shorter, and so is its rounding error.
//!
//! In fast precision the angle is measured from `a` up to 1/2, and polynomials are shorter.

use crate::Precision;
use crate::density::{self, Density, Drawn, Pdf, SetUp};
use crate::geometry::{Angle, BIAS, Extent, Geometry, Point, RayLanes};
use crate::integrand::{ChannelLanes, MediumLanes};
use crate::precision::is_exact;
use crate::simd::math::{angle_of, tan};
use crate::simd::{Isa, Lanes, Records, none};

/// `EXACT` is the precision.
pub(crate) struct Kind<const EXACT: bool>;

impl<const EXACT: bool> density::Kind for Kind<EXACT> {
    type On<I: Isa> = EquiAngular<I, EXACT>;
}

#[derive(Clone, Copy)]
pub(crate) struct EquiAngular<I: Isa, const EXACT: bool> {
    /// `Theta` \[rad\].
    subtended: I::V,
}

/// The widest angle \[rad\] of which the share `0.5 + BIAS` is at most a right angle, so that `tan(delta/2) <= 1`.
const WIDEST: f32 = core::f32::consts::FRAC_PI_2 / (0.5 + BIAS);

impl<I: Isa, const EXACT: bool> EquiAngular<I, EXACT> {
    /// Whether the arithmetic is that of `Precision::Exact`.
    const FULL: bool = is_exact::<I>(EXACT);

    /// The largest variate of which the angle is measured from `a`.
    #[cfg_attr(optimized, inline(always))]
    fn turn(&self, isa: I, geometry: Geometry<'_, I>) -> I::V {
        let half = isa.splat(0.5);
        if !Self::FULL {
            return half;
        }
        I::V::select(self.subtended.lt(isa.splat(WIDEST)), half + geometry.bias_to_a(isa), half)
    }
}

impl<I: Isa, const EXACT: bool> Density<I> for EquiAngular<I, EXACT> {
    const EXTENT: Extent = Extent::Foot;
    type Place = Angle<I>;
    type SetUps = Records<SetUp<I, Self>>;

    #[cfg_attr(optimized, inline(always))]
    fn new(
        isa: I,
        _: Precision,
        _: &RayLanes<I>,
        geometry: Geometry<'_, I>,
        _: &MediumLanes<I>,
        _: Option<&ChannelLanes<I>>,
    ) -> (Self, I::Mask) {
        let subtended = geometry.subtended(isa, Self::FULL);
        (Self { subtended }, geometry.lit_by_angle(isa, subtended))
    }

    #[cfg_attr(optimized, inline(always))]
    fn draw(&self, isa: I, geometry: Geometry<'_, I>, u: I::V) -> Angle<I> {
        // (3.5)
        let from_a = u.le(self.turn(isa, geometry));
        let share = I::V::select(from_a, u, isa.splat(1.0) - u);
        Angle { from_a, tan_half: tan(isa, isa.splat(0.5) * self.subtended * share, Self::FULL) }
    }

    #[cfg_attr(optimized, inline(always))]
    fn point(&self, isa: I, geometry: Geometry<'_, I>, angle: &Angle<I>) -> Drawn<I> {
        let point = geometry.point_at_angle(isa, angle, Self::FULL);
        Drawn { point, pdf: self.pdf(isa, geometry, &point), bisected: none(isa) }
    }

    #[cfg_attr(optimized, inline(always))]
    fn pdf(&self, _: I, geometry: Geometry<'_, I>, point: &Point<I>) -> Pdf<I> {
        // (3.3)
        let (h, r_squared) = (geometry.foot.h, geometry.foot.r_squared(point.t_prime));
        // r^2 Theta is at least about h min(r, l), and h, r and l are at least 1e-18.
        Pdf { over_t: h / (r_squared * self.subtended), times_r2: h / self.subtended }
    }

    #[cfg_attr(optimized, inline(always))]
    fn cdf(&self, isa: I, geometry: Geometry<'_, I>, point: &Point<I>) -> I::V {
        // (3.4)
        let [across, along] = geometry.seen_from(isa, !none(isa), point);
        angle_of(isa, across, along, Self::FULL) / self.subtended
    }
}
