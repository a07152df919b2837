//! `p(theta) = 1/Theta`: uniform in the angle at the emitter, so proportional to `1/r^2`.

use crate::density::{Density, Drawn, Pdf};
use crate::geometry::{Geometry, Point};
use crate::integrand::MediumLanes;
use crate::simd::math::tan;
use crate::simd::{Isa, Lanes, none};

pub(crate) struct EquiAngular<I: Isa> {
    /// `Theta` \[rad\].
    subtended: I::V,
}

impl<I: Isa> Density<I> for EquiAngular<I> {
    #[inline(always)]
    fn new(isa: I, geometry: &Geometry<I>, _: &MediumLanes<I>) -> Self {
        Self { subtended: geometry.subtended(isa) }
    }

    #[inline(always)]
    fn invert(&self, isa: I, geometry: &Geometry<I>, u: I::V) -> Drawn<I> {
        let rest = isa.splat(1.0) - u;
        let tan_half = tan(isa, isa.splat(0.5) * self.subtended * u.min(rest));
        let point = geometry.point_at_angle(isa, u.le(rest), tan_half);
        let pdf = self.pdf(isa, geometry, &point);
        Drawn { point, pdf, bisected: none(isa) }
    }

    #[inline(always)]
    fn pdf(&self, isa: I, geometry: &Geometry<I>, point: &Point<I>) -> Pdf<I> {
        Pdf::over_angle(isa.splat(1.0) / self.subtended, geometry, point)
    }
}
