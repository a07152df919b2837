//! Second stage: the nearest object that each ray meets, which ends its way through the medium.

use super::camera::RayQueue;
use super::columns::places;
use super::scene::Scene;
use rayon::prelude::*;

/// The hit of a ray that meets nothing.
pub const NOTHING: u32 = u32::MAX;

/// Writes `t_max` of the rays and the numbers of the objects they meet.
pub fn intersect(scene: &Scene, rays: &mut RayQueue, hits: &mut Vec<u32>) {
    let RayQueue { origin, direction, t_max, .. } = rays;
    let count = t_max.len();
    let places = (places(t_max, count), places(hits, count)).into_par_iter();
    places.enumerate().for_each(|(i, (t_max, hit))| {
        (*t_max, *hit) = (f32::INFINITY, NOTHING);
        for (object, number) in scene.objects.iter().zip(0..) {
            if let Some(t) = object.shape.meet(origin.at(i), direction.at(i), 0.0).filter(|t| t < t_max) {
                (*t_max, *hit) = (t, number);
            }
        }
    });
}
