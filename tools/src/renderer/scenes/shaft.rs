//! One light outside a dark hall, whose wall has round windows: shafts of light, and in two of them a sphere with a
//! shaft of shadow behind it.

use super::{plane, sphere};
use crate::renderer::camera::Camera;
use crate::renderer::scene::{Light, Object, Scene, Shape};
use airlight::{Emitter, Error, Medium};
use glam::Vec3;

pub(super) fn scene() -> Result<Scene, Error> {
    let stone = Vec3::new(0.62, 0.58, 0.52);
    let sun = Vec3::new(-9.0, 8.0, -1.5);
    let window = |z: f32| (Vec3::new(-4.0, 3.4, z), 0.55);
    let wall = Object {
        shape: Shape::Plane {
            point: Vec3::new(-4.0, 0.0, 0.0),
            normal: Vec3::X,
            openings: [-3.9, -2.3, -0.7, 0.9].map(window).into(),
        },
        albedo: stone,
        emission: Vec3::ZERO,
        occludes: true,
    };
    let objects = vec![
        wall,
        plane(Vec3::ZERO, Vec3::Y, stone),
        plane(Vec3::new(0.0, 0.0, -8.0), Vec3::Z, stone),
        sphere(Vec3::new(-2.75, 2.25, 1.5), 0.25, stone),
        sphere(Vec3::new(-1.1, 0.75, -0.25), 0.75, Vec3::new(0.75, 0.4, 0.25)),
        sphere(Vec3::new(-1.6, 0.6, -4.6), 0.6, Vec3::new(0.35, 0.5, 0.6)),
    ];
    let emitter = Emitter::point_normal(sun, Vec3::new(0.72, -0.69, 0.06).normalize())?;
    Ok(Scene {
        camera: Camera { eye: Vec3::new(3.4, 1.6, 7.4), target: Vec3::new(-1.6, 1.7, -0.6), field_of_view: 36.0 },
        medium: Medium::new(0.005, 0.08, 0.3)?,
        objects,
        lights: vec![Light { emitter, intensity: 900.0 * Vec3::new(1.0, 0.86, 0.66) }],
        exposure: 2.5,
    })
}
