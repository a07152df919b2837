//! One ray, one emitter and a medium of several channels: the light of each, and the one density for all of them.

use super::density::Sampled;
use super::scene::Scene;
use crate::Strategy;
use crate::scene::{Emitter, Medium, Ray};

/// One ray, one emitter and a medium of one or several channels in f64.
///
/// All channels share the distances. A product density is the mixture, in equal parts, of those of the channels that scatter,
/// all at the knots of the [mean](Self::mean)'s: proportional to the sum of `f_c/F_c`, with `f_c` the line through what
/// channel `c` has at the knots and `F_c` its integral. So no channel's relative variance is above `C (1 + V_c) - 1`, for `C`
/// channels and `V_c` by the line of its own. If no channel scatters all take part. The density of any other strategy is that
/// of the mean.
///
/// A scene without a lit part has no density: its pdf is 0, and its cdf and the inverse are NaN.
#[derive(Clone, Debug, PartialEq)]
pub struct Coloured {
    mean: Scene,
    channels: Vec<Scene>,
}

impl Coloured {
    /// The scene that the f32 values describe.
    #[must_use]
    pub fn new(ray: &Ray, emitter: &Emitter, medium: &Medium) -> Self {
        let mean = Scene::new(ray, emitter, &medium.mean());
        let channels = (0..).map_while(|c| medium.channel(c)).map(|medium| mean.with_medium(&medium)).collect();
        Self { mean, channels }
    }

    /// The scene of the [mean medium](Medium::mean), with the geometry of all channels.
    #[must_use]
    pub fn mean(&self) -> &Scene {
        &self.mean
    }

    /// The scene of each channel.
    #[must_use]
    pub fn channels(&self) -> &[Scene] {
        &self.channels
    }

    /// What is scattered into the ray at `t` \[m\] in each channel, `mu_s T rho N S / r^2` \[1/m^3\], for unit intensity.
    #[must_use]
    pub fn integrand(&self, t: f64) -> Vec<f64> {
        self.channels.iter().map(|channel| channel.integrand(t)).collect()
    }

    /// The radiance scattered once in each channel, for unit intensity \[1/m^2\].
    #[must_use]
    pub fn radiance(&self) -> Vec<f64> {
        self.channels.iter().map(Scene::radiance).collect()
    }

    /// The probability of a distance of at most `t` \[m\].
    #[must_use]
    pub fn cdf(&self, strategy: Strategy, t: f64) -> f64 {
        self.sampled(strategy).map_or(f64::NAN, |sampled| sampled.cdf(t))
    }

    /// The probability density at `t` \[m\], in 1/m; 0 outside the part that is sampled.
    #[must_use]
    pub fn pdf(&self, strategy: Strategy, t: f64) -> f64 {
        self.sampled(strategy).map_or(0.0, |sampled| sampled.pdf(&self.mean, t))
    }

    /// The distance \[m\] whose [`cdf`](Self::cdf) is `u`; the ends for `u` = 0 and 1.
    #[must_use]
    pub fn invert(&self, strategy: Strategy, u: f64) -> f64 {
        self.sampled(strategy).map_or(f64::NAN, |sampled| sampled.invert(u))
    }

    /// The [relative variance](Scene::relative_variance) of each channel, if anything is lit; 0 of a channel that does not
    /// scatter.
    #[must_use]
    pub fn relative_variance(&self, strategy: Strategy) -> Option<Vec<f64>> {
        let density = self.sampled(strategy)?.density;
        let of_channel = |channel: &Scene| {
            if channel.scatters() { channel.relative_variance_by(&density, &self.mean) } else { Some(0.0) }
        };
        self.channels.iter().map(of_channel).collect()
    }

    fn sampled(&self, strategy: Strategy) -> Option<Sampled> {
        let none_scatters = !self.channels.iter().any(Scene::scatters);
        let taking_part = self.channels.iter().filter(|channel| none_scatters || channel.scatters());
        let mu_t: Vec<f64> = taking_part.map(Scene::mu_t).collect();
        Sampled::new(&self.mean, strategy, &mu_t)
    }
}
