//! Beside the way of the airlight: what of it there would be without shadows, from all lights and without a sample.

use super::camera::RayQueue;
use super::columns::{Channels, Tones, Vectors};
use super::scene::Scene;
use airlight::{Emitters, Error, Integral, Media, Nodes, Precision};
use glam::Vec3;
use rayon::prelude::*;

/// The integrals of the rays of a wave.
#[derive(Debug)]
pub struct Unshadowed {
    integral: Integral,
    of_light: Tones,
    /// Of each ray, the sum over the lights.
    pub radiance: Vectors,
}

impl Unshadowed {
    /// Nothing is integrated yet. What `precision` tells to be lit is.
    #[must_use]
    pub fn new(precision: Precision) -> Self {
        let integral = Integral::new(Nodes::Eight).with_precision(precision);
        Self { integral, of_light: Tones::default(), radiance: Vectors::default() }
    }

    /// Integrates along every ray.
    ///
    /// # Errors
    /// Those of a malformed call of airlight.
    pub fn integrate(&mut self, scene: &Scene, queue: &RayQueue) -> Result<(), Error> {
        let Self { integral, of_light, radiance } = self;
        let (rays, media) = (queue.rays(), Media::one(scene.medium));
        radiance.fill(queue.len(), |_| Vec3::ZERO);
        for light in &scene.lights {
            let emitters = Emitters::one(light.emitter);
            match of_light.places(&scene.medium, queue.len()) {
                Channels::Grey([grey]) => integral.radiance(&rays, &emitters, &media, grey)?,
                Channels::Rgb(rgb) => integral.radiance_coloured(&rays, &emitters, &media, rgb)?,
            };
            radiance.places(queue.len()).enumerate().for_each(|(i, place)| {
                let sum = place.get() + light.intensity * of_light.at(i);
                place.put(sum);
            });
        }
        Ok(())
    }
}
