//! Two spots in tinted fog, an amber and a blue one, above a ceiling with holes: shafts that cross, and in some of them a
//! sphere with a shaft of shadow behind it.

use super::{plane, sphere};
use crate::renderer::camera::Camera;
use crate::renderer::scene::{Light, Object, Scene, Shape};
use airlight::{Emitter, Error, Medium};
use glam::Vec3;

/// Height of the ceiling \[m\].
const CEILING: f32 = 4.3;
/// Radius of its holes \[m\].
const HOLE: f32 = 0.2;

pub(super) fn scene() -> Result<Scene, Error> {
    let amber = Spot { position: Vec3::new(-2.7, 7.4, -1.6), target: Vec3::new(1.15, 0.0, -0.5) };
    let blue = Spot { position: Vec3::new(2.7, 7.4, -1.6), target: Vec3::new(-1.15, 0.0, -0.5) };
    let ceiling = Object {
        shape: Shape::Plane {
            point: Vec3::new(0.0, CEILING, 0.0),
            normal: Vec3::Y,
            openings: amber.holes().chain(blue.holes()).collect(),
        },
        albedo: Vec3::splat(0.3),
        emission: Vec3::ZERO,
        occludes: true,
    };
    let pale = Vec3::splat(0.8);
    let objects = vec![
        ceiling,
        plane(Vec3::ZERO, Vec3::Y, Vec3::splat(0.4)),
        plane(Vec3::new(0.0, 0.0, -4.5), Vec3::Z, Vec3::splat(0.6)),
        sphere(Vec3::new(0.0, 0.8, -0.5), 0.8, pale),
        sphere(Vec3::new(-1.45, 0.55, -1.6), 0.55, pale),
        sphere(Vec3::new(-2.35, 0.36, 0.25), 0.36, pale),
        sphere(Vec3::new(2.35, 0.3, 0.35), 0.3, pale),
        sphere(Vec3::new(1.15, 0.26, 0.45), 0.26, pale),
    ];
    let lights = vec![amber.light(Vec3::new(1.0, 0.56, 0.2))?, blue.light(Vec3::new(0.2, 0.58, 1.0))?];
    Ok(Scene {
        camera: Camera { eye: Vec3::new(0.5, 2.3, 7.4), target: Vec3::new(0.0, 1.7, -0.6), field_of_view: 35.0 },
        medium: Medium::coloured([0.006; 3], [0.06, 0.07, 0.085], 0.25)?,
        objects,
        lights,
        exposure: 6.5,
    })
}

/// A spot and the middle of what it lights on the floor.
struct Spot {
    position: Vec3,
    target: Vec3,
}

impl Spot {
    fn light(&self, colour: Vec3) -> Result<Light, Error> {
        let axis = (self.target - self.position).normalize();
        let [outer, inner] = [21.0f32, 12.0].map(|degrees| degrees.to_radians().cos());
        Ok(Light { emitter: Emitter::spot(self.position, axis, outer, inner)?, intensity: 520.0 * colour })
    }

    /// Two rows of three holes, through which it shines at as many places of the floor.
    fn holes(&self) -> impl Iterator<Item = (Vec3, f32)> {
        let part = (self.position.y - CEILING) / self.position.y;
        [-0.8, 0.8].into_iter().flat_map(move |z| {
            let hole = move |x| self.position.lerp(self.target + Vec3::new(x, 0.0, z), part);
            [-1.35, 0.0, 1.35].map(move |x| (hole(x), HOLE))
        })
    }
}
