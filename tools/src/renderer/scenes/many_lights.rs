//! Rows of lanterns in several colours, each over its own piece of a field of spheres.

use super::{lamp, plane, sphere};
use crate::draw::Draw;
use crate::renderer::camera::Camera;
use crate::renderer::scene::Scene;
use airlight::{Error, Medium};
use glam::Vec3;

const COLOURS: [Vec3; 4] =
    [Vec3::new(1.0, 0.55, 0.2), Vec3::new(1.0, 0.78, 0.45), Vec3::new(0.25, 0.7, 0.9), Vec3::new(0.95, 0.3, 0.45)];

pub(super) fn scene() -> Result<Scene, Error> {
    let mut objects = vec![plane(Vec3::ZERO, Vec3::Y, Vec3::splat(0.45))];
    let mut lights = Vec::new();
    let mut draw = Draw::new(5, 0, 0);
    for row in 0..5 {
        for column in 0..8 {
            let mut near = |middle: f32, spread: f32| draw.between(middle - spread, middle + spread);
            let (x, z) = (2.2 * (column as f32 - 3.5), 1.0 - 2.6 * row as f32);
            let place = Vec3::new(near(x, 0.7), near(1.6, 0.5), near(z, 0.8));
            let colour = COLOURS[(column * 3 + row * 5 + column * row) % COLOURS.len()];
            let (light, globe) = lamp(place, Vec3::NEG_Y, colour, 2.0, 0.06)?;
            lights.push(light);
            objects.push(globe);
            let radius = near(0.3, 0.12);
            let centre = Vec3::new(near(x + 1.1, 0.6), radius, near(z, 0.9));
            objects.push(sphere(centre, radius, Vec3::splat(0.7)));
        }
    }
    Ok(Scene {
        camera: Camera { eye: Vec3::new(0.5, 1.5, 5.4), target: Vec3::new(0.0, 0.65, -3.0), field_of_view: 36.0 },
        medium: Medium::new(0.01, 0.12, 0.2)?,
        objects,
        lights,
        exposure: 3.0,
    })
}
