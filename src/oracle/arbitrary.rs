//! Random scenes for the tests of the oracle, easy and hard ones.

use super::Scene;
use crate::{Emitter, Medium, Ray};
use glam::Vec3;
use proptest::prelude::*;
use std::f32::consts::PI;

/// Ten to a power from `range`.
fn decades(range: std::ops::Range<f32>) -> impl Strategy<Value = f32> {
    range.prop_map(|e| 10f32.powf(e))
}

fn unit() -> impl Strategy<Value = Vec3> {
    (-1f32..1.0, -PI..PI).prop_map(|(z, phi)| {
        let s = (1.0 - z * z).sqrt();
        Vec3::new(s * phi.cos(), s * phi.sin(), z)
    })
}

fn g() -> impl Strategy<Value = f32> {
    prop_oneof![6 => -0.95f32..0.95, 1 => Just(0.0f32), 1 => Just(0.99f32), 1 => Just(-0.99f32)]
}

/// Where the ray starts in units of h, seen from the perpendicular's foot, and how long it is.
fn reach() -> impl Strategy<Value = (f32, f32)> {
    let start = prop_oneof![-4f32..4.0, decades(0.0..2.0).prop_map(|x| -x)];
    let length = prop_oneof![2 => decades(-1.0..1.5), 1 => decades(-6.0..-1.0), 1 => Just(f32::INFINITY)];
    (start, length)
}

/// A scene with `h` from 0.1 mm to 100 m and `mu_t h` from 1e-4 to 100.
pub(super) fn scene() -> impl Strategy<Value = Scene> {
    let place = (unit(), unit(), decades(-4.0..2.0), reach());
    let medium = (decades(-4.0..2.0), 0f32..=1.0, g());
    (place, prop::option::of(unit()), medium).prop_filter_map("degenerate", |(place, normal, (m, albedo, g))| {
        let (d, side, h, (start, length)) = place;
        let foot_to_emitter = d.cross(side).try_normalize()? * h;
        let t_min = 0.5 * h;
        let position = d * (t_min - start * h) + foot_to_emitter;
        let ray = Ray::new(Vec3::ZERO, d, t_min, t_min + length * h).ok()?;
        let emitter = match normal {
            Some(n) => Emitter::point_normal(position, n).ok()?,
            None => Emitter::point(position).ok()?,
        };
        let mu_t = m / h;
        Some(Scene::new(&ray, &emitter, &Medium::new((1.0 - albedo) * mu_t, albedo * mu_t, g).ok()?))
    })
}

/// A variate from 0 to 1, small ones too.
pub(super) fn uniform() -> impl Strategy<Value = f64> {
    prop_oneof![0f64..=1.0, (-53f64..0.0).prop_map(f64::exp2)]
}

/// The settings of a random test of `cases` cases: a failure prints the smallest scene that fails.
pub(super) fn config(cases: u32) -> ProptestConfig {
    ProptestConfig { cases, failure_persistence: None, ..ProptestConfig::default() }
}
