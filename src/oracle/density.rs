//! The density of each strategy, its distribution, and the inverse.
//!
//! | strategy | proportional to | over | on |
//! |---|---|---|---|
//! | `Transmittance` | `exp(-mu_t t)` | `t` | `[t_min, t_max]` |
//! | `EquiAngular` | 1 | `theta` | the lit part |
//! | `PointNormal` | `N` | `theta` | the lit part |
//! | `TaylorTransmittance` | `N P(min(theta, theta_c))`, `P` the polynomial (4)-(10) for `mu_t h` up to 32 | `theta` | the lit part |
//! | `TaylorPhase` | `N P(min(s theta, theta_c))`, `P` the polynomial (13)-(19) for `abs(g)`, `s` the sign of `g` | `theta` | the lit part |
//! | `Product3` to `Product17` | `T rho N S dtheta/dv` at the knots, linear between them, `rho` for `abs(g)` up to the f32 next below 1 | `v` of the half angle | the lit part |

use super::angular::{Angular, Shape, Taylor};
use super::distance::Exponential;
use super::product::Product;
use super::scene::Scene;
use crate::Strategy;

/// A density, by its variable.
pub(super) enum Density {
    Distance(Exponential),
    Angle(Angular),
    HalfAngle(Product),
}

impl Density {
    /// The distances between its ends where it is not smooth \[m\].
    pub(super) fn kinks(&self) -> Vec<f64> {
        match self {
            Self::Distance(_) => vec![],
            Self::Angle(angular) => angular.kink().into_iter().collect(),
            Self::HalfAngle(product) => product.kinks(),
        }
    }
}

/// A density on its interval, from `t_a` to `t_b` \[m\].
pub(super) struct Sampled {
    pub(super) density: Density,
    t_a: f64,
    t_b: f64,
}

impl Sampled {
    /// The density of a strategy; the product densities are mixtures for several values of `mu_t` \[1/m\].
    pub(super) fn new(scene: &Scene, strategy: Strategy, mu_t: &[f64]) -> Option<Self> {
        let arc = scene.arc?;
        let over_angle = |shape| Density::Angle(Angular::new(arc, shape));
        let product = |knots| Density::HalfAngle(Product::mixture(scene, mu_t, arc, knots));
        let density = match strategy {
            Strategy::Transmittance => {
                let density = Density::Distance(Exponential::new(scene.mu_t, scene.interval()));
                return Some(Self { density, t_a: scene.t_min, t_b: scene.t_max });
            }
            Strategy::EquiAngular => over_angle(Shape::Uniform),
            Strategy::PointNormal => over_angle(Shape::Cosine),
            Strategy::TaylorTransmittance => over_angle(Shape::Taylor(Taylor::transmittance(scene.mu_t * scene.h))),
            Strategy::TaylorPhase => over_angle(Shape::Taylor(Taylor::phase(scene.g))),
            Strategy::Product3 => product(3),
            Strategy::Product5 => product(5),
            Strategy::Product9 => product(9),
            Strategy::Product17 => product(17),
        };
        Some(Self { density, t_a: arc.t_a, t_b: arc.t_b })
    }

    pub(super) fn cdf(&self, t: f64) -> f64 {
        if t <= self.t_a {
            return 0.0;
        }
        if t >= self.t_b {
            return 1.0;
        }
        match &self.density {
            Density::Distance(exponential) => exponential.cdf(t),
            Density::Angle(angular) => angular.cdf(t),
            Density::HalfAngle(product) => product.cdf(t),
        }
    }

    /// The pdf over distance, in the scene of the density.
    pub(super) fn pdf(&self, scene: &Scene, t: f64) -> f64 {
        if !(self.t_a..=self.t_b).contains(&t) {
            return 0.0;
        }
        match &self.density {
            Density::Distance(exponential) => exponential.pdf(t),
            // dtheta/dt = h/r^2
            Density::Angle(angular) => angular.pdf(t) * scene.h / scene.r(t).powi(2),
            Density::HalfAngle(product) => product.pdf(t) * scene.h / scene.r(t).powi(2),
        }
    }

    pub(super) fn draw(&self, u: f64) -> f64 {
        if u <= 0.0 {
            return self.t_a;
        }
        if u >= 1.0 {
            return self.t_b;
        }
        match &self.density {
            Density::Distance(exponential) => exponential.draw(u),
            Density::Angle(angular) => angular.draw(u),
            Density::HalfAngle(product) => product.draw(u),
        }
    }
}

/// The density of a strategy over distance. A scene without a [lit](Scene::lit) part has none: its pdf is 0, its cdf and its
/// inverse are NaN.
impl Scene {
    /// The probability of a distance of at most `t` \[m\].
    #[must_use]
    pub fn cdf(&self, strategy: Strategy, t: f64) -> f64 {
        self.sampled(strategy).map_or(f64::NAN, |sampled| sampled.cdf(t))
    }

    /// The probability density at `t` \[m\], in 1/m; 0 outside the sampled interval.
    #[must_use]
    pub fn pdf(&self, strategy: Strategy, t: f64) -> f64 {
        self.sampled(strategy).map_or(0.0, |sampled| sampled.pdf(self, t))
    }

    /// The distance \[m\] whose [`cdf`](Self::cdf) is `u`; the ends for `u` = 0 and 1.
    #[must_use]
    pub fn draw(&self, strategy: Strategy, u: f64) -> f64 {
        self.sampled(strategy).map_or(f64::NAN, |sampled| sampled.draw(u))
    }

    pub(super) fn sampled(&self, strategy: Strategy) -> Option<Sampled> {
        Sampled::new(self, strategy, &[self.mu_t])
    }
}

#[cfg(test)]
mod tests {
    use super::super::arbitrary::{config, scene, uniform};
    use super::super::quadrature::integrate_pieces;
    use super::*;
    use proptest::{prop_assert, proptest};

    /// The error of a cdf that the rounding of `t` alone makes.
    fn of_rounding(scene: &Scene, strategy: Strategy, t: f64) -> f64 {
        4.0 * f64::EPSILON * t.abs().max((t - scene.t_h).abs()) * scene.pdf(strategy, t)
    }

    proptest! {
        #![proptest_config(config(512))]

        #[test]
        fn the_inverse_inverts(scene in scene(), u in uniform()) {
            for &strategy in Strategy::ALL {
                let Some((t_a, t_b)) = scene.lit() else { continue };
                for u in [u, 1.0 - u] {
                    let t = scene.draw(strategy, u);
                    let (first, last) = if strategy == Strategy::Transmittance { scene.interval() } else { (t_a, t_b) };
                    prop_assert!((first..=last).contains(&t), "{strategy}: {t}");
                    let error = (scene.cdf(strategy, t) - u).abs();
                    prop_assert!(error <= 1e-12 + of_rounding(&scene, strategy, t), "{strategy}: {error:e} at u = {u}");
                }
            }
        }

        #[test]
        fn outside_there_is_nothing(scene in scene()) {
            for &strategy in Strategy::ALL {
                let Some(lit) = scene.lit() else {
                    prop_assert!(scene.pdf(strategy, scene.t_min) == 0.0 && scene.draw(strategy, 0.5).is_nan());
                    continue;
                };
                let (first, last) = if strategy == Strategy::Transmittance { scene.interval() } else { lit };
                for (t, cdf) in [(first.next_down(), 0.0), (last.next_up(), 1.0)] {
                    prop_assert!(scene.pdf(strategy, t) == 0.0, "{strategy} at {t}");
                    prop_assert!(scene.cdf(strategy, t) == cdf, "{strategy} at {t}");
                }
                prop_assert!(scene.draw(strategy, 0.0) == first && scene.draw(strategy, 1.0) == last);
            }
        }

        #[test]
        fn the_density_is_the_slope_of_its_distribution(scene in scene(), u in [0f64..=1.0, 0f64..=1.0]) {
            for &strategy in Strategy::ALL {
                if scene.lit().is_none() {
                    continue;
                }
                let (t0, t1) = (scene.draw(strategy, u[0].min(u[1])), scene.draw(strategy, u[0].max(u[1])));
                let mut ends = vec![t0, 0.5 * (t0 + t1), t1];
                // A kink within a sixteenth of the end of an interval escapes the quadrature.
                let kinks = scene.sampled(strategy).unwrap().density.kinks();
                ends.extend(kinks.into_iter().filter(|t| (t0..t1).contains(t)));
                ends.sort_by(f64::total_cmp);
                let mass = integrate_pieces(|t| scene.pdf(strategy, t), &ends, 1e-13);
                let expected = scene.cdf(strategy, t1) - scene.cdf(strategy, t0);
                let rounding = of_rounding(&scene, strategy, t0) + of_rounding(&scene, strategy, t1);
                prop_assert!((mass - expected).abs() <= 1e-10 + rounding, "{strategy}: {mass} is not {expected}");
            }
        }
    }
}
