//! Fourth stage on the way of the airlight: where along each ray the chosen light is scattered. The stage that
//! this library is for.

use super::camera::RayQueue;
use super::columns::{Channels, Tones};
use super::emitter_choice::Choice;
use super::scene::Scene;
use super::shadow::{ShadowQueue, ShadowRay};
use airlight::{Error, Media, Sampler, Samples, Strategy};

/// Samples distances from one density, or from two whose samples are combined.
#[derive(Debug)]
pub struct Scattering {
    samplers: Vec<Sampler>,
    t: Vec<f32>,
    pdf: Vec<f32>,
    weight: Tones,
    other_pdf: Vec<f32>,
}

impl Scattering {
    /// Sampling with `sampler`, and from the transmittance besides if there is multiple importance sampling.
    #[must_use]
    pub fn new(sampler: Sampler, mis: bool) -> Self {
        let transmittance = Sampler::new(Strategy::Transmittance);
        let transmittance = transmittance.with_precision(sampler.precision()).unwrap_or(transmittance);
        let samplers = [sampler].into_iter().chain(mis.then_some(transmittance)).collect();
        Self { samplers, t: Vec::new(), pdf: Vec::new(), weight: Tones::default(), other_pdf: Vec::new() }
    }

    /// The number of densities: each ray is sampled once with each.
    #[must_use]
    pub fn densities(&self) -> usize {
        self.samplers.len()
    }

    /// Samples a distance on every ray with density number `density`.
    ///
    /// # Errors
    /// Those of a malformed call of airlight.
    pub fn sample(
        &mut self,
        density: usize,
        scene: &Scene,
        queue: &RayQueue,
        choice: &Choice,
        u: &[f32],
    ) -> Result<(), Error> {
        let Self { samplers, t, pdf, weight, other_pdf } = self;
        for column in [&mut *t, pdf, other_pdf] {
            column.resize(queue.len(), 0.0);
        }
        let (rays, emitters, media) = (queue.rays(), choice.emitters(), Media::one(scene.medium));
        let samples = Samples::new(t, pdf);
        let mut samples = match weight.places(&scene.medium, queue.len()) {
            Channels::Grey(weights) => samples.weights(weights),
            Channels::Rgb(weights) => samples.weights(weights),
        };
        samplers[density].sample(&rays, &emitters, &media, u, &mut samples)?;
        if let [first, second] = &samplers[..] {
            let other = if density == 0 { second } else { first };
            other.pdf(&rays, &emitters, &media, t, other_pdf)?;
            weight.scale(|i| balance(pdf[i], other_pdf[i]));
        }
        Ok(())
    }

    /// Sends a shadow ray from every sampled point to its light, with what that adds to the pixel: the weight has all
    /// but the intensity and the probability of the light.
    pub fn light(&self, scene: &Scene, rays: &RayQueue, choice: &Choice, shadows: &mut ShadowQueue) {
        shadows.fill(rays.len(), |i| {
            let (light, probability) = (choice.light[i], choice.probability[i]);
            if probability == 0.0 {
                return ShadowRay::default();
            }
            let intensity = scene.lights[light as usize].intensity;
            let radiance = intensity * (self.weight.at(i) / probability);
            ShadowRay { from: rays.point(i, self.t[i]), light, radiance }
        });
    }
}

/// The balance heuristic's weight of a sample, from its density and that of the other strategy.
fn balance(pdf: f32, other: f32) -> f32 {
    // Of two densities below f32's range the sample's own is as good as any.
    if other > 0.0 { 1.0 / (1.0 + other / pdf) } else { 1.0 }
}
