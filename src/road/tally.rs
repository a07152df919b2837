//! The counts of a chunk.

use crate::batch::{Counts, Inputs};
use crate::simd::{Isa, Lanes};

/// The counts of a chunk.
#[derive(Clone, Copy)]
pub(super) struct Tally {
    valid: usize,
    sampled: usize,
    bisected: usize,
    /// The lanes that are counted, a bit each.
    lanes: u32,
}

impl Tally {
    pub(super) fn new<I: Isa>(inputs: &Inputs<'_>) -> Self {
        let lanes = inputs.counted(I::V::N).fold(0, |lanes, lane| lanes | 1 << lane);
        Self { valid: 0, sampled: 0, bisected: 0, lanes }
    }

    /// Adds a value for each lane: whether it is `valid`, and if so `sampled`, and if so `bisected`.
    #[cfg_attr(optimized, inline(always))]
    pub(super) fn add<I: Isa>(&mut self, valid: I::Mask, sampled: I::Mask, bisected: I::Mask) {
        // In scalar registers, which kernels use little.
        self.valid += (I::V::bits(valid) & self.lanes).count_ones() as usize;
        self.sampled += (I::V::bits(sampled) & self.lanes).count_ones() as usize;
        self.bisected += (I::V::bits(bisected & sampled) & self.lanes).count_ones() as usize;
    }

    pub(super) fn counts<I: Isa>(self, inputs: &Inputs<'_>) -> Counts {
        let Self { valid, sampled, bisected, .. } = self;
        let values = inputs.len() / I::V::N * inputs.per_ray * inputs.counted(I::V::N).len();
        Counts { sampled, empty: valid - sampled, invalid: values - valid, bisected }
    }
}
