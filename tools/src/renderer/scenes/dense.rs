//! Lamps among spheres, in air so thick that each is a ball of light and the next one is dim.

use super::{lamp, plane, sphere};
use crate::renderer::camera::Camera;
use crate::renderer::scene::Scene;
use airlight::{Error, Medium};
use glam::Vec3;

pub(super) fn scene() -> Result<Scene, Error> {
    let pale = Vec3::splat(0.7);
    let mut objects = vec![
        plane(Vec3::ZERO, Vec3::Y, Vec3::splat(0.5)),
        sphere(Vec3::new(-0.75, 0.5, 0.6), 0.5, pale),
        sphere(Vec3::new(0.85, 0.4, 1.2), 0.4, pale),
        sphere(Vec3::new(0.3, 0.7, -0.9), 0.7, pale),
        sphere(Vec3::new(-1.9, 0.6, -1.2), 0.6, pale),
        sphere(Vec3::new(2.0, 0.65, -0.8), 0.65, pale),
    ];
    let mut lights = Vec::new();
    for (position, colour, intensity) in [
        (Vec3::new(0.1, 1.35, 0.7), Vec3::new(1.0, 0.72, 0.4), 1.2),
        (Vec3::new(-1.5, 1.6, 0.0), Vec3::new(0.4, 0.75, 1.0), 2.0),
        (Vec3::new(1.7, 1.7, 0.2), Vec3::new(1.0, 0.4, 0.45), 2.0),
        (Vec3::new(-0.4, 1.9, -1.9), Vec3::new(0.8, 1.0, 0.6), 5.0),
    ] {
        let (light, globe) = lamp(position, Vec3::NEG_Y, colour, intensity, 0.04)?;
        lights.push(light);
        objects.push(globe);
    }
    Ok(Scene {
        camera: Camera { eye: Vec3::new(0.0, 1.3, 4.2), target: Vec3::new(0.0, 0.8, 0.0), field_of_view: 40.0 },
        medium: Medium::new(0.08, 0.6, 0.3)?,
        objects,
        lights,
        exposure: 12.0,
    })
}
