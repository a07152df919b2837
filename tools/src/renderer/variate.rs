//! Numbers of a pass that decide what is left to chance: each belongs to a pixel and a decision, whoever draws it when.

use crate::variates;
use rayon::prelude::*;
use std::fmt;
use std::str::FromStr;

/// Numbers that a thread draws at a time.
const CHUNK: usize = 4096;
/// Passes that a Sobol sequence lasts for; then another one begins.
const LENGTH: u64 = 1 << 16;

/// What a number decides.
///
/// A Sobol sequence is most even in its first dimensions, and these have the decisions on which the airlight depends.
#[derive(Clone, Copy, Debug)]
pub enum Dimension {
    /// Where in its pixel a ray goes, across.
    X,
    /// And down.
    Y,
    /// The light that the medium is lit by.
    Emitter,
    /// The distance.
    Distance,
    /// The light that a surface is lit by.
    SurfaceEmitter,
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

/// How the numbers of the passes belong together.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Sequence {
    /// Those of a pixel are the points of a Sobol sequence, scrambled as Owen does, of its own: over the passes they fill
    /// the unit cube evenly.
    #[default]
    Sobol,
    /// All are independent.
    Independent,
}

impl Sequence {
    /// Its name on the command line and in JSON.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Sobol => "sobol",
            Self::Independent => "independent",
        }
    }
}

impl fmt::Display for Sequence {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.pad(self.name())
    }
}

impl FromStr for Sequence {
    type Err = String;
    fn from_str(name: &str) -> Result<Self, String> {
        let mut all = [Self::Sobol, Self::Independent].into_iter();
        all.find(|sequence| sequence.name() == name).ok_or_else(|| "expected sobol or independent".to_owned())
    }
}

/// The numbers of one pass.
#[derive(Clone, Copy, Debug)]
pub struct Variates {
    /// How they belong to those of other passes.
    pub sequence: Sequence,
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
        u.resize(count, 0.0);
        u.par_chunks_mut(CHUNK).enumerate().for_each(|(i, chunk)| {
            let first = (first + i * CHUNK) as u64;
            match self.sequence {
                Sequence::Sobol => self.sobol(dimension, first, chunk),
                Sequence::Independent => {
                    let start = (self.pass * Dimension::COUNT + dimension as u64) * self.pixels as u64;
                    variates::fill(self.seed, start + first, chunk);
                }
            }
        });
    }

    fn sobol(&self, dimension: Dimension, first: u64, u: &mut [f32]) {
        let (lap, index) = (self.pass / LENGTH, self.pass % LENGTH);
        let start = lap * self.pixels as u64 + first;
        for (sequence, u) in (start..).zip(u) {
            let scramble = (variates::bits(self.seed, sequence) >> 32) as u32;
            *u = sobol_burley::sample(index as u32, dimension as u32, scramble);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const PIXELS: usize = 300;
    const PASSES: usize = 64;

    /// The numbers of every pass.
    fn draw(sequence: Sequence, seed: u64, dimension: Dimension) -> Vec<Vec<f32>> {
        let pass = |pass| {
            let mut u = Vec::new();
            Variates { sequence, seed, pass, pixels: PIXELS }.fill(dimension, 0, PIXELS, &mut u);
            u
        };
        (0..PASSES as u64).map(pass).collect()
    }

    /// Of 64 numbers of a decision one is in every 64th, and of the places in a pixel one in each square of a grid.
    #[test]
    fn the_numbers_of_a_pixel_are_one_in_each_stratum() {
        use Dimension::{Distance, Emitter, SecondDistance, SurfaceEmitter, X, Y};
        for dimension in [X, Y, Emitter, Distance, SurfaceEmitter, SecondDistance] {
            let numbers = draw(Sequence::Sobol, 3, dimension);
            for pixel in 0..PIXELS {
                let mut hits = [0; PASSES];
                numbers.iter().for_each(|pass| hits[(pass[pixel] * PASSES as f32) as usize] += 1);
                assert_eq!(hits, [1; PASSES], "pixel {pixel}, {dimension:?}");
            }
        }
        let [x, y] = [X, Y].map(|dimension| draw(Sequence::Sobol, 3, dimension));
        for pixel in 0..PIXELS {
            let mut hits = [[0; 8]; 8];
            let cell = |u: f32| (u * 8.0) as usize;
            x.iter().zip(&y).for_each(|(x, y)| hits[cell(x[pixel])][cell(y[pixel])] += 1);
            assert_eq!(hits, [[1; 8]; 8], "pixel {pixel}");
        }
    }

    #[test]
    fn pixels_seeds_and_laps_have_sequences_of_their_own() {
        let first = |seed, pass| {
            let mut u = Vec::new();
            let variates = Variates { sequence: Sequence::Sobol, seed, pass, pixels: PIXELS };
            variates.fill(Dimension::Distance, 0, PIXELS, &mut u);
            u
        };
        let (u, others) = (first(1, 0), [first(2, 0), first(1, LENGTH), first(1, 1)]);
        let equal = |other: &Vec<f32>| u.iter().zip(other).filter(|(a, b)| a == b).count();
        assert!(others.iter().all(|other| equal(other) == 0));
        let mean = u.iter().sum::<f32>() / PIXELS as f32;
        assert!((mean - 0.5).abs() < 0.08, "{mean}");
        let mut sorted = u.clone();
        sorted.sort_by(f32::total_cmp);
        sorted.dedup();
        assert_eq!(sorted.len(), PIXELS);
        assert!(first(1, u64::from(u32::MAX) * 7).iter().all(|u| (0.0..1.0).contains(u)));
    }

    #[test]
    fn a_number_does_not_depend_on_the_wave() {
        for sequence in [Sequence::Sobol, Sequence::Independent] {
            let fill = |first, count| {
                let mut u = Vec::new();
                Variates { sequence, seed: 1, pass: 5, pixels: 20_000 }.fill(Dimension::Y, first, count, &mut u);
                u
            };
            assert_eq!(fill(0, 20_000)[7000..], fill(7000, 13_000), "{sequence}");
        }
    }
}
