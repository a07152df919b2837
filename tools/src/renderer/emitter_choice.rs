//! Third stage on the way of the airlight: one light for each ray.

use super::camera::RayQueue;
use super::columns::places;
use super::scene::Scene;
use airlight::{Emitter, Emitters, Error, Integral, Media, Nodes, Precision};
use rayon::prelude::*;
use std::fmt;
use std::str::FromStr;

/// How a light is chosen.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum EmitterChoice {
    /// All with the same probability.
    Uniform,
    /// By [`Integral::choose`]: in proportion to intensity times the integral of the ray's radiance with four nodes.
    #[default]
    Choose,
}

impl EmitterChoice {
    /// Its name on the command line and in JSON.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Uniform => "uniform",
            Self::Choose => "choose",
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
        let mut all = [Self::Uniform, Self::Choose].into_iter();
        all.find(|choice| choice.name() == name).ok_or_else(|| "expected uniform or choose".to_owned())
    }
}

/// The chosen lights.
#[derive(Debug)]
pub struct Choice {
    how: EmitterChoice,
    integral: Integral,
    /// All lights, and the brightness of each.
    emitters: Vec<Emitter>,
    brightness: Vec<f32>,
    /// The numbers of the chosen ones.
    pub light: Vec<u32>,
    /// Their probabilities; 0 where no light reaches the ray.
    pub probability: Vec<f32>,
}

impl Choice {
    /// Nothing is chosen yet. What `precision` tells to be lit has a probability.
    #[must_use]
    pub fn new(how: EmitterChoice, scene: &Scene, precision: Precision) -> Self {
        Self {
            how,
            integral: Integral::new(Nodes::Four).with_precision(precision),
            emitters: scene.lights.iter().map(|light| light.emitter).collect(),
            brightness: scene.lights.iter().map(|light| light.intensity.element_sum()).collect(),
            light: Vec::new(),
            probability: Vec::new(),
        }
    }

    /// Chooses a light for every ray.
    ///
    /// # Errors
    /// Those of a malformed call of airlight.
    pub fn choose(&mut self, scene: &Scene, queue: &RayQueue, u: &[f32]) -> Result<(), Error> {
        let Self { integral, emitters, brightness, light, probability, .. } = self;
        let count = emitters.len();
        if self.how == EmitterChoice::Choose && count > 1 {
            light.resize(queue.len(), 0);
            probability.resize(queue.len(), 0.0);
            let media = Media::one(scene.medium);
            integral.choose(&queue.rays(), emitters, brightness, &media, u, light, probability)?;
        } else {
            places(light, queue.len()).zip(u).for_each(|(light, u)| *light = (count as f32 * u) as u32);
            probability.clear();
            probability.resize(queue.len(), 1.0 / count as f32);
        }
        Ok(())
    }

    /// The chosen lights as airlight takes them.
    #[must_use]
    pub fn emitters(&self) -> Emitters<'_> {
        Emitters::table(&self.emitters, &self.light)
    }
}
