//! Borrowed columns of a batch: rays, emitters, media in, samples out, and how they are split.

use crate::Error;
use crate::scene::{Emitter, Medium};

/// A batch of rays as a structure of arrays; every column has the length of the batch and any alignment.
///
/// The values mean what they mean in [`Ray::new`](crate::Ray::new). A ray whose values are out of range there is
/// *invalid*: it is counted, and what is written for it is zero.
#[derive(Clone, Copy, Debug)]
pub struct Rays<'a> {
    /// Where the rays start, x, y, z \[m\].
    pub origin: [&'a [f32]; 3],
    /// Where they go, x, y, z, of length 1 within [`UNIT_TOLERANCE`](crate::UNIT_TOLERANCE).
    pub direction: [&'a [f32]; 3],
    /// Where they enter the medium \[m\].
    pub t_min: &'a [f32],
    /// Where they leave it \[m\], may be infinite.
    pub t_max: &'a [f32],
}

/// The emitter of each ray.
#[derive(Clone, Copy, Debug)]
pub enum Emitters<'a> {
    /// One for the whole batch.
    One(Emitter),
    /// One per ray, as columns of the batch's length.
    Each {
        /// Positions, x, y, z \[m\].
        position: [&'a [f32]; 3],
        /// Unit normals, x, y, z; the normal (0, 0, 0) stands for a point emitter.
        normal: [&'a [f32]; 3],
    },
}

/// The medium of each ray.
#[derive(Clone, Copy, Debug)]
pub enum Media<'a> {
    /// One for the whole batch.
    One(Medium),
    /// One per ray, as columns of the batch's length; the values mean what they mean in [`Medium::new`].
    Each {
        /// Absorption coefficients \[1/m\].
        mu_a: &'a [f32],
        /// Scattering coefficients \[1/m\].
        mu_s: &'a [f32],
        /// Mean cosines \[1\].
        g: &'a [f32],
    },
}

/// Where a batch of samples is written; every column has the length of the batch.
#[derive(Debug)]
pub struct Samples<'a> {
    /// Distances along the rays, in `[t_min, t_max]` \[m\].
    pub t: &'a mut [f32],
    /// Probability densities over distance \[1/m\].
    pub pdf: &'a mut [f32],
    /// `mu_s T rho N / (r^2 pdf)`: the one-sample estimate of the ray's single-scattered radiance per unit of the
    /// emitter's intensity \[1/m^2\], with `1/r^2` cancelled analytically and `T` counted from `t_min`.
    pub weight: Option<&'a mut [f32]>,
    /// Distances from the samples to the emitters \[m\], exact also where `t` alone cannot resolve them.
    pub r: Option<&'a mut [f32]>,
}

/// What became of the rays of a batch: `sampled + empty + invalid` is its length.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[non_exhaustive]
pub struct Counts {
    /// Rays with a sample.
    pub sampled: usize,
    /// Valid rays without one: `t_min = t_max`, or no point of the ray is lit.
    pub empty: usize,
    /// Rays with a value that is NaN or out of range.
    pub invalid: usize,
    /// Sampled rays whose Newton iteration fell back to bisection at least once.
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
