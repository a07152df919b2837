//! Last stage but the film: what lies between a point and its light.

use super::columns::{Vectors, places};
use super::scene::Scene;
use glam::Vec3;
use rayon::prelude::*;
use std::fmt;
use std::str::FromStr;

/// What a shadow ray leaves out at both its ends \[m\]: the surface it starts from, and the lamp.
const GAP: f32 = 1e-4;

/// How the airlight is estimated where there may be shadows.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Shadows {
    /// The mean of `V f/p` over the samples, with `V` 1 where the light is seen and 0 else.
    #[default]
    Plain,
    /// The mean of the [integrals](super::unshadowed) of the rays, times the sum of `V f/p` over that of `f/p`; of each pixel
    /// and channel, over all lights and passes.
    ///
    /// What noise the samples have without shadows is in both sums and cancels: a pixel that no shadow reaches is the
    /// integral. As both sums converge it is consistent, but for the error of the integral with eight nodes. It is biased, for the mean of a quotient is not the quotient of the
    /// means: by an amount that falls as one over the passes, where the error of the plain mean falls as one over their root
    /// or, with Sobol's points, somewhat faster. A pixel of which no sample is lit is black.
    Ratio,
}

impl Shadows {
    /// Its name on the command line and in JSON.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Plain => "plain",
            Self::Ratio => "ratio",
        }
    }
}

impl fmt::Display for Shadows {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.pad(self.name())
    }
}

impl FromStr for Shadows {
    type Err = String;
    fn from_str(name: &str) -> Result<Self, String> {
        let mut all = [Self::Plain, Self::Ratio].into_iter();
        all.find(|shadows| shadows.name() == name).ok_or_else(|| "expected plain or ratio".to_owned())
    }
}

/// A shadow ray for each pixel of the wave, as columns.
#[derive(Clone, Debug, Default)]
pub struct ShadowQueue {
    from: Vectors,
    light: Vec<u32>,
    /// What the pixels receive.
    pub radiance: Vectors,
}

/// One of them.
#[derive(Clone, Copy, Debug, Default)]
pub struct ShadowRay {
    /// Where it starts \[m\].
    pub from: Vec3,
    /// The number of the light it goes to.
    pub light: u32,
    /// What its pixel receives if nothing is in the way; zero asks nothing.
    pub radiance: Vec3,
}

impl ShadowQueue {
    /// `count` rays, each what `ray` has for its place.
    pub fn fill(&mut self, count: usize, ray: impl Fn(usize) -> ShadowRay + Sync) {
        let Self { from, light, radiance } = self;
        let places = (from.places(count), places(light, count), radiance.places(count)).into_par_iter();
        places.enumerate().for_each(|(i, (from, light, radiance))| {
            let ray = ray(i);
            from.put(ray.from);
            *light = ray.light;
            radiance.put(ray.radiance);
        });
    }

    /// Takes the radiance from the rays that something is in the way of.
    pub fn trace(&mut self, scene: &Scene) {
        let Self { from, light, radiance } = self;
        radiance.places(light.len()).enumerate().for_each(|(i, radiance)| {
            if radiance.get() != Vec3::ZERO && !is_visible(scene, from.at(i), light[i] as usize) {
                radiance.put(Vec3::ZERO);
            }
        });
    }
}

/// Whether `x` sees the light.
fn is_visible(scene: &Scene, x: Vec3, light: usize) -> bool {
    let (to_light, r, _) = scene.lights[light].seen_from(x);
    let mut occluders = scene.objects.iter().filter(|object| object.occludes);
    !occluders.any(|object| object.shape.meet(x, to_light, GAP).is_some_and(|t| t < r - GAP))
}
