//! Densities over the angle at the emitter: sections 3.2, 3.3 and 4 of `docs/mathematics.md`.

use super::arc::{Angle, Arc};
use super::paper::{
    Polynomial, geometric, horner, phase_clamp, phase_taylor, transmittance_clamp, transmittance_taylor,
};
use super::quadrature::gauss_legendre;

/// The largest `m = mu_t h` of the polynomial of the transmittance; a denser medium has the polynomial of this `m`.
///
/// Little is lost: the published code trusts the polynomial up to less than 0.01 rad there. This is part of the definition of
/// the density.
const LARGEST_M: f64 = 32.0;

/// A density over the directions of an arc, up to a constant factor.
#[derive(Clone, Copy, Debug)]
pub(super) enum Shape {
    /// 1
    Uniform,
    /// `N`
    Cosine,
    /// `N` times a polynomial
    Taylor(Taylor),
}

/// A Taylor polynomial in `sign theta`; beyond `theta_c` it keeps its value there.
#[derive(Clone, Copy, Debug)]
pub(super) struct Taylor {
    polynomial: Polynomial,
    sign: f64,
    theta_c: f64,
}

impl Taylor {
    /// (4.1), (4.2): (4)-(10) divided by `Q_T0`, up to the published clamp, for `m = mu_t h`.
    pub(super) fn transmittance(m: f64) -> Self {
        let m = m.min(LARGEST_M);
        Self { polynomial: transmittance_taylor(&geometric(1.0, m)), sign: 1.0, theta_c: transmittance_clamp(m) }
    }

    /// (4.3), (4.4): (13)-(19) for `|g|` divided by `v_0`, up to the published clamp, mirrored for `g < 0`.
    ///
    /// `v_0` is 0 at `|g|` = 1; without it the polynomial gives a density for every `g`.
    pub(super) fn phase(g: f64) -> Self {
        let (sign, g) = (if g < 0.0 { -1.0 } else { 1.0 }, g.abs());
        Self { polynomial: phase_taylor(&geometric(1.0, g / (1.0 + g * g))), sign, theta_c: phase_clamp(g) }
    }

    fn at(&self, theta: f64) -> f64 {
        horner(&self.polynomial, (self.sign * theta).min(self.theta_c))
    }

    /// The `theta` between the polynomial and the constant.
    fn kink(&self) -> f64 {
        self.sign * self.theta_c
    }
}

/// A density over the angle at the emitter, on one arc.
#[derive(Clone, Copy, Debug)]
pub(super) struct Angular {
    arc: Arc,
    shape: Shape,
    total: f64,
}

impl Angular {
    pub(super) fn new(arc: Arc, shape: Shape) -> Self {
        let mut angular = Self { arc, shape, total: 1.0 };
        angular.total = angular.mass(arc.start(), arc.end());
        angular
    }

    pub(super) fn cdf(&self, t: f64) -> f64 {
        self.cdf_at(self.arc.at(t))
    }

    /// The CDF of a direction.
    pub(super) fn cdf_at(&self, angle: Angle) -> f64 {
        let below = self.mass(self.arc.start(), angle);
        let above = self.mass(angle, self.arc.end());
        below / (below + above)
    }

    /// The pdf over `theta` \[1/rad\].
    pub(super) fn pdf(&self, t: f64) -> f64 {
        self.pdf_at(self.arc.at(t))
    }

    /// The pdf in a direction.
    pub(super) fn pdf_at(&self, angle: Angle) -> f64 {
        self.weight(angle) / self.total
    }

    /// The distance \[m\] between polynomial and constant, if it lies between the ends of the arc.
    pub(super) fn kink(&self) -> Option<f64> {
        let Shape::Taylor(taylor) = &self.shape else { return None };
        let kink = self.kink_of(taylor);
        (0.0 < kink.from_a && 0.0 < kink.to_b).then(|| self.arc.t(kink))
    }

    /// The inverse: Newton's method, with bisection where a step would leave the bracket of the root.
    pub(super) fn draw(&self, u: f64) -> f64 {
        let start = self.arc.start();
        let target = u * self.total;
        let (mut low, mut high) = (0.0, self.arc.width());
        let mut delta = u * high;
        for _ in 0..100 {
            let angle = self.arc.after(delta);
            let excess = self.mass(start, angle) - target;
            if excess > 0.0 {
                high = delta;
            } else {
                low = delta;
            }
            let newton = delta - excess / self.weight(angle);
            let next = if low < newton && newton < high { newton } else { 0.5 * (low + high) };
            if (next - delta).abs() <= f64::EPSILON * delta {
                break;
            }
            delta = next;
        }
        self.arc.t(self.arc.after(delta))
    }

    fn weight(&self, angle: Angle) -> f64 {
        match &self.shape {
            Shape::Uniform => 1.0,
            Shape::Cosine => self.arc.cosine(angle),
            Shape::Taylor(taylor) => self.arc.cosine(angle) * taylor.at(self.arc.theta(angle)),
        }
    }

    /// The integral of the weight over the directions from `lower` to `upper`.
    fn mass(&self, lower: Angle, upper: Angle) -> f64 {
        match &self.shape {
            Shape::Uniform => Angle::between(lower, upper),
            Shape::Cosine => self.arc.integral_of_cosine(lower, upper),
            Shape::Taylor(taylor) => {
                let kink = self.kink_of(taylor);
                if lower.from_a < kink.from_a && kink.from_a < upper.from_a {
                    self.mass_of_piece(lower, kink) + self.mass_of_piece(kink, upper)
                } else {
                    self.mass_of_piece(lower, upper)
                }
            }
        }
    }

    fn kink_of(&self, taylor: &Taylor) -> Angle {
        self.arc.after(taylor.kink() - self.arc.theta(self.arc.start()))
    }

    /// The mass of a piece where the weight is smooth, by quadrature, as (22) cancels on narrow arcs. 16 nodes have all digits of a
    /// polynomial of order 6 times `N` on an arc of at most pi.
    fn mass_of_piece(&self, lower: Angle, upper: Angle) -> f64 {
        Angle::between(lower, upper) * gauss_legendre(|s| self.weight(Angle::lerp(lower, upper, s)), 0.0, 1.0)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::f64::consts::FRAC_PI_2;

    /// The smallest value of the polynomial over theta, relative to the value at 0.
    fn smallest(taylor: &Taylor) -> f64 {
        let theta = |i: i32| FRAC_PI_2 * f64::from(i) / 1000.0;
        (-1000..=1000)
            .map(theta)
            .chain([taylor.kink().clamp(-FRAC_PI_2, FRAC_PI_2)])
            .map(|theta| taylor.at(theta))
            .fold(f64::INFINITY, f64::min)
    }

    #[test]
    fn the_polynomial_of_the_transmittance_is_positive_up_to_its_clamp() {
        let (m, least) = (0..=6400)
            .map(|i| f64::from(i) / 200.0)
            .map(|m| (m, smallest(&Taylor::transmittance(m))))
            .min_by(|x, y| x.1.total_cmp(&y.1))
            .unwrap();
        assert!(least > 0.013, "{least} at m = {m}");
    }

    #[test]
    fn the_polynomial_of_the_phase_function_is_positive_up_to_its_clamp() {
        for g in (-1000..=1000).map(|i| f64::from(i) / 1000.0) {
            let least = smallest(&Taylor::phase(g));
            assert!(least > 0.01, "{least} at g = {g}");
        }
    }

    #[test]
    fn unclamped_that_of_the_transmittance_would_not_be_positive() {
        let unclamped = Taylor { theta_c: FRAC_PI_2, ..Taylor::transmittance(0.5) };
        assert!(smallest(&unclamped) < 0.0);
    }

    #[test]
    fn the_phase_function_of_minus_g_is_mirrored() {
        let (forward, backward) = (Taylor::phase(0.6), Taylor::phase(-0.6));
        for theta in [-1.5, -0.3, 0.0, 0.9, 1.5] {
            assert_eq!(forward.at(theta), backward.at(-theta));
        }
    }

    #[test]
    fn thick_media_share_one_polynomial() {
        assert_eq!(Taylor::transmittance(1e30).at(-1.0), Taylor::transmittance(LARGEST_M).at(-1.0));
    }

    /// To first order in its width, any density on a narrow arc is linear and its distribution that of a trapezoid.
    #[test]
    fn narrow_arcs_keep_all_digits() {
        for (t_h, m, g) in [(-3.0, 0.1, 0.8), (0.3, 2.0, -0.5), (1.0, 40.0, 0.0), (2000.0, 0.0, 0.9)] {
            let arc = Arc::new(1.0, t_h, (0.0, 1e-9 * (1.0 + t_h * t_h)), None).unwrap();
            for taylor in [Taylor::transmittance(m), Taylor::phase(g)] {
                let angular = Angular::new(arc, Shape::Taylor(taylor));
                for u in [2f64.powi(-24), 0.1, 0.5, 0.9] {
                    let t = angular.draw(u);
                    let angle = arc.at(t);
                    let (a, at, b) = (angular.weight(arc.start()), angular.weight(angle), angular.weight(arc.end()));
                    let expected = angle.from_a * (a + at) / (arc.width() * (a + b));
                    for (of, value) in [("cdf", angular.cdf(t)), ("u", u)] {
                        assert!((value - expected).abs() <= 1e-13 * u, "{of} {value} is not {expected}, t_h = {t_h}");
                    }
                }
            }
        }
    }
}
