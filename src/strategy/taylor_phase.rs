//! The expansion of the phase function, (13)-(20), over its value at 0; in `-theta` for backward scattering.

use super::taylor::{Expansion, ORDER};
use crate::geometry::Geometry;
use crate::integrand::MediumLanes;
use crate::simd::math::{horner, horner_double};
use crate::simd::{Isa, Lanes, Number};

pub(crate) struct OfPhase;

impl<I: Isa> Expansion<I> for OfPhase {
    #[inline(always)]
    fn coefficients(isa: I, _: &Geometry<I>, medium: &MediumLanes<I>) -> [I::Double; ORDER + 1] {
        let c = |x| isa.splat_double(x);
        let g = medium.g.abs();
        // v_n / v_0 = q^n.
        let q = (g / g.mul_add(g, isa.splat(1.0))).widen();
        let s = q * q;
        [
            c(1.0),
            q * c(-3.0),
            s * c(7.5),
            q * horner_double(isa, s, [-17.5, 0.5]),
            s * horner_double(isa, s, [39.375, -2.5]),
            q * horner_double(isa, s, [-86.625, 8.75, -0.025]),
            s * horner_double(isa, s, [187.6875, -26.25, 1.0 / 3.0]),
        ]
    }

    #[inline(always)]
    fn trusted(isa: I, _: &Geometry<I>, medium: &MediumLanes<I>) -> I::V {
        horner(isa, medium.g.abs(), [51.7683, -160.212, 184.173, -93.8831, 18.8217])
    }

    #[inline(always)]
    fn mirrored(isa: I, medium: &MediumLanes<I>) -> I::Mask {
        medium.g.lt(isa.splat(0.0))
    }
}
