//! Scenes whose densities are drawn: one ray and one emitter in media that differ.

use airlight::oracle::Scene;
use airlight::{Emitter, Medium, Ray};
use anyhow::Result;
use glam::Vec3;

/// The emitter's distance along the ray and beside it \[m\].
const EMITTER: (f32, f32) = (1.6, 0.5);
/// The direction of the normal of an emitter that turns away from the start of the ray.
const AWAY: Vec3 = Vec3::new(0.8, -0.6, 0.0);
/// Length of the rays \[m\].
const LENGTH: f32 = 4.0;

/// A ray from the origin along x, with an emitter beside it.
pub(super) struct Example {
    /// The name of its figure.
    pub(super) name: &'static str,
    pub(super) title: &'static str,
    turned_away: bool,
    /// `mu_a`, `mu_s`, `g`.
    medium: (f32, f32, f32),
}

pub(super) const THIN: Example =
    Example { name: "figure-3-thin", title: "Thin air, a point emitter", turned_away: false, medium: (0.0, 0.02, 0.0) };
pub(super) const THIN_AWAY: Example = Example {
    name: "figure-3-normal",
    title: "Thin air, an emitter that turns away",
    turned_away: true,
    medium: (0.0, 0.02, 0.0),
};
pub(super) const DENSE: Example = Example {
    name: "figure-3-dense",
    title: "Dense fog, a point emitter",
    turned_away: false,
    medium: (0.0, 2.5, 0.0),
};
pub(super) const DENSE_AWAY: Example = Example {
    name: "figure-3-all",
    title: "Dense, forward (g 0.85), turned away",
    turned_away: true,
    medium: (0.0, 1.5, 0.85),
};

impl Example {
    pub(super) fn inputs(&self) -> Result<(Ray, Emitter, Medium)> {
        let (along, beside) = EMITTER;
        let place = Vec3::new(along, beside, 0.0);
        let emitter = if self.turned_away { Emitter::point_normal(place, AWAY)? } else { Emitter::point(place)? };
        let (mu_a, mu_s, g) = self.medium;
        Ok((Ray::new(Vec3::ZERO, Vec3::X, 0.0, LENGTH)?, emitter, Medium::new(mu_a, mu_s, g)?))
    }

    pub(super) fn scene(&self) -> Result<Scene> {
        let (ray, emitter, medium) = self.inputs()?;
        Ok(Scene::new(&ray, &emitter, &medium))
    }
}

/// The integrand of a scene \[1/m\], normalised: its integral over the ray is 1.
pub(super) fn normalised(scene: &Scene) -> impl Fn(f64) -> f64 {
    let radiance = scene.radiance();
    move |t| {
        let lit = scene.lit().is_some_and(|(t_a, t_b)| (t_a..=t_b).contains(&t));
        if lit { scene.integrand(t) / radiance } else { 0.0 }
    }
}

/// A variance in few letters.
pub(super) fn brief(variance: f64) -> String {
    if variance < 0.01 { format!("{:.0e}", variance.max(0.0)) } else { format!("{variance:.2}") }
}
