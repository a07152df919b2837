//! The density over distance proportional to the transmittance along the ray: section 3.1 of `docs/mathematics.md`.

/// The density proportional to `exp(-mu_t t)` on `[t_min, t_max]`, all in metres.
#[derive(Clone, Copy, Debug)]
pub(super) struct Exponential {
    t_min: f64,
    t_max: f64,
    mu_t: f64,
}

impl Exponential {
    pub(super) fn new(mu_t: f64, (t_min, t_max): (f64, f64)) -> Self {
        Self { t_min, t_max, mu_t }
    }

    pub(super) fn cdf(&self, t: f64) -> f64 {
        self.absorbed(t) / self.absorbed(self.t_max)
    }

    pub(super) fn pdf(&self, t: f64) -> f64 {
        (-self.mu_t * (t - self.t_min)).exp() / self.absorbed(self.t_max)
    }

    pub(super) fn draw(&self, u: f64) -> f64 {
        let absorbed = u * self.absorbed(self.t_max);
        let length = if self.is_uniform() { absorbed } else { -(-self.mu_t * absorbed).ln_1p() / self.mu_t };
        (self.t_min + length).min(self.t_max)
    }

    /// The integral of `exp(-mu_t (t - t_min))` up to `t` \[m\].
    fn absorbed(&self, t: f64) -> f64 {
        let length = t - self.t_min;
        if self.is_uniform() { length } else { -(-self.mu_t * length).exp_m1() / self.mu_t }
    }

    fn is_uniform(&self) -> bool {
        self.mu_t == 0.0
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn no_extinction_is_the_limit_of_little() {
        let (none, little) = (Exponential::new(0.0, (2.0, 5.0)), Exponential::new(1e-14, (2.0, 5.0)));
        for u in [0.1, 0.5, 0.9] {
            let t = 2.0 + 3.0 * u;
            for value in [none.cdf(t), little.cdf(t)] {
                assert!((value - u).abs() < 1e-13, "{value}");
            }
            assert!((little.draw(u) - none.draw(u)).abs() < 1e-13);
            assert!((little.pdf(t) - 1.0 / 3.0).abs() < 1e-13 && none.pdf(t) == 1.0 / 3.0);
        }
    }

    #[test]
    fn by_hand() {
        let half_life = std::f64::consts::LN_2;
        let density = Exponential::new(1.0, (1.0, 1e18));
        assert!((density.draw(0.75) - (1.0 + 2.0 * half_life)).abs() < 1e-15);
        assert!((density.cdf(1.0 + half_life) - 0.5).abs() < 1e-15);
        assert!((density.pdf(1.0 + half_life) - 0.5).abs() < 1e-15);
    }

    #[test]
    fn no_distance_is_beyond_the_end() {
        for mu_t in (0..2000).map(|i| f64::from(i) * 1e-3) {
            let t = Exponential::new(mu_t, (0.1, 1.7)).draw(1.0 - f64::EPSILON / 2.0);
            assert!(t <= 1.7, "{t} at mu_t = {mu_t}");
        }
    }
}
