//! The expansion of the phase function, (13)-(20), over its value at 0; in `-theta` for backward scattering.

use super::taylor::{Expansion, ORDER};
use crate::geometry::Geometry;
use crate::integrand::MediumLanes;
use crate::simd::math::{horner_double, reciprocal};
use crate::simd::{Isa, Lanes, Number};

pub(crate) struct OfPhase;

impl<I: Isa> Expansion<I> for OfPhase {
    #[inline(always)]
    fn coefficients(isa: I, _: &Geometry<I>, medium: &MediumLanes<I>) -> [I::Double; ORDER + 1] {
        let c = |x| isa.splat_double(x);
        // v_n / v_0 = q^n.
        let (g, one) = (medium.g.abs().widen(), c(1.0));
        let square = g.mul_add(g, one);
        let q = g * reciprocal(isa, square);
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
    fn trusted(isa: I, _: &Geometry<I>, medium: &MediumLanes<I>) -> I::Double {
        horner_double(isa, medium.g.abs().widen(), [51.7683, -160.212, 184.173, -93.8831, 18.8217])
    }

    #[inline(always)]
    fn mirrored(isa: I, medium: &MediumLanes<I>) -> I::Mask {
        medium.g.lt(isa.splat(0.0))
    }
}
