//! The film: sums of radiance in a fixed order, so that a picture's bits do not depend on the threads.

use super::columns::{STRIDE, Vectors};
use super::picture::{Picture, Size};
#[cfg(doc)]
use super::shadow::Shadows;
use rayon::prelude::*;

/// What a film keeps apart: the densities differ in the airlight alone. The last two are those of [`Shadows::Ratio`].
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Layer {
    /// Light that surfaces emit and reflect.
    Surface,
    /// Light that the medium scatters.
    Airlight,
    /// The same samples as if nothing cast a shadow.
    Unshadowed,
    /// The integral that these samples estimate.
    Integral,
}

/// Sums over passes.
#[derive(Clone, Debug)]
pub struct Film {
    size: Size,
    passes: u64,
    /// Those that nothing was added to have no pixels.
    layers: [Vec<[f64; 3]>; 4],
}

impl Film {
    /// A film that has not seen a pass.
    #[must_use]
    pub fn new(size: Size) -> Self {
        Self { size, passes: 0, layers: [size.pixels(), size.pixels(), 0, 0].map(|pixels| vec![[0.0; 3]; pixels]) }
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
        let sums = &mut self.layers[layer as usize];
        sums.resize(self.size.pixels(), [0.0; 3]);
        let sums = &mut sums[first..first + radiance.len()];
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

    /// The radiance that the medium scatters: the mean over the passes, or the mean of the integrals times the part of it
    /// that shadows leave.
    #[must_use]
    pub fn airlight(&self) -> Vec<[f64; 3]> {
        self.airlight_sums().map(|sum| sum.map(|sum| sum / self.passes as f64)).collect()
    }

    /// The radiance of everything.
    #[must_use]
    pub fn total(&self) -> Vec<[f64; 3]> {
        let total = |(s, a): (&[f64; 3], [f64; 3])| std::array::from_fn(|c| (s[c] + a[c]) / self.passes as f64);
        self.sum(Layer::Surface).iter().zip(self.airlight_sums()).map(total).collect()
    }

    fn airlight_sums(&self) -> impl Iterator<Item = [f64; 3]> {
        let [_, airlight, unshadowed, integral] = &self.layers;
        airlight.iter().enumerate().map(|(i, sum)| match (unshadowed.get(i), integral.get(i)) {
            (Some(unshadowed), Some(integral)) => {
                // Equal sums are exactly 1.
                let left = |c: usize| if unshadowed[c] > 0.0 { sum[c] / unshadowed[c] } else { 0.0 };
                std::array::from_fn(|c| integral[c] * left(c))
            }
            _ => *sum,
        })
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
