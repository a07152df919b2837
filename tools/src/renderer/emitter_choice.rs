//! Third stage on the way of the airlight: one light for each ray.

use super::camera::RayQueue;
use super::columns::places;
use super::scene::Scene;
use airlight::{Emitter, Emitters, Error, Integral, Media, Nodes};
use rayon::prelude::*;
use std::fmt;
use std::str::FromStr;

/// The part of the probability that all lights share alike, whatever their estimates: none that lights the ray may have
/// none, and those behind an occluder must not have all.
const SHARED: f32 = 0.1;

/// So many neighbouring rays are guided by the estimates of the first of them. Any guide is right, for each light has
/// its share of the probability; this one costs an eighth.
const NEIGHBOURS: usize = 8;

/// How a light is chosen.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum EmitterChoice {
    /// All with the same probability.
    Uniform,
    /// In proportion to intensity times the integral of the ray's radiance with four nodes.
    #[default]
    Radiance,
}

impl EmitterChoice {
    /// Its name on the command line and in JSON.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Uniform => "uniform",
            Self::Radiance => "radiance",
        }
    }
}

impl fmt::Display for EmitterChoice {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.pad(self.name())
    }
}

impl FromStr for EmitterChoice {
    type Err = String;
    fn from_str(name: &str) -> Result<Self, String> {
        let mut all = [Self::Uniform, Self::Radiance].into_iter();
        all.find(|choice| choice.name() == name).ok_or_else(|| "expected uniform or radiance".to_owned())
    }
}

/// The chosen lights.
#[derive(Debug)]
pub struct Choice {
    how: EmitterChoice,
    integral: Integral,
    guides: RayQueue,
    /// For every light, what it is expected to add to each of the guides.
    estimates: Vec<Vec<f32>>,
    /// The numbers of the lights.
    pub light: Vec<u32>,
    /// Their probabilities.
    pub probability: Vec<f32>,
    /// All lights.
    emitters: Vec<Emitter>,
}

impl Choice {
    /// Nothing is chosen yet.
    #[must_use]
    pub fn new(how: EmitterChoice) -> Self {
        Self {
            how,
            integral: Integral::new(Nodes::Four),
            guides: RayQueue::default(),
            estimates: Vec::new(),
            light: Vec::new(),
            probability: Vec::new(),
            emitters: Vec::new(),
        }
    }

    /// Chooses a light for every ray.
    ///
    /// # Errors
    /// Those of a malformed call of airlight.
    pub fn choose(&mut self, scene: &Scene, queue: &RayQueue, u: &[f32]) -> Result<(), Error> {
        let count = scene.lights.len();
        let guided = self.how == EmitterChoice::Radiance && count > 1;
        if guided {
            self.estimates.resize(count, Vec::new());
            self.guides.thin(queue, NEIGHBOURS);
            for (light, estimate) in scene.lights.iter().zip(&mut self.estimates) {
                estimate.resize(self.guides.len(), 0.0);
                let emitter = Emitters::one(light.emitter);
                self.integral.radiance(&self.guides.rays(), &emitter, &Media::one(scene.medium), estimate)?;
                let brightness = light.intensity.element_sum();
                estimate.iter_mut().for_each(|estimate| *estimate *= brightness);
            }
        }
        let uniform = 1.0 / count as f32;
        let expected = |i: usize, light: usize| self.estimates[light][i / NEIGHBOURS];
        let places = (places(&mut self.light, queue.len()), places(&mut self.probability, queue.len()));
        places.into_par_iter().enumerate().for_each(|(i, (chosen, probability))| {
            let total: f32 = if guided { (0..count).map(|light| expected(i, light)).sum() } else { 0.0 };
            let mut left = u[i];
            // Where rounding leaves a rest, it is the last light's.
            for light in 0..count {
                let guide = if total > 0.0 { expected(i, light) / total } else { uniform };
                (*chosen, *probability) = (light as u32, SHARED * uniform + (1.0 - SHARED) * guide);
                if left < *probability {
                    break;
                }
                left -= *probability;
            }
        });
        self.emitters.clear();
        self.emitters.extend(scene.lights.iter().map(|light| light.emitter));
        Ok(())
    }

    /// The chosen lights as airlight takes them.
    #[must_use]
    pub fn emitters(&self) -> Emitters<'_> {
        Emitters::table(&self.emitters, &self.light)
    }
}
