//! A factor of the integrand as a polynomial `P` of the angle, up to the angle `theta_c` to which it is trusted: (4.1) to (4.4) of
//! `docs/mathematics.md`. `strategy/taylor_transmittance` has the transmittance, this file the phase function.

use crate::simd::math::{horner_double, horner_lanes, reciprocal};
use crate::simd::{Isa, Lanes, Number};

/// The order of the polynomials.
pub(crate) const ORDER: usize = 6;

/// The polynomials of a lane group.
#[derive(Clone, Copy)]
pub(crate) struct Expanded<I: Isa> {
    /// Coefficients from degree 0 on, up to a common factor.
    pub(crate) p: [I::Double; ORDER + 1],
    /// The angle up to which the polynomial is trusted \[rad\], and `P(theta_c)`.
    pub(crate) theta_c: I::Double,
    pub(crate) p_c: I::V,
    /// Which lanes expand in `-theta`.
    pub(crate) mirrored: I::Mask,
}

impl<I: Isa> Expanded<I> {
    #[cfg_attr(optimized, inline(always))]
    pub(crate) fn new(p: [I::Double; ORDER + 1], theta_c: I::Double, mirrored: I::Mask) -> Self {
        Self { p, theta_c, p_c: I::V::narrow(horner_lanes(theta_c, p)), mirrored }
    }

    /// (4.3), (4.4): the phase function with the mean cosine `g` over its value at 0, (13)-(20); in `-theta` for backward
    /// scattering.
    #[cfg_attr(optimized, inline(always))]
    pub(crate) fn of_phase(isa: I, g: I::V) -> Self {
        let c = |x| isa.splat_double(x);
        // q = |g|/(1 + g^2), and v_n/v_0 = q^n in the paper.
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
        // (4.4)
        let theta_c = horner_double(isa, size, [51.7683, -160.212, 184.173, -93.8831, 18.8217]);
        Self::new(p, theta_c, g.lt(isa.splat(0.0)))
    }
}
