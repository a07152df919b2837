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

/// The start of the ray from the foot of the perpendicular, and its length, in units of h.
fn reach() -> impl Strategy<Value = (f32, f32)> {
    let start = prop_oneof![-4f32..4.0, decades(0.0..2.0).prop_map(|x| -x)];
    let length = prop_oneof![2 => decades(-1.0..1.5), 1 => decades(-6.0..-1.0), 1 => Just(f32::INFINITY)];
    (start, length)
}

/// The kind of the emitter.
#[derive(Clone, Copy, Debug)]
enum Shine {
    Even,
    Normal(Vec3),
    /// A spot that points `along` times `h` from the foot of the perpendicular and by `beside` off the ray, with the sine of half of
    /// the outer angle and the share of the inner cone.
    Spot {
        along: f32,
        beside: Vec3,
        sine_half: f32,
        inner: f32,
    },
}

fn shine() -> impl Strategy<Value = Shine> {
    let beside = (unit(), decades(-3.0..0.5)).prop_map(|(side, size)| side * size);
    // half-angles from 0.1 to 90 degrees
    let sine_half = decades(-3.06..-0.15051);
    let inner = prop_oneof![Just(0f32), Just(1f32), 0f32..1.0];
    let spot = (-4f32..4.0, beside, sine_half, inner);
    prop_oneof![
        1 => Just(Shine::Even),
        1 => unit().prop_map(Shine::Normal),
        2 => spot.prop_map(|(along, beside, sine_half, inner)| Shine::Spot { along, beside, sine_half, inner }),
    ]
}

/// A scene with `h` from 0.1 mm to 100 m and `mu_t h` from 1e-4 to 100.
pub(super) fn scene() -> impl Strategy<Value = Scene> {
    let place = (unit(), unit(), decades(-4.0..2.0), reach());
    let medium = (decades(-4.0..2.0), 0f32..=1.0, g());
    (place, shine(), medium).prop_filter_map("degenerate", |(place, shine, (m, albedo, g))| {
        let (d, side, h, (start, length)) = place;
        let foot_to_emitter = d.cross(side).try_normalize()? * h;
        let t_min = 0.5 * h;
        let position = d * (t_min - start * h) + foot_to_emitter;
        let ray = Ray::new(Vec3::ZERO, d, t_min, t_min + length * h).ok()?;
        let emitter = match shine {
            Shine::Even => Emitter::point(position),
            Shine::Normal(n) => Emitter::point_normal(position, n),
            Shine::Spot { along, beside, sine_half, inner } => {
                let axis = d * along + beside - foot_to_emitter / h;
                let cos_outer = 1.0 - 2.0 * sine_half * sine_half;
                let cos_inner = (cos_outer + inner * (1.0 - cos_outer)).min(1.0);
                Emitter::spot(position, axis.try_normalize()?, cos_outer, cos_inner)
            }
        }
        .ok()?;
        let mu_t = m / h;
        Some(Scene::new(&ray, &emitter, &Medium::new((1.0 - albedo) * mu_t, albedo * mu_t, g).ok()?))
    })
}

/// A variate from 0 to 1, also very small ones.
pub(super) fn uniform() -> impl Strategy<Value = f64> {
    prop_oneof![0f64..=1.0, (-53f64..0.0).prop_map(f64::exp2)]
}

/// The settings of a random test of `cases` cases: a failure prints the smallest scene that fails.
pub(super) fn config(cases: u32) -> ProptestConfig {
    ProptestConfig { cases, failure_persistence: None, ..ProptestConfig::default() }
}
