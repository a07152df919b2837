//! What is promised of the errors, for every strategy on every family, and why it can be no less.

use crate::errors::{Errors, quantile};
use crate::families::Family;
use airlight::Strategy;

/// A promise: a quantile of one kind of error, or a count, and how large it may be.
#[derive(Clone, Copy, Debug)]
pub struct Bound {
    /// The figure, as it is named in JSON.
    pub figure: &'static str,
    /// How it is read off.
    pub read: fn(&Errors) -> f64,
    /// Its largest allowed value.
    pub limit: f64,
}

impl Bound {
    /// Whether the errors keep the promise; a list with nothing in it keeps any.
    #[must_use]
    pub fn holds(&self, errors: &Errors) -> bool {
        let value = (self.read)(errors);
        value.is_nan() || value <= self.limit
    }
}

/// 2^-24: half an ulp of a number just above 1, an ulp of one just below.
const ULP: f64 = f32::EPSILON as f64 / 2.0;

/// The promises for one strategy on one family.
#[must_use]
pub fn bounds(strategy: Strategy, family: Family) -> Vec<Bound> {
    let taylor = matches!(strategy, Strategy::TaylorTransmittance | Strategy::TaylorPhase);
    let closed_form = matches!(strategy, Strategy::Transmittance | Strategy::EquiAngular | Strategy::PointNormal);
    // Geometry is computed in f64, whose ulp shows in N where h is below 1e-7 of the distance to the emitter.
    let beyond_f64 = matches!(family, Family::NearEmitter | Family::RandomBits);
    let mut bounds = vec![
        Bound { figure: "nonfinite", read: |e| e.nonfinite as f64, limit: 0.0 },
        Bound { figure: "out_of_range", read: |e| e.out_of_range as f64, limit: 0.0 },
        Bound { figure: "misjudged", read: |e| e.misjudged as f64, limit: 0.0 },
        // u itself is known to 2^-24, and the point takes some ten roundings from it. Newton's method may stop 2 ulp
        // away, and the integral of the polynomial has 17 terms; the product density sums that of as many knots.
        Bound {
            figure: "cdf_beyond_t_max",
            read: |e| quantile(&e.cdf_beyond_t, 1.0),
            limit: if closed_form { 16.0 } else { 128.0 } * ULP,
        },
        // A quotient of some five roundings; the Taylor polynomials multiply the error of theta by the slope of their
        // logarithm, up to 30, and that of h by mu_t h. A product
        // density has v to half an ulp, over segments of a twentieth.
        Bound {
            figure: "pdf_p99",
            read: |e| quantile(&e.pdf, 0.99),
            limit: if closed_form {
                8.0
            } else if taylor {
                48.0
            } else {
                64.0
            } * ULP,
        },
        // r and t come from one angle by two formulas of some three roundings each; for r alone, at a given t', it is
        // 1 ulp. Seen: 2.8 and 5.6.
        Bound { figure: "r_p999", read: |e| quantile(&e.r, 0.999), limit: 4.0 },
        Bound { figure: "r_max", read: |e| quantile(&e.r, 1.0), limit: 8.0 },
        // The optical depth is exact to f64; the power 3/2 of the phase function takes most of it.
        Bound {
            figure: if beyond_f64 { "integrand_p9999" } else { "integrand_max" },
            read: if beyond_f64 { |e| quantile(&e.integrand, 0.9999) } else { |e| quantile(&e.integrand, 1.0) },
            limit: 48.0,
        },
        // What u's rounding does to a steep weight is allowed for; where the density is steeper than that, the ends of
        // u in [0, 1] are left.
        Bound { figure: "weight_p999", read: |e| quantile(&e.weight, 0.999), limit: 1e-3 },
    ];
    // Of arbitrary bits one in twenty is a ray: p99.99 of them would be the very worst.
    if family != Family::RandomBits {
        let limit = if closed_form { 64.0 } else { 256.0 } * ULP;
        bounds.push(Bound { figure: "pdf_p9999", read: |e| quantile(&e.pdf, 0.9999), limit });
    }
    if family == Family::Generic {
        // The floor, exact arithmetic rounded once, is 2.4e-6.
        bounds.push(Bound { figure: "cdf_p999", read: |e| quantile(&e.cdf, 0.999), limit: 6e-6 });
        bounds.push(Bound { figure: "pdf_p999", read: |e| quantile(&e.pdf, 0.999), limit: 1e-5 });
        bounds.push(Bound { figure: "pdf_max", read: |e| quantile(&e.pdf, 1.0), limit: 1e-3 });
    }
    bounds
}
