//! The expansion of the phase function, (13)-(20), over its value at 0; in `-theta` for backward scattering.

use super::taylor::{Expanded, Expansion};
use crate::geometry::Geometry;
use crate::integrand::MediumLanes;
use crate::simd::math::{horner_double, reciprocal};
use crate::simd::{Isa, Lanes, Number};

pub(crate) struct OfPhase;

impl<I: Isa> Expansion<I> for OfPhase {
    #[inline(always)]
    fn expand(_: I, _: &Geometry<I>, medium: &MediumLanes<I>) -> Expanded<I> {
        medium.phase
    }
}

impl<I: Isa> Expanded<I> {
    /// For media with the mean cosine `g`.
    #[inline(always)]
    pub(crate) fn of_phase(isa: I, g: I::V) -> Self {
        let c = |x| isa.splat_double(x);
        // v_n / v_0 = q^n.
        let (size, one) = (g.abs().widen(), c(1.0));
        let square = size.mul_add(size, one);
        let q = size * reciprocal(isa, square);
        let s = q * q;
        let p = [
            one,
            q * c(-3.0),
            s * c(7.5),
            q * horner_double(isa, s, [-17.5, 0.5]),
            s * horner_double(isa, s, [39.375, -2.5]),
            q * horner_double(isa, s, [-86.625, 8.75, -0.025]),
            s * horner_double(isa, s, [187.6875, -26.25, 1.0 / 3.0]),
        ];
        let theta_c = horner_double(isa, size, [51.7683, -160.212, 184.173, -93.8831, 18.8217]);
        Self::new(p, theta_c, g.lt(isa.splat(0.0)))
    }
}
