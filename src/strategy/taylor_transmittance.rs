//! The expansion of the transmittance `exp(-m (tan theta + sec theta))`, `m = mu_t h`, (4)-(11), over its value at 0.

use super::taylor::{Expansion, ORDER};
use crate::geometry::Geometry;
use crate::integrand::MediumLanes;
use crate::simd::math::{exp, horner_double};
use crate::simd::{Isa, Lanes, none};

pub(crate) struct OfTransmittance;

/// Beyond this `m` the density is that of a thinner medium: the trusted range is below 0.01 rad there, and powers of
/// `m` leave f32.
const THICKEST: f32 = 32.0;

#[inline(always)]
fn m<I: Isa>(isa: I, geometry: &Geometry<I>, medium: &MediumLanes<I>) -> I::V {
    (medium.mu_t * geometry.h).min(isa.splat(THICKEST))
}

impl<I: Isa> Expansion<I> for OfTransmittance {
    #[inline(always)]
    fn coefficients(isa: I, geometry: &Geometry<I>, medium: &MediumLanes<I>) -> [I::Double; ORDER + 1] {
        let m = m(isa, geometry, medium).widen();
        let over = |factorial: f64| isa.splat_double(1.0 / factorial);
        [
            over(1.0),
            -m,
            m * horner_double(isa, m, [1.0, -1.0]) * over(2.0),
            m * horner_double(isa, m, [-1.0, 3.0, -2.0]) * over(6.0),
            m * horner_double(isa, m, [1.0, -6.0, 11.0, -5.0]) * over(24.0),
            m * horner_double(isa, m, [-1.0, 10.0, -35.0, 45.0, -16.0]) * over(120.0),
            m * horner_double(isa, m, [1.0, -15.0, 85.0, -210.0, 211.0, -61.0]) * over(720.0),
        ]
    }

    #[inline(always)]
    fn trusted(isa: I, geometry: &Geometry<I>, medium: &MediumLanes<I>) -> I::V {
        let m = m(isa, geometry, medium).widen();
        let at_0 = isa.splat(1.234_695); // exp(0.210824)
        exp(isa, m * isa.splat_double(-0.159_74)) * at_0
    }

    #[inline(always)]
    fn mirrored(isa: I, _: &MediumLanes<I>) -> I::Mask {
        none(isa)
    }
}
