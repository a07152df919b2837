//! What became of the rays of a batch.

/// What became of the rays of a batch: `sampled + empty + invalid` is its length. Where a call has several variates or
/// distances for each ray, every one of them counts.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[non_exhaustive]
pub struct Counts {
    /// Rays with a sample, also where a medium that does not scatter gives it the weight 0.
    pub sampled: usize,
    /// Valid rays without one: `t_min = t_max`, or no point of the ray is lit, or less than f32 can say anything about: an
    /// interval shorter than 1e-18 m; for all densities but the transmittance also one shorter than about 1e-36 of `r^2`,
    /// or that subtends about 1e-30 rad; for those with the cosine 1e-25 of the light; or, it may be, a ray that meets the
    /// emitter's plane at an angle below 1e-30 rad.
    pub empty: usize,
    /// Rays with a value that is NaN or out of range.
    pub invalid: usize,
    /// Sampled rays whose iteration fell back to bisection at least once, or took more than 8 steps.
    pub bisected: usize,
}

impl std::ops::Add for Counts {
    type Output = Self;
    fn add(self, o: Self) -> Self {
        Self {
            sampled: self.sampled + o.sampled,
            empty: self.empty + o.empty,
            invalid: self.invalid + o.invalid,
            bisected: self.bisected + o.bisected,
        }
    }
}
