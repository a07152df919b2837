//! The radiance of a ray without a sample, and the choice of an emitter in proportion to it.

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
/// The method is Gauss and Legendre's rule in the variable of the product densities, in which the integrand is nearly a
/// polynomial: (7.1) to (7.3) of [mathematics](crate::guide::mathematics#7-the-integral-without-a-sample). It has no table and
/// no cancellation. Where others have tables (Sun et al. 2005) or series (Pegoraro et al. 2009), eight evaluations reach the
/// error of f32.
///
/// # Accuracy
///
/// Relative error of [`radiance`](Self::radiance) against quadrature in f64, with [`Precision::Exact`]: the bound for half of the
/// rays, for 99 %, and for all of 8192 under each of two seeds, by number of nodes. The families of inputs are those of
/// `airlight accuracy`; the test is `tests/radiance.rs`.
///
#[doc = include_str!("integral/errors.md")]
///
/// The largest errors of `peaks` are those of backward peaks next to an emitter that shines across the ray. `far-away` and
/// `short-intervals` have rounding errors alone.
///
/// [`Precision::Fast`] adds at most 1.2e-5 for 99 % of rays of [ordinary scenes](Precision), and misjudges light as stated
/// [there](Precision). At `abs(g)` = 1 the phase function is 0 beside its peak, and so is the integral. The integral is also 0
/// where the transmittance to the start of the lit part is below f32's range, and has few digits where that is below 1e-30.
#[derive(Clone, Copy, Debug)]
pub struct Integral {
    nodes: Nodes,
    precision: Precision,
    backend: Backend,
    threads: Threads,
}

impl Integral {
    /// The integral with this number of nodes, in exact precision, on the widest backend of this machine and all threads of the
    /// pool.
    #[must_use]
    pub fn new(nodes: Nodes) -> Self {
        let (precision, threads) = (Precision::default(), Threads::default());
        Self { nodes, precision, backend: Backend::detect(), threads }
    }

    /// The same in another precision.
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

    /// The number of nodes.
    #[must_use]
    pub fn nodes(&self) -> Nodes {
        self.nodes
    }

    /// The precision.
    #[must_use]
    pub fn precision(&self) -> Precision {
        self.precision
    }

    /// The backend.
    #[must_use]
    pub fn backend(&self) -> Backend {
        self.backend
    }

    /// The threads of a call.
    #[must_use]
    pub fn threads(&self) -> Threads {
        self.threads
    }

    fn quadrature(&self) -> Quadrature {
        Quadrature { nodes: self.nodes, precision: self.precision }
    }

    /// Computes the radiance of each ray.
    ///
    /// The output is 0 for an empty or invalid ray. [`Counts::sampled`] counts the rays of which a part is lit.
    ///
    /// # Accuracy
    ///
    /// | output | bound | where | test |
    /// |---|---|---|---|
    /// | `radiance` | finite, not negative | any bits | `tests/radiance.rs` |
    /// | `radiance` | the relative errors of the [table](Self#accuracy) by family and nodes | radiances within the digits of f32 | `tests/radiance.rs` |
    /// | bits | equal for equal inputs, whatever the place in the batch, its length and the number of threads | default floating-point environment | `tests/radiance.rs` |
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
        self.radiance_coloured(rays, emitters, media, [radiance])
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
        let inputs = Inputs::new(rays, emitters, media)?;
        inputs.check_channels("radiance", C)?;
        radiances.iter().try_for_each(|radiance| inputs.check("radiance", radiance))?;
        let out = columns(radiances);
        Ok(road::travel::<road::Radiance>(self.threads, self.backend, self.quadrature(), &inputs, out))
    }

    /// Chooses one emitter of `table` for each ray, with a probability in proportion to its weight times its integral, which is
    /// what it adds to the ray's radiance; writes its index and this probability. [`Nodes::Four`] are enough. In a coloured
    /// medium the integral is that of the [mean](Medium::mean).
    ///
    /// - `weights`: one value for each emitter, such as the mean of its intensity over the channels. An emitter with the weight 0
    ///   is never chosen.
    /// - `u`: one variate in `[0, 1]` for each ray. It must be independent of the variates of distances, or the estimate is
    ///   biased. A variate outside `[0, 1]` makes its ray invalid.
    /// - The estimate of the radiance is the intensity of the chosen emitter, times the weight of its sample, over `probability`.
    ///
    /// [`Counts::sampled`] counts the rays with a choice: their probability is not 0. A ray is *empty* where no emitter adds more
    /// than f32's least number. Index and probability of an empty or invalid ray are 0.
    ///
    /// The call evaluates the integral of every emitter for every ray, and allocates nothing. Of a table with more than 32
    /// emitters at most a 32nd, rounded up, is evaluated twice.
    ///
    /// # Accuracy
    ///
    /// | output | bound | where | test |
    /// |---|---|---|---|
    /// | `probability` | 2.5e-7, relative, of weight times integral over the sum for all emitters | random rooms, shares from 1e-6 | `tests/choose.rs` |
    /// | `probability` | the sum over the table is 1 to 2e-7 | random rooms | `tests/choose.rs` |
    /// | `index` | increases with `u`: stratified and low-discrepancy variates keep their order | random rooms | `tests/choose.rs` |
    /// | bits | equal for equal inputs, whatever the place in the batch, its length and the number of threads | default floating-point environment | `tests/choose.rs` |
    ///
    /// The integral itself has the errors of its [table](Self#accuracy): they add variance, and no bias.
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
        let has_spots = Emitters::have_spots(table);
        let lights = Lights { quadrature: self.quadrature(), table, weights, has_spots };
        let inputs = inputs.with(u, "u")?;
        Ok(road::travel::<road::Choose<'_>>(self.threads, self.backend, lights, &inputs, (index, probability)))
    }

    /// [`radiance`](Self::radiance) of one ray; in a coloured medium the radiance of the [mean](Medium::mean).
    #[must_use]
    pub fn radiance_one(&self, ray: &Ray, emitter: &Emitter, medium: &Medium) -> f32 {
        let mut radiance = 0.0;
        let scene = (ray, emitter, medium);
        let out = columns([from_mut(&mut radiance)]);
        road::travel_one::<road::Radiance>(self.backend, self.quadrature(), scene, &[], out);
        radiance
    }
}
