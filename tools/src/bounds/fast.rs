//! The promises of [`Precision::Fast`](airlight::Precision::Fast): nothing that is not finite, nothing out of range, and what
//! [`LIMITS`] has; of product densities in very dense media [`OF_PRODUCTS`] in its place.

use super::{Bound, high_quantile};
use crate::errors::{Errors, quantile};
use crate::families::Family;
use airlight::Strategy;

/// A figure, and how it is read off.
type Figure = (&'static str, fn(&Errors) -> f64);

/// What is bounded besides.
const FIGURES: [Figure; 8] = [
    ("misjudged_light", |e| e.misjudged_light),
    ("cdf_p999", |e| high_quantile(&e.cdf, 0.999)),
    ("cdf_beyond_t_p999", |e| high_quantile(&e.cdf_beyond_t, 0.999)),
    ("cdf_beyond_t_p9999", |e| high_quantile(&e.cdf_beyond_t, 0.9999)),
    ("cdf_at_t_p999", |e| high_quantile(&e.cdf_at_t, 0.999)),
    ("pdf_p99", |e| quantile(&e.pdf, 0.99)),
    ("pdf_p999", |e| high_quantile(&e.pdf, 0.999)),
    ("weight_p999", |e| high_quantile(&e.weight, 0.999)),
];

/// No bound: f32 has no more to say there.
const NONE: f64 = f64::INFINITY;
/// 1e-4 of a density, in ulp where an ulp is the most of a number.
const SHARE: f64 = 1e-4 / f32::EPSILON as f64;
/// Next to an emitter, where `h` is known to 2^-10 of itself.
const NEAR: [f64; FIGURES.len()] = [1e-5, NONE, 2e-3, 2e-2, 2e-3, 3e4, NONE, 2e-2];
/// On ordinary scenes.
const ORDINARY: [f64; FIGURES.len()] = [1e-5, 8e-6, 8e-6, 1e-4, 8e-6, 32.0, SHARE, 5e-5];

/// The limits of these figures on every family.
const LIMITS: [(Family, [f64; FIGURES.len()]); Family::ALL.len()] = [
    (Family::Generic, ORDINARY),
    (Family::Variate, [1e-5, 8e-6, 8e-6, 1e-4, 8e-6, 6e4, NONE, NONE]),
    (Family::NearEmitter, NEAR),
    (Family::FarAway, ORDINARY),
    (Family::InfiniteRays, [1e-5, NONE, 1e-3, 4e-3, 1e-3, 1e4, NONE, 5e-3]),
    (Family::ShortIntervals, [1e-5, NONE, 8e-6, 1e-4, 8e-6, 32.0, SHARE, 5e-5]),
    // Ends beside the emitter's plane: what of the ray is lit may be a rounding.
    (Family::Cosine, [1e-5, NONE, NONE, NONE, NONE, NONE, NONE, 2e-4]),
    (Family::Phase, ORDINARY),
    (Family::Medium, ORDINARY),
    (Family::Ray, ORDINARY),
    (Family::RandomBits, [1e-5, NONE, 1e-4, NONE, 1e-4, NONE, NONE, NONE]),
    (Family::Peaks, NEAR),
    // In f64 as in exact precision; next to the apex t resolves nothing.
    (Family::Spot, [1e-5, NONE, 8e-6, 1e-4, 8e-6, 64.0, NONE, NONE]),
    // One ray in four passes the emitter as near.
    (Family::Colour, NEAR),
];

/// Those of product densities where they differ, on families with optical depths beyond 1e5: they follow the transmittance from the
/// start of the lit interval, which is known to about 1e-7 of the distances, and this may be longer than a free path.
const OF_PRODUCTS: [(Family, [f64; FIGURES.len()]); 3] = [
    (Family::InfiniteRays, [1e-5, NONE, 1e-3, 5e-2, 1e-3, 1e4, NONE, 5e-3]),
    (Family::Medium, [1e-5, NONE, 5e-3, NONE, 5e-3, 1e4, NONE, 5e-5]),
    (Family::RandomBits, [1e-5, NONE, NONE, NONE, NONE, NONE, NONE, NONE]),
];

pub(super) fn bounds(strategy: Strategy, family: Family) -> Vec<Bound> {
    let always = [
        Bound { figure: "nonfinite", read: |e| e.nonfinite as f64, limit: 0.0 },
        Bound { figure: "out_of_range", read: |e| e.out_of_range as f64, limit: 0.0 },
    ];
    let of_family = |table: &'static [(Family, _)]| table.iter().find(|(of, _)| *of == family);
    let closed_form = matches!(strategy, Strategy::EquiAngular | Strategy::PointNormal);
    let own = if closed_form { None } else { of_family(&OF_PRODUCTS) };
    let limits = own.or_else(|| of_family(&LIMITS)).into_iter().flat_map(|(_, limits)| FIGURES.iter().zip(limits));
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
