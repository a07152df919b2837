//! The densities and their distributions, in closed form.

use super::number::{Big, abs, big, exp};
use super::polynomial::{Direction, Polynomial, phase_clamp, transmittance_clamp};
use super::product::{COUNTS, Product};
use super::scene::Scene;

/// All strategies on one scene.
pub(crate) struct Densities<'a> {
    scene: &'a Scene,
    start: Direction,
    angular: Vec<Angular>,
    product: Product<'a>,
}

/// A density over theta: `N`, or 1, times a polynomial up to a kink and a constant beyond.
struct Angular {
    cosine: Option<[Big; 2]>,
    inside: Polynomial,
    kink: Option<Kink>,
    total: Big,
}

/// Towards larger `sign theta` the polynomial is what it is at `at`.
struct Kink {
    at: Direction,
    sign: Big,
    beyond: Polynomial,
}

impl<'a> Densities<'a> {
    pub(crate) fn new(scene: &'a Scene, [t_a, t_b]: &[Big; 2]) -> Self {
        let [start, end] = [t_a, t_b].map(|t| Direction::to(&(t - &scene.t_h), &scene.h));
        let cosine = scene.normal.as_ref().map(|[alpha_h, beta]| [alpha_h / &scene.h, beta.clone()]);
        let m = (&scene.mu_t * &scene.h).min(big(32.0));
        let one = || Polynomial::constant(big(1.0));
        let sign = big(if scene.g < big(0.0) { -1.0 } else { 1.0 });
        let mut angular = vec![
            Angular::new(None, one(), None),
            Angular::new(cosine.clone(), one(), None),
            Angular::new(cosine.clone(), Polynomial::transmittance(&m), Some((transmittance_clamp(&m), big(1.0)))),
            Angular::new(cosine, Polynomial::phase(&scene.g), Some((phase_clamp(&abs(scene.g.clone())), sign))),
        ];
        for density in &mut angular {
            density.total = density.mass(&start, &end);
        }
        Self { scene, start, angular, product: Product::new(scene, &[t_a.clone(), t_b.clone()]) }
    }

    /// The pdf and the CDF at `t` of all strategies, in their order.
    pub(crate) fn at(&self, t: &Big) -> Vec<(Big, Big)> {
        let direction = Direction::to(&(t - &self.scene.t_h), &self.scene.h);
        let r = self.scene.r(t);
        let slope = &self.scene.h / (&r * &r); // dtheta/dt
        let over_angle = self.angular.iter().map(|density| {
            let below = density.mass(&self.start, &direction);
            (&slope * density.weight(&direction) / &density.total, below / &density.total)
        });
        let products = COUNTS.map(|count| self.product.at(t, count));
        std::iter::once(self.transmittance(t)).chain(over_angle).chain(products).collect()
    }

    fn transmittance(&self, t: &Big) -> (Big, Big) {
        let Scene { t_min, t_max, mu_t, .. } = self.scene;
        if *mu_t == big(0.0) {
            let length = t_max - t_min;
            return (big(1.0) / &length, (t - t_min) / length);
        }
        let left = |t: &Big| exp(&(-mu_t * (t - t_min)));
        let total = big(1.0) - left(t_max);
        (mu_t * left(t) / &total, (big(1.0) - left(t)) / total)
    }
}

impl Angular {
    fn new(cosine: Option<[Big; 2]>, inside: Polynomial, kink: Option<(Big, Big)>) -> Self {
        let kink = kink.map(|(theta_c, sign)| {
            let at = Direction::new(&sign * theta_c);
            let beyond = Polynomial::constant(inside.at(&at.theta));
            Kink { at, sign, beyond }
        });
        Self { cosine, inside, kink, total: big(0.0) }
    }

    fn polynomial(&self, theta: &Big) -> &Polynomial {
        match &self.kink {
            Some(kink) if &kink.sign * theta > &kink.sign * &kink.at.theta => &kink.beyond,
            _ => &self.inside,
        }
    }

    fn weight(&self, direction: &Direction) -> Big {
        let n = self.cosine.as_ref().map_or(big(1.0), |[alpha, beta]| alpha * &direction.cos + beta * &direction.sin);
        self.polynomial(&direction.theta).at(&direction.theta) * n
    }

    fn mass(&self, from: &Direction, to: &Direction) -> Big {
        let kink = self.kink.as_ref().map(|kink| &kink.at);
        let ends: Vec<_> = [Some(from), kink.filter(|at| from.theta < at.theta && at.theta < to.theta), Some(to)]
            .into_iter()
            .flatten()
            .collect();
        ends.windows(2).fold(big(0.0), |sum, ends| {
            let polynomial = self.polynomial(&((&ends[0].theta + &ends[1].theta) / big(2.0)));
            let [below, above] = [0, 1].map(|i| match &self.cosine {
                Some(cosine) => polynomial.integral_times_cosine_at(cosine, ends[i]),
                None => polynomial.integral_at(&ends[i].theta),
            });
            sum + above - below
        })
    }
}
