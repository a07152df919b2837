//! Random numbers of a pass: each belongs to a pixel and a decision, whoever draws it when.

use crate::variates;
use rayon::prelude::*;

/// Numbers that a thread draws at a time.
const CHUNK: usize = 4096;

/// What a number decides.
#[derive(Clone, Copy, Debug)]
pub enum Dimension {
    /// Where in its pixel a ray goes, across.
    X,
    /// And down.
    Y,
    /// The light that a surface is lit by.
    SurfaceEmitter,
    /// The light that the medium is lit by.
    Emitter,
    /// The distance.
    Distance,
    /// The second distance of multiple importance sampling.
    SecondDistance,
}

impl Dimension {
    const COUNT: u64 = 6;

    /// That of distance number `density`.
    #[must_use]
    pub fn distance(density: usize) -> Self {
        if density == 0 { Self::Distance } else { Self::SecondDistance }
    }
}

/// The random numbers of one pass.
#[derive(Clone, Copy, Debug)]
pub struct Variates {
    /// Which stream.
    pub seed: u64,
    /// The number of the pass.
    pub pass: u64,
    /// Pixels of the picture.
    pub pixels: usize,
}

impl Variates {
    /// Fills `u` with the numbers of `count` pixels from `first` on, in `[0, 1)`.
    pub fn fill(&self, dimension: Dimension, first: usize, count: usize, u: &mut Vec<f32>) {
        let start = (self.pass * Dimension::COUNT + dimension as u64) * self.pixels as u64 + first as u64;
        u.resize(count, 0.0);
        u.par_chunks_mut(CHUNK)
            .enumerate()
            .for_each(|(i, chunk)| variates::fill(self.seed, start + (i * CHUNK) as u64, chunk));
    }
}
