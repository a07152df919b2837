//! The film: sums of radiance in a fixed order, so that a picture's bits do not depend on the threads.

use super::columns::{STRIDE, Vectors};
use super::picture::{Picture, Size};
use rayon::prelude::*;

/// What a film keeps apart: the densities differ in the airlight alone.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Layer {
    /// Light that surfaces emit and reflect.
    Surface,
    /// Light that the medium scatters.
    Airlight,
}

/// Sums over passes.
#[derive(Clone, Debug)]
pub struct Film {
    size: Size,
    passes: u64,
    layers: [Vec<[f64; 3]>; 2],
}

impl Film {
    /// A film that has not seen a pass.
    #[must_use]
    pub fn new(size: Size) -> Self {
        Self { size, passes: 0, layers: [(); 2].map(|()| vec![[0.0; 3]; size.pixels()]) }
    }

    /// Its size.
    #[must_use]
    pub fn size(&self) -> Size {
        self.size
    }

    /// The passes that it has seen.
    #[must_use]
    pub fn passes(&self) -> u64 {
        self.passes
    }

    /// Adds a wave, whose first pixel is `first`.
    pub fn add(&mut self, layer: Layer, first: usize, radiance: &Vectors) {
        let sums = &mut self.layers[layer as usize][first..first + radiance.len()];
        sums.par_iter_mut().with_min_len(STRIDE).enumerate().for_each(|(i, sum)| {
            let radiance = radiance.at(i).as_dvec3().to_array();
            *sum = std::array::from_fn(|channel| sum[channel] + radiance[channel]);
        });
    }

    /// Counts a pass that is complete.
    pub fn end_pass(&mut self) {
        self.passes += 1;
    }

    /// The sum of a layer over the passes.
    #[must_use]
    pub fn sum(&self, layer: Layer) -> &[[f64; 3]] {
        &self.layers[layer as usize]
    }

    /// The mean radiance of a layer.
    #[must_use]
    pub fn mean(&self, layer: Layer) -> Vec<[f64; 3]> {
        self.layers[layer as usize].iter().map(|sum| sum.map(|sum| sum / self.passes as f64)).collect()
    }

    /// The mean radiance of both layers.
    #[must_use]
    pub fn total(&self) -> Vec<[f64; 3]> {
        let [surface, airlight] = &self.layers;
        let total = |(s, a): (&[f64; 3], &[f64; 3])| std::array::from_fn(|c| (s[c] + a[c]) / self.passes as f64);
        surface.iter().zip(airlight).map(total).collect()
    }

    /// The mean of the whole picture.
    #[must_use]
    pub fn average(&self) -> [f64; 3] {
        let sum = |sum: [f64; 3], pixel: &[f64; 3]| std::array::from_fn(|channel| sum[channel] + pixel[channel]);
        self.total().iter().fold([0.0; 3], sum).map(|sum| sum / self.size.pixels() as f64)
    }

    /// The picture.
    #[must_use]
    pub fn picture(&self) -> Picture {
        let rgb = self.total().iter().map(|mean| mean.map(|value| value as f32)).collect();
        Picture { size: self.size, rgb }
    }
}
