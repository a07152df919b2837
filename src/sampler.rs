//! The public face: sample, pdf, cdf and evaluate, for a batch or for one ray.

use crate::batch::{Counts, Emitters, Inputs, Media, Rays, Samples, columns};
use crate::road::Method;
use crate::scene::{Emitter, Medium, Ray};
use crate::simd::Backend;
use crate::{Error, Precision, Strategy, Threads, road};
use core::slice::from_mut;

/// Samples scattering distances of one density.
///
/// # Floating-point environment
///
/// Rust code assumes the default one: rounding to nearest, subnormal numbers kept. A host that sets flush-to-zero or
/// denormals-are-zero on its own thread gets it in small batches, which run on the calling thread, and not in large ones,
/// which run on those of the pool: the two then differ in bits.
///
/// With both flags set, `t`, `pdf` and `r` keep their bits at ordinary scales: lengths from a millimetre to a kilometre, and
/// an emitter that is not on the ray's line. Weights and integrands keep theirs there unless a factor of them is below
/// f32's least normal number, 1.2e-38. Elsewhere any of them may differ. (Measured once, on AVX2 and on portable.)
#[derive(Clone, Copy, Debug)]
pub struct Sampler {
    strategy: Strategy,
    precision: Precision,
    backend: Backend,
    threads: Threads,
}

/// One sample, as [`Samples`] holds many.
///
/// It may get more fields, as those may.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
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
    /// A sampler of `strategy`, as exact as there is, on the widest backend of this machine and all threads of the pool.
    #[must_use]
    pub fn new(strategy: Strategy) -> Self {
        let (precision, threads) = (Precision::default(), Threads::default());
        Self { strategy, precision, backend: Backend::detect(), threads }
    }

    /// The same with another precision.
    ///
    /// # Errors
    /// [`Error::Unavailable`] unless the strategy [has](Strategy::has_precision) it.
    pub fn with_precision(self, precision: Precision) -> Result<Self, Error> {
        if self.strategy.has_precision(precision) {
            Ok(Self { precision, ..self })
        } else {
            let field = match precision {
                Precision::Exact => "exact precision",
                Precision::Fast => "fast precision",
            };
            Err(Error::Unavailable { field, strategy: Some(self.strategy) })
        }
    }

    /// The same on another backend, for tests and measurements.
    #[must_use]
    pub fn with_backend(self, backend: Backend) -> Self {
        Self { backend, ..self }
    }

    /// The same on other threads. A sampler is a few bytes, so that every call may have its own:
    ///
    /// ```
    /// # use airlight::{Sampler, Strategy, Threads};
    /// let sampler = Sampler::new(Strategy::Product5);
    /// let here = sampler.with_threads(Threads::Caller);
    /// ```
    #[must_use]
    pub fn with_threads(self, threads: Threads) -> Self {
        Self { threads, ..self }
    }

    /// Takes a batch the whole way.
    fn travel<T: road::Task<Method = Method>>(&self, inputs: &Inputs<'_>, out: road::Out<'_, T>) -> Counts {
        road::travel::<T>(self.threads, self.backend, self.method(), inputs, out)
    }

    pub(crate) fn method(&self) -> Method {
        Method { strategy: self.strategy, precision: self.precision }
    }

    /// Its density.
    #[must_use]
    pub fn strategy(&self) -> Strategy {
        self.strategy
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

    /// Draws a distance for each of the uniform variates `u` in `[0, 1]`.
    ///
    /// `u` and the columns of `samples` have the length of the batch, or k times that: then the k samples of a ray lie
    /// next to each other, those of ray `i` from `k i` on, and share the set-up of the ray's density.
    ///
    /// Variates need not be independent: stratified and low-discrepancy ones are welcome, in a column of one variate per ray
    /// as among the variates of one ray. The inverse is monotone, so that every interval of `u` is an interval of `t` with as
    /// much of the density, and variates that are even in `[0, 1]` are as even along the ray.
    ///
    /// `t` increases with `u`, but for rounding: from two variates closer than 2^-20 the larger one may come out first,
    /// by no more than 5e-6 of the CDF. What is written for an empty or invalid ray is 0. A variate outside `[0, 1]`
    /// makes its ray invalid. Equal inputs give equal bits, wherever they stand in a batch and however many threads
    /// there are, in the [default floating-point environment](Self#floating-point-environment).
    ///
    /// Errors are those of [`Precision::Exact`]; what `Fast` has instead stands [there](Precision).
    ///
    /// Beyond the rounding of `t` to f32 the CDF at `t` is within 2^-20 of `u`. `r`, to 4 ulp, and the weight, to 2e-5, are
    /// those of a distance that rounds to `t`, or of a variate so near to `u`: next to the emitter `t` resolves neither.
    /// (Where the density is below a thousandth of its mean, the error of a weight grows as that falls.) `airlight
    /// accuracy` measures it. At u = 0 and 1 a density that vanishes there is sampled next to the end.
    ///
    /// # Errors
    /// [`Error::Length`] if a column has another length than `rays.origin[0]`, or `u` one that is no multiple of it, or
    /// an output another one than `u`; [`Error::Empty`] for a table without entries, also with no rays;
    /// [`Error::Channels`] if the media of a table have different numbers of channels, or there are columns of weights and not as
    /// many as channels; [`Error::Value`] for media of a number of channels that there is not. Nothing is written then.
    pub fn sample(
        &self,
        rays: &Rays<'_>,
        emitters: &Emitters<'_>,
        media: &Media<'_>,
        u: &[f32],
        samples: &mut Samples<'_>,
    ) -> Result<Counts, Error> {
        let inputs = Inputs::new(rays, emitters, media)?.with(u, "u")?;
        inputs.check_given("samples.t", samples.t)?;
        inputs.check_given("samples.pdf", samples.pdf)?;
        if samples.channels() > 0 {
            inputs.check_channels("samples.weights", samples.channels())?;
        }
        samples.weights.iter().flatten().try_for_each(|weight| inputs.check_given("samples.weights", weight))?;
        if let Some(r) = &samples.r {
            inputs.check_given("samples.r", r)?;
        }
        Ok(self.travel::<road::Sample>(&inputs, samples.reborrow()))
    }

    /// The density at given distances `t`, for multiple importance sampling \[1/m\]; 0 outside the sampled interval.
    ///
    /// It is the density of what [`sample`](Self::sample) returns, taken at `t` as rounded: where `t` resolves `r` the
    /// two agree within 1e-5, next to the emitter that of `sample` is the exact one.
    ///
    /// | error at a given `t`, in ulp, of [`Precision::Exact`] | 99 % of rays | 99.99 % |
    /// |---|---|---|
    /// | all densities, but for what follows | 8 | 64 |
    /// | product densities at the very ends of the interval, where they may vanish | 14 | 128 |
    /// | `Product3` next to the emitter | 9 | 64 |
    /// | `Product3` next to the emitter, with `1 - abs(g)` from 2^-24 to 1e-3 (family `peaks`) | 17 | 96 |
    /// | product densities on arbitrary bits | 10 | no promise |
    ///
    /// What limits `peaks` is the set-up in f32: where the line of three knots falls from a peak to next to nothing, its value
    /// counts the roundings of the set-up many times; geometry rounded to f32 would leave 2 ulp.
    ///
    /// The error of a density below a thousandth of `1/(t_b - t_a)`, its mean over the sampled interval, is in ulp of that
    /// thousandth. A density below f32's range is 0.
    ///
    /// [`Counts::sampled`] counts the rays that have a sample, whether or not it could be at `t`. A NaN in `t` makes
    /// its ray invalid.
    ///
    /// # Errors
    /// As [`sample`](Self::sample).
    pub fn pdf(
        &self,
        rays: &Rays<'_>,
        emitters: &Emitters<'_>,
        media: &Media<'_>,
        t: &[f32],
        pdf: &mut [f32],
    ) -> Result<Counts, Error> {
        let inputs = Inputs::new(rays, emitters, media)?.with(t, "t")?;
        inputs.check_given("pdf", pdf)?;
        Ok(self.travel::<road::Pdf>(&inputs, pdf))
    }

    /// The distribution function at given distances `t` \[1\]: the probability that [`sample`](Self::sample) returns less,
    /// 0 before the sampled interval and 1 beyond it. It is the inverse of `sample`: from `t` back to `u`, which pbrt calls
    /// `Invert`, for bidirectional and primary-sample-space methods.
    ///
    /// With [`Precision::Exact`] the error is at most 2^-20 at the given `t`, with `Fast` at most 8e-6 for 99.9 % of the rays
    /// of [ordinary scenes](Precision). What is written for an empty or invalid ray is 0. A NaN in `t` makes its ray invalid.
    ///
    /// ```
    /// # use airlight::{Emitter, Medium, Ray, Sampler, Strategy};
    /// let (ray, lamp) = (Ray::new([0.0; 3], [0.0, 0.0, 1.0], 0.0, 9.0)?, Emitter::point([0.0, 1.0, 3.0])?);
    /// let (fog, sampler) = (Medium::new(0.01, 0.1, 0.6)?, Sampler::new(Strategy::EquiAngular));
    /// let sample = sampler.sample_one(&ray, &lamp, &fog, 0.25).unwrap();
    /// assert!((sampler.cdf_one(&ray, &lamp, &fog, sample.t) - 0.25).abs() < 1e-6);
    /// # Ok::<(), airlight::Error>(())
    /// ```
    ///
    /// # Errors
    /// As [`sample`](Self::sample).
    #[doc(alias = "invert")]
    pub fn cdf(
        &self,
        rays: &Rays<'_>,
        emitters: &Emitters<'_>,
        media: &Media<'_>,
        t: &[f32],
        cdf: &mut [f32],
    ) -> Result<Counts, Error> {
        let inputs = Inputs::new(rays, emitters, media)?.with(t, "t")?;
        inputs.check_given("cdf", cdf)?;
        Ok(self.travel::<road::Cdf>(&inputs, cdf))
    }

    /// The integrand `mu_s T rho N / r^2` at given distances `t` \[1/m^3\], the same for every strategy of a precision; 0 outside
    /// `[t_min, t_max]`, and at most `f32::MAX`. Of [`Precision::Exact`] max error 48 ulp where the optical depth is below 30 and the
    /// ray's line at least 1e-7 of the distance off the emitter; where N vanishes, relative to N = 1e-3.
    ///
    /// # Errors
    /// As [`sample`](Self::sample).
    pub fn evaluate(
        &self,
        rays: &Rays<'_>,
        emitters: &Emitters<'_>,
        media: &Media<'_>,
        t: &[f32],
        integrand: &mut [f32],
    ) -> Result<Counts, Error> {
        self.integrands(rays, emitters, media, t, [integrand])
    }

    /// The same in coloured media: the integrand in every channel, a column for each.
    ///
    /// # Errors
    /// As [`sample`](Self::sample); [`Error::Channels`] unless there are as many columns as the media have channels.
    pub fn evaluate_coloured<const C: usize>(
        &self,
        rays: &Rays<'_>,
        emitters: &Emitters<'_>,
        media: &Media<'_>,
        t: &[f32],
        integrands: [&mut [f32]; C],
    ) -> Result<Counts, Error> {
        self.integrands(rays, emitters, media, t, integrands)
    }

    fn integrands<const C: usize>(
        &self,
        rays: &Rays<'_>,
        emitters: &Emitters<'_>,
        media: &Media<'_>,
        t: &[f32],
        integrands: [&mut [f32]; C],
    ) -> Result<Counts, Error> {
        let inputs = Inputs::new(rays, emitters, media)?.with(t, "t")?;
        inputs.check_channels("integrand", C)?;
        integrands.iter().try_for_each(|integrand| inputs.check_given("integrand", integrand))?;
        Ok(self.travel::<road::Evaluate>(&inputs, columns(integrands)))
    }

    /// Goes the road of [`sample`](Self::sample) up to a stage and no further, to time it; nothing is written.
    ///
    /// # Errors
    /// As [`sample`](Self::sample).
    #[cfg(feature = "measure")]
    #[doc(hidden)]
    pub fn up_to(
        &self,
        stage: road::stages::Stage,
        rays: &Rays<'_>,
        emitters: &Emitters<'_>,
        media: &Media<'_>,
        u: &[f32],
    ) -> Result<(), Error> {
        let inputs = Inputs::new(rays, emitters, media)?.with(u, "u")?;
        self.travel::<road::stages::UpTo>(&inputs, stage);
        Ok(())
    }

    /// [`sample`](Self::sample) for one ray; `None` if it has no sample, or `u` is not in `[0, 1]`. Of a coloured medium the
    /// weight is that of its [mean](Medium::mean).
    #[must_use]
    pub fn sample_one(&self, ray: &Ray, emitter: &Emitter, medium: &Medium, u: f32) -> Option<Sample> {
        let [mut t, mut pdf, mut weight, mut r] = [0.0; 4];
        let out = Samples::new(from_mut(&mut t), from_mut(&mut pdf));
        let out = out.weight(from_mut(&mut weight)).r(from_mut(&mut r));
        let counts = self.one::<road::Sample>(ray, emitter, medium, u, out);
        (counts.sampled == 1).then_some(Sample { t, pdf, weight, r })
    }

    /// [`pdf`](Self::pdf) for one ray.
    #[must_use]
    pub fn pdf_one(&self, ray: &Ray, emitter: &Emitter, medium: &Medium, t: f32) -> f32 {
        let mut pdf = 0.0;
        self.one::<road::Pdf>(ray, emitter, medium, t, from_mut(&mut pdf));
        pdf
    }

    /// [`cdf`](Self::cdf) for one ray.
    #[must_use]
    pub fn cdf_one(&self, ray: &Ray, emitter: &Emitter, medium: &Medium, t: f32) -> f32 {
        let mut cdf = 0.0;
        self.one::<road::Cdf>(ray, emitter, medium, t, from_mut(&mut cdf));
        cdf
    }

    /// [`evaluate`](Self::evaluate) for one ray; of a coloured medium that of its [mean](Medium::mean).
    #[must_use]
    pub fn evaluate_one(&self, ray: &Ray, emitter: &Emitter, medium: &Medium, t: f32) -> f32 {
        let mut integrand = 0.0;
        self.one::<road::Evaluate>(ray, emitter, medium, t, columns([from_mut(&mut integrand)]));
        integrand
    }

    /// Takes one ray the whole way.
    fn one<T: road::Task<Method = Method>>(
        &self,
        ray: &Ray,
        emitter: &Emitter,
        medium: &Medium,
        given: f32,
        out: road::Out<'_, T>,
    ) -> Counts {
        road::travel_one::<T>(self.backend, self.method(), (ray, emitter, medium), &[given], out)
    }
}
