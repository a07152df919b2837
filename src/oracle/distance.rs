//! The density over distance proportional to the transmittance along the ray.

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

    pub(super) fn invert(&self, u: f64) -> f64 {
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
