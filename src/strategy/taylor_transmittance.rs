//! The expansion of the transmittance `exp(-m (tan theta + sec theta))`, `m = mu_t h`, (4)-(11), over its value at 0.

use super::taylor::{Expansion, ORDER, smaller};
use crate::geometry::Geometry;
use crate::integrand::MediumLanes;
use crate::simd::math::horner_double;
use crate::simd::{Isa, Lanes, Number, none};

pub(crate) struct OfTransmittance;

/// Beyond this `m` the density is that of a thinner medium: the trusted range is below 0.01 rad there, and powers of
/// `m` leave f32.
const THICKEST: f64 = 32.0;

#[inline(always)]
fn m<I: Isa>(isa: I, geometry: &Geometry<I>, medium: &MediumLanes<I>) -> I::Double {
    smaller(medium.mu_t.widen() * geometry.h.widen(), isa.splat_double(THICKEST))
}

impl<I: Isa> Expansion<I> for OfTransmittance {
    #[inline(always)]
    fn coefficients(isa: I, geometry: &Geometry<I>, medium: &MediumLanes<I>) -> [I::Double; ORDER + 1] {
        let m = m(isa, geometry, medium);
        [
            isa.splat_double(1.0),
            -m,
            m * horner_double(isa, m, over(2, [1, -1])),
            m * horner_double(isa, m, over(6, [-1, 3, -2])),
            m * horner_double(isa, m, over(24, [1, -6, 11, -5])),
            m * horner_double(isa, m, over(120, [-1, 10, -35, 45, -16])),
            m * horner_double(isa, m, over(720, [1, -15, 85, -210, 211, -61])),
        ]
    }

    #[inline(always)]
    fn trusted(isa: I, geometry: &Geometry<I>, medium: &MediumLanes<I>) -> I::Double {
        // exp(0.210824 - 0.15974 m) from the middle of the range, m = 16, by the 32nd root.
        let x = m(isa, geometry, medium).mul_add(isa.splat_double(-0.15974 / 32.0), isa.splat_double(0.15974 / 2.0));
        let root = horner_double(isa, x, [1.0 / 720.0, 1.0 / 120.0, 1.0 / 24.0, 1.0 / 6.0, 0.5, 1.0, 1.0]);
        let mut power = root;
        let mut k = 0;
        while k < 5 {
            power = power * power;
            k += 1;
        }
        power * isa.splat_double(0.095_845_668_587_532_98) // exp(0.210824 - 0.15974 16)
    }

    #[inline(always)]
    fn mirrored(isa: I, _: &MediumLanes<I>) -> I::Mask {
        none(isa)
    }
}

/// Numerators over a factorial.
const fn over<const K: usize>(factorial: i32, numerators: [i32; K]) -> [f64; K] {
    let mut quotients = [0.0; K];
    let mut k = 0;
    while k < K {
        quotients[k] = numerators[k] as f64 / factorial as f64;
        k += 1;
    }
    quotients
}
