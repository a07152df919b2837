//! The promises of [`Precision::Fast`](airlight::Precision::Fast), the same for all strategies that have it: nothing that
//! is not finite, nothing out of range, and what [`LIMITS`] has.

use super::{Bound, high_quantile};
use crate::errors::{Errors, quantile};
use crate::families::Family;

/// A figure, and how it is read off.
type Figure = (&'static str, fn(&Errors) -> f64);

/// What is bounded besides.
const FIGURES: [Figure; 5] = [
    ("misjudged_light", |e| e.misjudged_light),
    ("cdf_p999", |e| quantile(&e.cdf, 0.999)),
    ("cdf_beyond_t_max", |e| quantile(&e.cdf_beyond_t, 1.0)),
    ("pdf_p99", |e| quantile(&e.pdf, 0.99)),
    ("pdf_p999", |e| high_quantile(&e.pdf, 0.999)),
];

/// No bound.
const NONE: f64 = f64::INFINITY;
/// 1e-4 of a density, in ulp where an ulp is the most of a number.
const SHARE: f64 = 1e-4 / f32::EPSILON as f64;

/// The limits of these figures on every family.
const LIMITS: [(Family, [f64; FIGURES.len()]); Family::ALL.len()] = [
    (Family::Generic, [1e-5, 8e-6, 1e-4, 32.0, SHARE]),
    (Family::Variate, [NONE; 5]),
    (Family::NearEmitter, [NONE; 5]),
    (Family::FarAway, [NONE; 5]),
    (Family::InfiniteRays, [NONE; 5]),
    (Family::ShortIntervals, [NONE; 5]),
    (Family::Cosine, [NONE; 5]),
    (Family::Phase, [NONE; 5]),
    (Family::Medium, [NONE; 5]),
    (Family::Ray, [NONE; 5]),
    (Family::RandomBits, [NONE; 5]),
];

pub(super) fn bounds(family: Family) -> Vec<Bound> {
    let always = [
        Bound { figure: "nonfinite", read: |e| e.nonfinite as f64, limit: 0.0 },
        Bound { figure: "out_of_range", read: |e| e.out_of_range as f64, limit: 0.0 },
    ];
    let limits = LIMITS.iter().filter(|(of, _)| *of == family).flat_map(|(_, limits)| FIGURES.iter().zip(limits));
    let stated = limits.filter(|(_, limit)| **limit < NONE);
    always.into_iter().chain(stated.map(|(&(figure, read), &limit)| Bound { figure, read, limit })).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_family_has_its_row() {
        assert_eq!(LIMITS.map(|(family, _)| family), Family::ALL);
    }
}
