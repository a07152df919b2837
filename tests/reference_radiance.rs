//! The formula and its constants against an independent renderer: single-scattered radiance of 768 rays.

use airlight::oracle::Scene;
use airlight::oracle::quadrature::integrate;
use airlight::{Emitter, Medium, Ray};
use glam::Vec3;

/// By how much of its length the renderer shortens a shadow ray.
const SHADOW_EPSILON: f64 = 8.94e-4;

struct Row {
    line: usize,
    scene: Scene,
    /// The emitter's scale times what the renderer counts and `Scene` does not: the transmittance up to `t_min`.
    scale: f64,
    reference: f64,
    standard_error: f64,
    quadrature: f64,
}

fn rows() -> Vec<Row> {
    let table = include_str!("data/radiance.csv");
    table.lines().enumerate().skip(1).map(|(i, line)| row(i + 1, line)).collect()
}

fn row(line: usize, text: &str) -> Row {
    let column: Vec<f64> = text.split(',').map(|s| s.parse().unwrap()).collect();
    let f32_at = |i: usize| column[i] as f32;
    let vector = |i: usize| Vec3::new(f32_at(i), f32_at(i + 1), f32_at(i + 2));
    let ray = Ray::new(vector(0), vector(3), f32_at(6), f32_at(7)).unwrap();
    let (y, n) = (vector(8), vector(11));
    let emitter = if n == Vec3::ZERO { Emitter::point(y) } else { Emitter::point_normal(y, n) }.unwrap();
    let scene = Scene::new(&ray, &emitter, &Medium::new(f32_at(15), f32_at(14), f32_at(16)).unwrap());
    Row {
        line,
        scene,
        scale: column[17] * (-scene.mu_t() * scene.interval().0).exp(),
        reference: column[18],
        standard_error: column[19],
        quadrature: column[20],
    }
}

/// The radiance where shadow rays are too short by `epsilon`: the integral over theta, in the textbook form.
fn radiance(scene: &Scene, epsilon: f64) -> f64 {
    let Some((t_a, t_b)) = scene.lit() else { return 0.0 };
    let over_theta = |theta: f64| {
        let t = scene.t_h() + scene.h() * theta.tan();
        let r = scene.r(t);
        scene.integrand(t) * (scene.mu_t() * epsilon * r).exp() * r * r / scene.h()
    };
    integrate(over_theta, scene.theta(t_a), scene.theta(t_b), 1e-10)
}

#[test]
fn the_renderer_agrees_within_its_noise() {
    let mut worst: f64 = 0.0;
    for row in rows() {
        let value = row.scale * radiance(&row.scene, SHADOW_EPSILON);
        if row.scene.lit().is_none() {
            assert_eq!((row.reference, value), (0.0, 0.0), "line {}", row.line);
            continue;
        }
        let z = (row.reference - value) / row.standard_error;
        assert!(z.abs() <= 4.0, "line {}: {z} standard errors", row.line);
        worst = worst.max(z.abs());
    }
    assert!(worst > 2.0, "of hundreds of rows the worst is off by {worst} standard errors: too good to be true");
}

#[test]
fn the_quadrature_agrees() {
    for row in rows() {
        let value = row.scale * row.scene.radiance();
        let error = (value - row.quadrature).abs();
        assert!(error <= 1e-5 * row.quadrature, "line {}: {value:e} is not {:e}", row.line, row.quadrature);
    }
}

#[test]
fn both_of_our_integrals_agree() {
    for row in rows() {
        let (value, expected) = (row.scene.radiance(), radiance(&row.scene, 0.0));
        assert!((value - expected).abs() <= 1e-9 * expected, "line {}: {value:e} is not {expected:e}", row.line);
    }
}

#[test]
fn behind_the_disk_it_is_dark() {
    let rows = rows();
    let dark: Vec<&Row> = rows.iter().filter(|row| row.quadrature == 0.0).collect();
    assert_eq!(dark.len(), 124);
    for row in dark {
        assert_eq!(row.scene.radiance(), 0.0, "line {}", row.line);
    }
}
