//! The public face: sample, pdf and evaluate, for a batch or for one ray.

use crate::batch::{Counts, Emitters, Media, Rays, Samples};
use crate::scene::{Emitter, Medium, Ray};
use crate::{Error, Strategy};

/// Samples scattering distances of one density.
#[derive(Clone, Copy, Debug)]
pub struct Sampler {
    strategy: Strategy,
}

/// One sample, as [`Samples`] holds many.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sample {
    /// Distance along the ray \[m\].
    pub t: f32,
    /// Probability density over distance \[1/m\].
    pub pdf: f32,
    /// `mu_s T rho N / (r^2 pdf)` \[1/m^2\].
    pub weight: f32,
    /// Distance from the sample to the emitter \[m\].
    pub r: f32,
}

impl Sampler {
    /// A sampler of `strategy`.
    #[must_use]
    pub fn new(strategy: Strategy) -> Self {
        Self { strategy }
    }

    /// Its density.
    #[must_use]
    pub fn strategy(&self) -> Strategy {
        self.strategy
    }

    /// Draws one distance per ray from the uniform variates `u` in `[0, 1]`.
    ///
    /// # Errors
    /// [`Error::Length`] if a column has another length than `rays.origin[0]`. Nothing is written then.
    pub fn sample(
        &self,
        _rays: &Rays<'_>,
        _emitters: &Emitters<'_>,
        _media: &Media<'_>,
        _u: &[f32],
        _samples: &mut Samples<'_>,
    ) -> Result<Counts, Error> {
        Ok(Counts::default())
    }

    /// The density at given distances `t`, for multiple importance sampling \[1/m\]; 0 outside the sampled interval.
    ///
    /// # Errors
    /// As [`sample`](Self::sample).
    pub fn pdf(
        &self,
        _rays: &Rays<'_>,
        _emitters: &Emitters<'_>,
        _media: &Media<'_>,
        _t: &[f32],
        _pdf: &mut [f32],
    ) -> Result<Counts, Error> {
        Ok(Counts::default())
    }

    /// The integrand `mu_s T rho N / r^2` at given distances `t` \[1/m^3\], the same for every strategy.
    ///
    /// # Errors
    /// As [`sample`](Self::sample).
    pub fn evaluate(
        &self,
        _rays: &Rays<'_>,
        _emitters: &Emitters<'_>,
        _media: &Media<'_>,
        _t: &[f32],
        _integrand: &mut [f32],
    ) -> Result<Counts, Error> {
        Ok(Counts::default())
    }

    /// [`sample`](Self::sample) for one ray; `None` if it has no sample.
    #[must_use]
    pub fn sample_one(&self, _ray: &Ray, _emitter: &Emitter, _medium: &Medium, _u: f32) -> Option<Sample> {
        None
    }

    /// [`pdf`](Self::pdf) for one ray.
    #[must_use]
    pub fn pdf_one(&self, _ray: &Ray, _emitter: &Emitter, _medium: &Medium, _t: f32) -> f32 {
        0.0
    }

    /// [`evaluate`](Self::evaluate) for one ray.
    #[must_use]
    pub fn evaluate_one(&self, _ray: &Ray, _emitter: &Emitter, _medium: &Medium, _t: f32) -> f32 {
        0.0
    }
}
