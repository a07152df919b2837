//! The radiance of a ray, without a sample.

mod nodes;
pub(crate) mod rule;

pub use nodes::{Nodes, UnknownNodes};

use crate::batch::{Counts, Emitters, Inputs, Media, Rays};
use crate::road::{self, Quadrature};
use crate::scene::{Emitter, Medium, Ray};
use crate::simd::Backend;
use crate::{Error, Precision, Threads};
use core::slice::from_mut;

/// The single-scattered radiance of rays per unit of the emitter's intensity \[1/m^2\], without a sample and so without
/// noise: the integral of the integrand `mu_s T rho N / r^2` over `t`.
///
/// It is Gauss and Legendre's rule in the variable of the product densities, in which the integrand is nearly a polynomial.
/// Nothing is tabulated and nothing cancels. Where others have tables (Sun et al. 2005) or series (Pegoraro et al. 2009),
/// eight evaluations leave the error of f32.
///
/// # Errors of the result
///
/// Relative, against quadrature in f64: for half of the rays, for 99 %, and for all of 8192 under each of two seeds. The
/// families are those of `airlight accuracy`.
///
#[doc = include_str!("integral/errors.md")]
///
/// The largest ones of `peaks` are backward peaks next to an emitter that shines across the ray. Emitters far away and short
/// intervals have errors of rounding alone.
///
/// [`Precision::Fast`] leaves 1.2e-5 more for 99 % of ordinary rays, and misjudges light as it says
/// [there](Precision). At `abs(g)` = 1 the phase function is 0 beside its peak, and so is the integral. It is 0 too where
/// the transmittance to the start of the lit part is below f32's range, and has few digits where that is below 1e-30.
#[derive(Clone, Copy, Debug)]
pub struct Integral {
    nodes: Nodes,
    precision: Precision,
    backend: Backend,
    threads: Threads,
}

impl Integral {
    /// The integral with so many nodes, on geometry as exact as there is, the widest backend of this machine and all threads
    /// of the pool.
    #[must_use]
    pub fn new(nodes: Nodes) -> Self {
        let (precision, threads) = (Precision::default(), Threads::default());
        Self { nodes, precision, backend: Backend::detect(), threads }
    }

    /// The same on geometry of another precision.
    #[must_use]
    pub fn with_precision(self, precision: Precision) -> Self {
        Self { precision, ..self }
    }

    /// The same on another backend, for tests and measurements.
    #[must_use]
    pub fn with_backend(self, backend: Backend) -> Self {
        Self { backend, ..self }
    }

    /// The same on other threads.
    #[must_use]
    pub fn with_threads(self, threads: Threads) -> Self {
        Self { threads, ..self }
    }

    /// How many nodes it has.
    #[must_use]
    pub fn nodes(&self) -> Nodes {
        self.nodes
    }

    /// Its precision.
    #[must_use]
    pub fn precision(&self) -> Precision {
        self.precision
    }

    /// Its backend.
    #[must_use]
    pub fn backend(&self) -> Backend {
        self.backend
    }

    /// Its threads.
    #[must_use]
    pub fn threads(&self) -> Threads {
        self.threads
    }

    fn quadrature(&self) -> Quadrature {
        Quadrature { nodes: self.nodes, precision: self.precision }
    }

    /// Writes the radiance of each ray.
    ///
    /// What is written is finite and not negative, and 0 for an empty or invalid ray. [`Counts::sampled`] counts the rays of
    /// which something is lit. Equal inputs give equal bits, wherever they stand in a batch and however many threads there
    /// are.
    ///
    /// # Errors
    /// [`Error::Length`] if a column has another length than `rays.origin[0]`; [`Error::Empty`] and [`Error::Unavailable`] as
    /// [`Sampler::sample`](crate::Sampler::sample). Nothing is written then.
    pub fn radiance(
        &self,
        rays: &Rays<'_>,
        emitters: &Emitters<'_>,
        media: &Media<'_>,
        radiance: &mut [f32],
    ) -> Result<Counts, Error> {
        let inputs = Inputs::new(rays, emitters, media)?;
        inputs.check("radiance", radiance)?;
        Ok(road::travel::<road::Radiance>(self.threads, self.backend, self.quadrature(), &inputs, radiance))
    }

    /// [`radiance`](Self::radiance) of one ray; 0 if there is no kernel for the emitter or the medium.
    #[must_use]
    pub fn radiance_one(&self, ray: &Ray, emitter: &Emitter, medium: &Medium) -> f32 {
        let mut radiance = 0.0;
        let scene = (ray, emitter, medium);
        road::travel_one::<road::Radiance>(self.backend, self.quadrature(), scene, &[], from_mut(&mut radiance));
        radiance
    }
}
