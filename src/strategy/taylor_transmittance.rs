//! The Taylor density of the transmittance: (4.5) of `docs/mathematics.md` with the polynomial (4.1) up to `theta_c` of (4.2).
//!
//! The polynomial expands `exp(-m (tan theta + sec theta - 1))`, `m = mu_t h`: the transmittance over its value at 0, (4)-(11).
//!
//! Departures from the paper, and why:
//!
//! 1. `m` stops at 32. The trusted range is below 0.01 rad there, and higher powers of `m` leave f32.
//! 2. `theta_c` is the 16th power of a polynomial: there is no exponential in f64.

use super::taylor::{Expansion, Taylor};
use crate::density::Kind;
use crate::expansion::Expanded;
use crate::geometry::Geometry;
use crate::integrand::MediumLanes;
use crate::simd::math::horner_double;
use crate::simd::{Double, Isa, Lanes, none};

#[derive(Clone, Copy)]
pub(crate) struct OfTransmittance;

impl Kind for OfTransmittance {
    type On<I: Isa> = Taylor<I, Self>;
}

/// The largest `m`; a denser medium has the density of this one.
const THICKEST: f64 = 32.0;

impl<I: Isa> Expansion<I> for OfTransmittance {
    #[cfg_attr(optimized, inline(always))]
    fn expand(isa: I, geometry: Geometry<'_, I>, medium: &MediumLanes<I>) -> Expanded<I> {
        // (4.1)
        let m = (medium.mu_t.widen() * geometry.foot.h.widen()).min(isa.splat_double(THICKEST));
        let p = [
            isa.splat_double(1.0),
            -m,
            m * horner_double(isa, m, over(2, [1, -1])),
            m * horner_double(isa, m, over(6, [-1, 3, -2])),
            m * horner_double(isa, m, over(24, [1, -6, 11, -5])),
            m * horner_double(isa, m, over(120, [-1, 10, -35, 45, -16])),
            m * horner_double(isa, m, over(720, [1, -15, 85, -210, 211, -61])),
        ];
        Expanded::new(p, trusted(isa, m), none(isa))
    }
}

/// (4.2): `exp(0.210824 - 0.15974 m)`, by its 16th root.
///
/// - Types: f64.
/// - Max error: 1.2e-9, absolute.
/// - Range: `[0, 32]`, to [`THICKEST`].
#[cfg_attr(optimized, inline(always))]
fn trusted<I: Isa>(isa: I, m: I::Double) -> I::Double {
    let mut power = horner_double(isa, m, ROOT);
    let mut k = 0;
    while k < 4 {
        power = power * power;
        k += 1;
    }
    power
}

/// Coefficients, highest degree first, of `exp((0.210824 - 0.15974 m) / 16)`: a minimax fit of its 16th power.
const ROOT: [f64; 6] = [
    -7.378_751_931_399e-13,
    4.167_911_492_854e-10,
    -1.680_241_504_776e-7,
    5.049_850_987_231e-5,
    -1.011_617_114_145_7e-2,
    1.013_263_692_561_421,
];

/// `numerators` over `factorial`.
#[cfg_attr(optimized, inline(always))]
const fn over<const K: usize>(factorial: i32, numerators: [i32; K]) -> [f64; K] {
    let mut quotients = [0.0; K];
    let mut k = 0;
    while k < K {
        quotients[k] = numerators[k] as f64 / factorial as f64;
        k += 1;
    }
    quotients
}
