//! The outcomes of the rays of a batch.

/// The outcomes of the rays of a batch: `sampled + empty + invalid` is its length. If a call has several variates or
/// distances per ray, each of them counts.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[non_exhaustive]
pub struct Counts {
    /// Rays with a sample. A medium that does not scatter gives it the weight 0.
    pub sampled: usize,
    /// Valid rays without a sample: `t_min = t_max`, no point of the ray is lit, or the lit part is less than f32 can resolve:
    ///
    /// - the lit interval is shorter than 1e-18 m;
    /// - for all densities but the transmittance, it is shorter than about 1e-36 of `r^2`, or subtends less than about 1e-30 rad;
    /// - for densities that follow the cosine, it has less than about 1e-25 of the light of an emitter faced squarely;
    /// - possibly, the ray meets the emitter's plane at an angle below 1e-30 rad.
    pub empty: usize,
    /// Rays with a value that is NaN or out of range.
    pub invalid: usize,
    /// Sampled rays whose iteration bisected at least once, or took more than 8 steps.
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
