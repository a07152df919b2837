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

/// 2^-24: half an ulp of a value next to 1.
const EPS: f64 = f32::EPSILON as f64 / 2.0;

/// The promises for one strategy and family.
#[must_use]
pub fn bounds(strategy: Strategy, family: Family) -> Vec<Bound> {
    use Strategy::{TaylorPhase, TaylorTransmittance};
    let taylor = matches!(strategy, TaylorPhase | TaylorTransmittance);
    let mut bounds = vec![
        Bound { figure: "nonfinite", read: |e| e.nonfinite as f64, limit: 0.0 },
        Bound { figure: "out_of_range", read: |e| e.out_of_range as f64, limit: 0.0 },
        Bound { figure: "misjudged", read: |e| e.misjudged as f64, limit: 0.0 },
        // A dozen roundings on the way from u to the point; the residual of Newton's method, at most 2^-20, comes on top.
        Bound {
            figure: "cdf_beyond_t_max",
            read: |e| quantile(&e.cdf_beyond_t, 1.0),
            limit: if taylor { 64.0 } else { 16.0 } * EPS,
        },
        // The density itself is a quotient of some ten roundings; the Taylor polynomial multiplies the error of theta by
        // the slope of its logarithm.
        Bound { figure: "pdf_p99", read: |e| quantile(&e.pdf, 0.99), limit: if taylor { 64.0 } else { 16.0 } * EPS },
        Bound {
            figure: "pdf_p9999",
            read: |e| quantile(&e.pdf, 0.9999),
            limit: if taylor { 256.0 } else { 64.0 } * EPS,
        },
        // t' = t - t_h is exact to 3 ulp, the square root adds one.
        Bound { figure: "r_max", read: |e| quantile(&e.r, 1.0), limit: 8.0 },
        // The optical depth is exact to double precision, the phase function's power 3/2 takes the rest.
        Bound { figure: "integrand_max", read: |e| quantile(&e.integrand, 1.0), limit: 48.0 },
        Bound { figure: "weight_max", read: |e| quantile(&e.weight, 1.0), limit: 1e-3 },
    ];
    if family == Family::Generic {
        // Where h is small t cannot resolve u: the largest value is that of the rounding of t.
        bounds.push(Bound { figure: "cdf_p999", read: |e| quantile(&e.cdf, 0.999), limit: 6e-6 });
        bounds.push(Bound { figure: "cdf_max", read: |e| quantile(&e.cdf, 1.0), limit: 1e-3 });
        bounds.push(Bound { figure: "pdf_p999", read: |e| quantile(&e.pdf, 0.999), limit: 1e-5 });
        bounds.push(Bound { figure: "pdf_max", read: |e| quantile(&e.pdf, 1.0), limit: 1e-3 });
    }
    bounds
}
