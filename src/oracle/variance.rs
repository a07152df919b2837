//! Relative variances of single samples, by quadrature (1.10).

use super::angular::{Angular, Shape, Taylor};
use super::arc::{Angle, Arc};
use super::density::Density;
use super::product::Product;
use super::quadrature::integrate_pieces;
use super::scene::{Scene, phase};
use super::warp::{Variable, Warp};
use crate::Strategy;

/// The relative tolerance of the integrals; their errors are far smaller.
const TOLERANCE: f64 = 1e-8;

/// The relative variance of the one-sample estimator of the [`radiance`](Scene::radiance), for a density of distances:
/// `V = Int f^2/p / (Int f)^2 - 1`, 0 if the density is proportional to the integrand.
///
/// It is `None` if nothing is [lit](Scene::lit), infinite if the density is 0 where the integrand is not, and NaN if either is NaN.
impl Scene {
    /// The relative variance of a strategy.
    #[must_use]
    pub fn relative_variance(&self, strategy: Strategy) -> Option<f64> {
        self.relative_variance_by(&self.sampled(strategy)?.density, self)
    }

    /// The relative variance with the density of another scene, which differs only in its medium.
    pub(super) fn relative_variance_by(&self, density: &Density, of: &Self) -> Option<f64> {
        let over_angle = |place: &Place| match density {
            // dt/dtheta = r^2/h
            Density::Distance(exponential) => exponential.pdf(place.t) * self.h / place.cos_theta.powi(2),
            Density::Angle(angular) => angular.pdf_at(place.angle),
            Density::HalfAngle(product) => product.pdf_at(place.at),
        };
        self.variance_of(over_angle, &density.kinks(), of)
    }

    /// The relative variance of the best sampler of the paper, for reference: the density of [`Strategy::TaylorPhase`] with variates
    /// that are sampled from a quadratic Bezier curve in place of the transmittance.
    ///
    /// The control values of the curve are the transmittances at the distances of the variates 0, 1/2 and 1.
    #[must_use]
    pub fn relative_variance_of_paper_best(&self) -> Option<f64> {
        let arc = self.arc?;
        let phase = Angular::new(arc, Shape::Taylor(Taylor::phase(self.g)));
        let transmittance = |t: f64| (-self.mu_t * (t - arc.t_a + self.r(t) - self.r(arc.t_a))).exp();
        let [c0, c1, c2] = [arc.t_a, phase.draw(0.5), arc.t_b].map(transmittance);
        let bezier = |u: f64| (1.0 - u).powi(2) * c0 + 2.0 * u * (1.0 - u) * c1 + u * u * c2;
        let over_angle =
            |place: &Place| phase.pdf_at(place.angle) * bezier(phase.cdf_at(place.angle)) * 3.0 / (c0 + c1 + c2);
        self.variance_of(over_angle, phase.kink().as_slice(), self)
    }

    /// The relative variance of a density over `theta` \[1/rad\] with kinks at some distances \[m\].
    ///
    /// The quadrature runs over the variable of the product densities of the scene `of` the density, in which the integrand has no
    /// narrow features.
    fn variance_of(&self, density: impl Fn(&Place) -> f64, kinks: &[f64], of: &Self) -> Option<f64> {
        let arc = self.arc?;
        let product = Product::new(of, arc, 17);
        let warp = product.warp();
        let integrand = |place: &Place| {
            // relative to the start of the lit part
            let transmittance = (-self.mu_t * warp.y(place.at)).exp();
            transmittance * phase(self.g, &arc, place.angle) * arc.cosine(place.angle) * arc.falloff(place.angle)
        };
        let of_falloff = arc.kinks().into_iter().map(|kink| arc.t(kink));
        let kinks = kinks.iter().copied().chain(of_falloff).map(|t| warp.at(t).v);
        let mut ends: Vec<f64> = product.knots().chain(kinks).collect();
        ends.extend([1e-6, 1e-4, 1e-2].into_iter().flat_map(|v| [v, 1.0 - v]));
        ends.sort_by(f64::total_cmp);
        let integral = |of: &dyn Fn(&Place) -> f64| {
            let over_v = |v: f64| {
                let place = Place::new(warp, &arc, v);
                of(&place) * place.slope
            };
            integrate_pieces(over_v, &ends, TOLERANCE)
        };
        let first = integral(&integrand);
        let second = integral(&|place| {
            let f = integrand(place);
            if f == 0.0 { 0.0 } else { f / first * (f / first / density(place)) }
        });
        Some(second - 1.0)
    }
}

/// A node of the quadrature.
struct Place {
    at: Variable,
    angle: Angle,
    cos_theta: f64,
    t: f64,
    /// `dtheta/dv`.
    slope: f64,
}

impl Place {
    fn new(warp: &Warp, arc: &Arc, v: f64) -> Self {
        let at = Variable::new(v);
        let angle = warp.angle(at);
        Self { at, angle, cos_theta: arc.cos_theta(angle), t: warp.t(at), slope: warp.slope(at) }
    }
}

#[cfg(test)]
mod tests {
    use super::super::arbitrary::{config, scene};
    use super::*;
    use proptest::{prop_assert, proptest};

    proptest! {
        #![proptest_config(config(64))]

        /// Over the strategy's own variate, on which the density is 1: `f/p = w`, `V = Int w^2 / (Int w)^2 - 1`.
        #[test]
        fn it_is_the_variance_over_the_variate(scene in scene()) {
            for &strategy in Strategy::ALL {
                let Some(variance) = scene.relative_variance(strategy) else { continue };
                // of a heavy tail this variable does not see the peak, nor any digit of next to nothing
                if !(1e-3..1.0).contains(&variance) || scene.radiance() == 0.0 {
                    continue;
                }
                let weight = |u: f64| {
                    let t = scene.draw(strategy, u);
                    let (f, p) = (scene.integrand(t), scene.pdf(strategy, t));
                    if f > 0.0 { f / p } else { 0.0 }
                };
                // the tails, and the kinks at the knots
                let tails = (0..12).map(|k| 10f64.powi(-k));
                let mut ends: Vec<f64> = tails.flat_map(|u| [u, 1.0 - u]).collect();
                ends.extend(scene.sampled(strategy).unwrap().density.kinks().into_iter().map(|t| scene.cdf(strategy, t)));
                ends.sort_by(f64::total_cmp);
                let over_u = |ends: &[f64]| {
                    let first = integrate_pieces(weight, ends, 1e-7);
                    integrate_pieces(|u| (weight(u) / first).powi(2), ends, 1e-7) - 1.0
                };
                // over u a narrow peak may be missed: until another halving of all pieces changes nothing
                let mut coarse = over_u(&ends);
                let converged = (0..4).find_map(|_| {
                    let middles: Vec<f64> = ends.windows(2).map(|piece| 0.5 * (piece[0] + piece[1])).collect();
                    ends.extend(middles);
                    ends.sort_by(f64::total_cmp);
                    let fine = over_u(&ends);
                    let change = (fine - std::mem::replace(&mut coarse, fine)).abs();
                    (change < 1e-4 * variance).then_some(fine)
                });
                let Some(over_u) = converged else { continue };
                prop_assert!((over_u - variance).abs() < 1e-3 * variance, "{strategy}: {variance} is not {over_u}");
            }
        }

        /// The penumbra of a spot may be narrow, and lie between two knots.
        #[test]
        fn more_knots_leave_less(scene in scene()) {
            if let Some(of_five) = scene.relative_variance(Strategy::Product5) {
                let of_seventeen = scene.relative_variance(Strategy::Product17).unwrap();
                let most = if scene.is_spot() { 0.05 } else { 0.005 };
                prop_assert!(of_seventeen < most && of_five < 0.5, "{of_five} and {of_seventeen}");
            }
        }
    }
}
