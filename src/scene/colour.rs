//! The coefficients of a medium that differ from channel to channel.

/// The most channels that a medium has.
pub(crate) const MOST_CHANNELS: usize = 4;

/// `mu_a` and `mu_s` \[1/m\] of several channels.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Colour {
    /// Those beyond `count` are 0.
    mu_a: [f32; MOST_CHANNELS],
    mu_s: [f32; MOST_CHANNELS],
    count: usize,
}

impl Colour {
    /// That of as many channels as both slices have, at most 4.
    pub(crate) fn new(mu_a: &[f32], mu_s: &[f32]) -> Self {
        let padded = |values: &[f32]| std::array::from_fn(|c| values.get(c).copied().unwrap_or(0.0));
        Self { mu_a: padded(mu_a), mu_s: padded(mu_s), count: mu_a.len() }
    }

    /// How many channels it has.
    pub(super) fn count(&self) -> usize {
        self.count
    }

    /// `mu_a` and `mu_s` of all.
    pub(super) fn coefficients(&self) -> ([f32; MOST_CHANNELS], [f32; MOST_CHANNELS]) {
        (self.mu_a, self.mu_s)
    }

    /// `mu_a` and `mu_s` of one of them.
    pub(super) fn channel(&self, c: usize) -> Option<(f32, f32)> {
        (c < self.count).then(|| (self.mu_a[c], self.mu_s[c]))
    }

    /// The means of `mu_a` and `mu_s` over the channels that scatter, or over all if none does.
    pub(crate) fn mean(&self) -> (f32, f32) {
        let none_scatters = self.mu_s.iter().all(|&mu_s| mu_s == 0.0);
        let chosen = || (0..self.count).filter(|&c| none_scatters || self.mu_s[c] > 0.0);
        let mean = |values: &[f32]| {
            let sum: f64 = chosen().map(|c| f64::from(values[c])).sum();
            (sum / chosen().count() as f64) as f32
        };
        (mean(&self.mu_a), mean(&self.mu_s))
    }
}
