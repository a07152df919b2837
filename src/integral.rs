//! The radiance of a ray, without a sample; and a choice of emitters by it.

mod nodes;
pub(crate) mod rule;

pub use nodes::{Nodes, UnknownNodes};

use crate::batch::{Counts, Emitters, Inputs, Media, Rays, columns};
use crate::road::{self, Lights, Quadrature};
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
    /// [`Error::Length`] if a column has another length than `rays.origin[0]`; [`Error::Empty`] and [`Error::Channels`] as
    /// [`Sampler::sample`](crate::Sampler::sample). Nothing is written then.
    pub fn radiance(
        &self,
        rays: &Rays<'_>,
        emitters: &Emitters<'_>,
        media: &Media<'_>,
        radiance: &mut [f32],
    ) -> Result<Counts, Error> {
        self.radiances(rays, emitters, media, [radiance])
    }

    /// The same in coloured media: the radiance of each ray in every channel, a column for each.
    ///
    /// ```
    /// # use airlight::{Emitter, Emitters, Integral, Media, Medium, Nodes, Rays};
    /// let (zero, one, t_max) = ([0.0; 2], [1.0; 2], [9.0; 2]);
    /// let rays = Rays::new([&zero; 3], [&zero, &zero, &one], &zero, &t_max);
    /// let lamp = Emitters::one(Emitter::point([0.0, 1.0, 3.0])?);
    /// let smoke = Media::one(Medium::coloured([0.2, 0.3, 0.5], [0.4, 0.4, 0.0], 0.8)?);
    /// let [mut red, mut green, mut blue] = [zero; 3];
    /// Integral::new(Nodes::Eight).radiance_coloured(&rays, &lamp, &smoke, [&mut red, &mut green, &mut blue])?;
    /// assert!(red[0] > green[0] && green[0] > blue[0] && blue[0] == 0.0);
    /// # Ok::<(), airlight::Error>(())
    /// ```
    ///
    /// # Errors
    /// As [`radiance`](Self::radiance); [`Error::Channels`] unless there are as many columns as the media have channels.
    pub fn radiance_coloured<const C: usize>(
        &self,
        rays: &Rays<'_>,
        emitters: &Emitters<'_>,
        media: &Media<'_>,
        radiances: [&mut [f32]; C],
    ) -> Result<Counts, Error> {
        self.radiances(rays, emitters, media, radiances)
    }

    fn radiances<const C: usize>(
        &self,
        rays: &Rays<'_>,
        emitters: &Emitters<'_>,
        media: &Media<'_>,
        radiances: [&mut [f32]; C],
    ) -> Result<Counts, Error> {
        let inputs = Inputs::new(rays, emitters, media)?;
        inputs.check_channels("radiance", C)?;
        radiances.iter().try_for_each(|radiance| inputs.check("radiance", radiance))?;
        let out = columns(radiances);
        Ok(road::travel::<road::Radiance>(self.threads, self.backend, self.quadrature(), &inputs, out))
    }

    /// Chooses one emitter of `table` for each ray, in proportion to its weight times the integral of this many nodes, which
    /// is what it adds to the ray's radiance: writes its index, and the probability with which it was chosen. That is the
    /// ratio of the two sums to rounding, so that over the table the probabilities add up to 1. [`Nodes::Four`] are enough. Of a
    /// coloured medium the integral is that of its [mean](Medium::mean).
    ///
    /// `weights` has one value for each emitter, such as the mean of its intensity over the channels; an emitter with the
    /// weight 0 is never chosen. `u` has a variate in `[0, 1]` for each ray; it must be independent of those that distances are
    /// then sampled with, or the estimate is biased. The index increases with `u`, so that stratified and low-discrepancy
    /// variates keep their order. With the chosen emitter's sample, radiance is intensity times weight
    /// of the sample over probability.
    ///
    /// [`Counts::sampled`] counts the rays with a choice: its probability is not 0. Where no emitter lights the ray, or adds
    /// as much as f32's least number, it is *empty*. A variate outside `[0, 1]` makes its ray invalid. For an empty or invalid
    /// ray index and probability are 0. Equal inputs give equal bits, wherever they stand in a batch and however many threads
    /// there are.
    ///
    /// It takes the time of the integrals, and nothing is allocated. Of a table with more than 32 emitters as many as are in
    /// a 32nd of it, or one more, are asked twice.
    ///
    /// ```
    /// # use airlight::{Emitter, Emitters, Integral, Media, Medium, Nodes, Rays, Sampler, Samples, Strategy};
    /// let (zero, one, t_max) = ([0.0; 2], [1.0; 2], [9.0; 2]);
    /// let rays = Rays::new([&zero; 3], [&zero, &zero, &one], &zero, &t_max);
    /// let lamps = [Emitter::point([0.0, 1.0, 3.0])?, Emitter::point([0.0, 2.0, 7.0])?];
    /// let (watts, fog) = ([20.0, 100.0], Media::one(Medium::new(0.01, 0.1, 0.6)?));
    ///
    /// let (mut index, mut probability) = ([0; 2], zero);
    /// let integral = Integral::new(Nodes::Four);
    /// integral.choose(&rays, &lamps, &watts, &fog, &[0.1, 0.9], &mut index, &mut probability)?;
    /// assert!(index == [0, 1] && (probability[0] + probability[1] - 1.0).abs() < 1e-6);
    ///
    /// let (mut t, mut pdf, mut weight) = (zero, zero, zero);
    /// let mut samples = Samples::new(&mut t, &mut pdf).weight(&mut weight);
    /// let of_rays = Emitters::table(&lamps, &index);
    /// Sampler::new(Strategy::Product5).sample(&rays, &of_rays, &fog, &[0.5; 2], &mut samples)?;
    /// let radiance = [0, 1].map(|i| watts[index[i] as usize] * weight[i] / probability[i]);
    /// # assert!((radiance[0] / radiance[1] - 1.0).abs() < 0.1);
    /// # Ok::<(), airlight::Error>(())
    /// ```
    ///
    /// # Errors
    /// [`Error::Empty`] for a table without emitters. [`Error::Length`] if `weights` has another length than `table`, or a
    /// column another one than `rays.origin[0]`. [`Error::Value`] for a weight that is negative or not finite, and for a table
    /// of more than 2^24 emitters. Nothing is written then.
    #[expect(clippy::too_many_arguments, reason = "columns in and columns out")]
    pub fn choose(
        &self,
        rays: &Rays<'_>,
        table: &[Emitter],
        weights: &[f32],
        media: &Media<'_>,
        u: &[f32],
        index: &mut [u32],
        probability: &mut [f32],
    ) -> Result<Counts, Error> {
        let inputs = Inputs::with_table(rays, table, media)?;
        // Whole numbers of f32.
        let emitters = table.len() as f32;
        Error::unless(table.len() <= 1 << f32::MANTISSA_DIGITS, "table.len()", emitters, "at most 2^24 emitters")?;
        Error::unless_length("weights", weights.len(), table.len())?;
        let is_weight = |weight: f32| (0.0..=f32::MAX).contains(&weight);
        weights.iter().try_for_each(|&w| Error::unless(is_weight(w), "weights", w, "finite values >= 0"))?;
        inputs.check("u", u)?;
        Error::unless_length("index", index.len(), inputs.len())?;
        inputs.check("probability", probability)?;
        let lights = Lights { quadrature: self.quadrature(), table, weights };
        let inputs = inputs.with(u, "u")?;
        Ok(road::travel::<road::Choose<'_>>(self.threads, self.backend, lights, &inputs, (index, probability)))
    }

    /// [`radiance`](Self::radiance) of one ray; of a coloured medium that of its [mean](Medium::mean).
    #[must_use]
    pub fn radiance_one(&self, ray: &Ray, emitter: &Emitter, medium: &Medium) -> f32 {
        let mut radiance = 0.0;
        let scene = (ray, emitter, medium);
        let out = columns([from_mut(&mut radiance)]);
        road::travel_one::<road::Radiance>(self.backend, self.quadrature(), scene, &[], out);
        radiance
    }
}
