//! Lamps that face the eye from behind spheres, in air that scatters forward: each has a corona, and each sphere a
//! shadow that comes towards the eye.

use super::{lamp, plane, sphere};
use crate::renderer::camera::Camera;
use crate::renderer::scene::Scene;
use airlight::{Error, Medium};
use glam::Vec3;

pub(super) fn scene() -> Result<Scene, Error> {
    let eye = Vec3::new(0.0, 1.4, 7.0);
    let dark = Vec3::splat(0.25);
    let mut objects = vec![
        plane(Vec3::ZERO, Vec3::Y, dark),
        sphere(Vec3::new(0.0, 1.75, -2.0), 0.9, dark),
        sphere(Vec3::new(-1.7, 0.9, -1.0), 0.32, dark),
        sphere(Vec3::new(1.5, 2.7, -2.5), 0.28, dark),
        sphere(Vec3::new(1.75, 0.8, -0.5), 0.38, dark),
        sphere(Vec3::new(-1.35, 2.75, -2.2), 0.2, dark),
    ];
    let mut lights = Vec::new();
    for (position, colour, intensity) in [
        (Vec3::new(0.85, 2.55, -5.0), Vec3::new(1.0, 0.8, 0.55), 40.0),
        (Vec3::new(-4.6, 1.5, -8.0), Vec3::new(0.4, 0.65, 1.0), 16.0),
        (Vec3::new(4.9, 1.7, -9.0), Vec3::new(1.0, 0.5, 0.35), 16.0),
    ] {
        let (light, globe) = lamp(position, (eye - position).normalize(), colour, intensity, 0.1)?;
        lights.push(light);
        objects.push(globe);
    }
    Ok(Scene {
        camera: Camera { eye, target: Vec3::new(0.0, 1.6, -5.0), field_of_view: 42.0 },
        medium: Medium::new(0.01, 0.08, 0.9)?,
        objects,
        lights,
        exposure: 2.0,
    })
}
