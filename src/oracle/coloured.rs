//! One ray, one emitter and a medium of several channels: the light of each, and the one density for all of them.

use super::density::Sampled;
use super::scene::Scene;
use crate::Strategy;
use crate::scene::{Emitter, Medium, Ray};

/// One ray, one emitter and a medium of one or several channels in f64.
///
/// All channels share the distances. A product density with 5 or 9 knots is the mixture, in equal parts, of those of the channels that
/// scatter, all at the knots of the [mean](Self::mean)'s: proportional to the sum of `f_c/F_c`, with `f_c` the line through what
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
    pub fn draw(&self, strategy: Strategy, u: f64) -> f64 {
        self.sampled(strategy).map_or(f64::NAN, |sampled| sampled.draw(u))
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
        let mixture: Vec<f64> = taking_part.map(Scene::mu_t).collect();
        let mean = [self.mean.mu_t()];
        let mixes = matches!(strategy, Strategy::Product5 | Strategy::Product9);
        Sampled::new(&self.mean, strategy, if mixes { &mixture } else { &mean })
    }
}

#[cfg(test)]
mod tests {
    use super::super::arbitrary::{config, scene, uniform};
    use super::super::product::Product;
    use super::super::quadrature::integrate_pieces;
    use super::*;
    use proptest::{prop_assert, proptest};

    /// The ratios of three channels' `mu_t` to one of them, and which of them scatter.
    fn colour() -> impl proptest::strategy::Strategy<Value = [(f64, bool); 3]> {
        use proptest::strategy::Strategy as _;
        let channel = || ((-1f64..1.0).prop_map(|x| 10f64.powf(x)), proptest::bool::weighted(0.8));
        [channel(), channel(), channel()]
    }

    fn coloured(scene: &Scene, colour: [(f64, bool); 3]) -> Coloured {
        let channels = colour.map(|(ratio, scatters)| {
            let mu_t = (ratio * scene.mu_t()) as f32;
            Medium::new(if scatters { 0.0 } else { mu_t }, if scatters { mu_t } else { 0.0 }, scene.g as f32).unwrap()
        });
        let [mu_a, mu_s] = [Medium::mu_a, Medium::mu_s].map(|of| channels.each_ref().map(of));
        let medium = Medium::coloured(mu_a, mu_s, scene.g as f32).unwrap();
        Coloured {
            mean: scene.with_medium(&medium.mean()),
            channels: channels.map(|channel| scene.with_medium(&channel)).to_vec(),
        }
    }

    proptest! {
        #![proptest_config(config(256))]

        #[test]
        fn a_product_density_is_the_mean_of_those_of_the_channels(scene in scene(), colour in colour(), u in uniform()) {
            let coloured = coloured(&scene, colour);
            let Some(arc) = coloured.mean.arc else { return Ok(()) };
            let t = coloured.draw(Strategy::Product5, u);
            let of_channel = |channel: &Scene| Product::mixture(&coloured.mean, &[channel.mu_t], arc, 5).cdf(t);
            let none_scatters = colour.iter().all(|&(_, scatters)| !scatters);
            let taking_part = coloured.channels.iter().filter(|channel| none_scatters || channel.scatters());
            let cdfs: Vec<f64> = taking_part.map(of_channel).collect();
            let mean = cdfs.iter().sum::<f64>() / cdfs.len() as f64;
            let cdf = coloured.cdf(Strategy::Product5, t);
            prop_assert!(u == 0.0 || u == 1.0 || (cdf - mean).abs() <= 1e-12, "{cdf} is not the mean of {cdfs:?}");
        }

        #[test]
        fn the_inverse_inverts_and_the_density_is_the_slope(scene in scene(), colour in colour(), u in uniform()) {
            let coloured = coloured(&scene, colour);
            if scene.lit().is_none() {
                return Ok(());
            }
            for &strategy in Strategy::ALL {
                let (t0, t1) = (coloured.draw(strategy, 0.5 * u), coloured.draw(strategy, u));
                let rounding = 4.0 * f64::EPSILON * t1.max((t1 - scene.t_h).abs()) * coloured.pdf(strategy, t1)
                    + 4.0 * f64::EPSILON * t0.max((t0 - scene.t_h).abs()) * coloured.pdf(strategy, t0);
                let error = (coloured.cdf(strategy, t1) - u).abs();
                prop_assert!(error <= 1e-12 + rounding, "{strategy}: {error:e} at u = {u}");
                let mut ends = coloured.sampled(strategy).unwrap().density.kinks();
                ends.retain(|t| (t0..t1).contains(t));
                ends.extend([t0, 0.5 * (t0 + t1), t1]);
                ends.sort_by(f64::total_cmp);
                let mass = integrate_pieces(|t| coloured.pdf(strategy, t), &ends, 1e-13);
                prop_assert!((mass - 0.5 * u).abs() <= 1e-10 + rounding, "{strategy}: {mass} is not {}", 0.5 * u);
            }
        }
    }
}
