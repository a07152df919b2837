//! Third stage: the light that the surface at the end of each ray emits and reflects, seen through the medium.

use super::camera::RayQueue;
use super::columns::Vectors;
use super::scene::{Object, Scene};
use super::shadow::{ShadowQueue, ShadowRay};
use glam::Vec3;
use std::f32::consts::FRAC_1_PI;

/// Writes what surfaces emit towards the eye.
pub fn emit(scene: &Scene, rays: &RayQueue, hits: &[u32], emitted: &mut Vectors) {
    emitted.fill(rays.len(), |i| match scene.objects.get(hits[i] as usize) {
        Some(object) => object.emission * scene.transmittance(rays.t_max[i]),
        None => Vec3::ZERO,
    });
}

/// Sends a shadow ray to one light from every surface, with what that adds to the pixel.
///
/// The light is chosen in proportion to what it adds if nothing is in its way. That, divided by the probability, is as
/// bright whichever light is chosen.
pub fn reflect(scene: &Scene, rays: &RayQueue, hits: &[u32], u: &[f32], shadows: &mut ShadowQueue) {
    shadows.fill(rays.len(), |i| {
        let Some(object) = scene.objects.get(hits[i] as usize) else { return ShadowRay::default() };
        let x = rays.point(i, rays.t_max[i]);
        let normal = object.shape.normal(x);
        let facing = if normal.dot(rays.direction.at(i)) > 0.0 { -normal } else { normal };
        let added = |light: usize| added(scene, object, (x, facing), rays.t_max[i], light);

        let (mut ray, mut share, mut total, mut u) = (ShadowRay { from: x, ..ShadowRay::default() }, 0.0, 0.0, u[i]);
        for light in 0..scene.lights.len() {
            let radiance = added(light);
            let brightness = radiance.element_sum();
            if brightness > 0.0 {
                // Each light takes the place of those before it with its part of what there is so far.
                total += brightness;
                let part = brightness / total;
                if u < part {
                    (ray.light, ray.radiance, share) = (light as u32, radiance, brightness);
                    u /= part;
                } else {
                    u = (u - part) / (1.0 - part);
                }
            }
        }
        if share > 0.0 {
            ray.radiance *= total / share;
        }
        ray
    });
}

/// The radiance that `light` adds by way of a point with a normal, seen from a distance of `t`.
fn added(scene: &Scene, object: &Object, (x, normal): (Vec3, Vec3), t: f32, light: usize) -> Vec3 {
    let (to_light, r, intensity) = scene.lights[light].seen_from(x);
    let cosine = normal.dot(to_light);
    if cosine <= 0.0 || intensity == Vec3::ZERO {
        return Vec3::ZERO;
    }
    object.albedo * intensity * (FRAC_1_PI * cosine * scene.transmittance(t + r) / (r * r))
}
