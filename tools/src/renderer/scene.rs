//! What is rendered: objects, lights, a medium that fills all of space, and a camera in it.

use super::camera::Camera;
use airlight::{Cone, Emitter, Medium};
use glam::Vec3;

/// A scene.
#[derive(Clone, Debug)]
pub struct Scene {
    /// Who looks.
    pub camera: Camera,
    /// The air: grey, or with coefficients for red, green and blue.
    pub medium: Medium,
    /// What is in it.
    pub objects: Vec<Object>,
    /// What lights it; at least one.
    pub lights: Vec<Light>,
    /// Factor of the radiance before the tone curve.
    pub exposure: f32,
}

/// A light: an emitter with a colour.
#[derive(Clone, Copy, Debug)]
pub struct Light {
    /// Where it is and where it turns.
    pub emitter: Emitter,
    /// Radiant intensity along the normal or axis, red, green and blue \[W/sr\].
    pub intensity: Vec3,
}

/// A shape with a material.
#[derive(Clone, Debug)]
pub struct Object {
    /// Its surface.
    pub shape: Shape,
    /// Reflectance of the Lambertian surface.
    pub albedo: Vec3,
    /// Radiance that it emits to the eye. It lights nothing: that is for the lights.
    pub emission: Vec3,
    /// Whether it casts a shadow.
    pub occludes: bool,
}

/// A surface.
#[derive(Clone, Debug)]
pub enum Shape {
    /// All points at a distance from a centre.
    Sphere {
        /// Its centre \[m\].
        centre: Vec3,
        /// Its radius \[m\].
        radius: f32,
    },
    /// A plane without end.
    Plane {
        /// A point of it \[m\].
        point: Vec3,
        /// Its unit normal.
        normal: Vec3,
        /// Round holes: centres \[m\] in the plane and radii \[m\].
        openings: Vec<(Vec3, f32)>,
    },
}

impl Scene {
    /// The part of the light, red, green and blue, that is left after this many metres.
    #[must_use]
    pub fn transmittance(&self, distance: f32) -> Vec3 {
        let of = |medium: Medium| (-medium.mu_t() * distance).exp();
        match [0, 1, 2].map(|c| self.medium.channel(c)) {
            [Some(red), Some(green), Some(blue)] => Vec3::new(of(red), of(green), of(blue)),
            _ => Vec3::splat(of(self.medium)),
        }
    }

    /// The same without shadows: every light reaches every point before it.
    #[must_use]
    pub fn without_occluders(mut self) -> Self {
        for object in &mut self.objects {
            object.occludes = false;
        }
        self
    }
}

impl Light {
    /// From `x` to the light, the distance, and the radiant intensity towards `x` before any extinction.
    #[must_use]
    pub fn seen_from(&self, x: Vec3) -> (Vec3, f32, Vec3) {
        let to_light = Vec3::from(self.emitter.position()) - x;
        let r = to_light.length();
        let cosine = self.emitter.normal().map_or(1.0, |normal| (-Vec3::from(normal).dot(to_light) / r).max(0.0));
        let falloff = self.emitter.cone().map_or(1.0, |cone| falloff(&cone, -to_light / r));
        (to_light / r, r, self.intensity * cosine * falloff)
    }
}

/// The part of a spot's intensity that goes into a direction.
fn falloff(cone: &Cone, direction: Vec3) -> f32 {
    let (x, outer) = (Vec3::from(cone.axis()).normalize().dot(direction), cone.cos_outer());
    let width = cone.cos_inner() - outer;
    let s = if width > 0.0 { ((x - outer) / width).clamp(0.0, 1.0) } else { f32::from(u8::from(x >= outer)) };
    s * s * (3.0 - 2.0 * s)
}

impl Shape {
    /// The distance at which a ray first meets it, beyond `nearest` \[m\].
    #[must_use]
    pub fn meet(&self, origin: Vec3, direction: Vec3, nearest: f32) -> Option<f32> {
        match self {
            Self::Sphere { centre, radius } => {
                let to_centre = centre - origin;
                let middle = to_centre.dot(direction);
                // From the ray's point next to the centre: no difference of large squares.
                let aside = (to_centre - middle * direction).length_squared();
                if aside >= radius * radius {
                    return None;
                }
                let half = (radius * radius - aside).sqrt();
                [middle - half, middle + half].into_iter().find(|t| *t > nearest)
            }
            Self::Plane { point, normal, openings } => {
                let t = normal.dot(point - origin) / normal.dot(direction);
                // A ray along the plane has no finite t.
                let met = t > nearest && t.is_finite();
                let x = origin + t * direction;
                let through = |(centre, radius): &(Vec3, f32)| x.distance_squared(*centre) < radius * radius;
                (met && !openings.iter().any(through)).then_some(t)
            }
        }
    }

    /// The unit normal at a point of it.
    #[must_use]
    pub fn normal(&self, x: Vec3) -> Vec3 {
        match self {
            Self::Sphere { centre, radius } => (x - centre) / radius,
            Self::Plane { normal, .. } => *normal,
        }
    }
}
