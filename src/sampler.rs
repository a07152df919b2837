//! The public calls of a density: sample, pdf, cdf and evaluate, for a batch or for one ray.

use crate::batch::{Counts, Emitters, Inputs, Media, Rays, Samples, columns};
use crate::road::Method;
use crate::scene::{Emitter, MOST_CHANNELS, Medium, Ray};
use crate::simd::Backend;
use crate::{Error, Precision, Strategy, Threads, road};
use core::slice::from_mut;

/// Samples scattering distances of one density.
///
/// # Floating-point environment
///
/// Rust code assumes the default environment: rounding to nearest, subnormal numbers kept. If a host sets flush-to-zero or
/// denormals-are-zero on its own thread, small batches, which run on the calling thread, use these flags, and large batches,
/// which run on threads of the pool, do not: their bits then differ.
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

/// One sample: an entry of the columns of [`Samples`]. Later versions may add fields to both.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct Sample {
    /// Distance along the ray \[m\].
    pub t: f32,
    /// Probability density over distance \[1/m\].
    pub pdf: f32,
    /// Integrand over density: `mu_s T rho N / (r^2 pdf)` \[1/m^2\].
    pub weight: f32,
    /// Distance from the sample to the emitter \[m\].
    pub r: f32,
}

impl Sampler {
    /// A sampler of `strategy` in exact precision, on the widest backend of this machine and all threads of the pool.
    #[must_use]
    pub fn new(strategy: Strategy) -> Self {
        let (precision, threads) = (Precision::default(), Threads::default());
        Self { strategy, precision, backend: Backend::detect(), threads }
    }

    /// The same with another precision.
    ///
    /// # Errors
    /// [`Error::Unavailable`] if the strategy does not [have](Strategy::has_precision) this precision.
    pub fn with_precision(self, precision: Precision) -> Result<Self, Error> {
        if self.strategy.has_precision(precision) {
            Ok(Self { precision, ..self })
        } else {
            let field = match precision {
                Precision::Exact => "exact precision",
                Precision::Fast => "fast precision",
            };
            Err(Error::Unavailable { field, strategy: self.strategy })
        }
    }

    /// The same on another backend, for tests and measurements.
    #[must_use]
    pub fn with_backend(self, backend: Backend) -> Self {
        Self { backend, ..self }
    }

    /// The same on other threads. A sampler is a few bytes, so every call may have its own:
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

    /// Runs a task on a batch.
    fn travel<T: road::Task<Method = Method>>(&self, inputs: &Inputs<'_>, out: road::Out<'_, T>) -> Counts {
        road::travel::<T>(self.threads, self.backend, self.method(), inputs, out)
    }

    pub(crate) fn method(&self) -> Method {
        Method { strategy: self.strategy, precision: self.precision }
    }

    /// The sampled density.
    #[must_use]
    pub fn strategy(&self) -> Strategy {
        self.strategy
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

    /// Samples a distance for each of the uniform variates `u` in `[0, 1]`.
    ///
    /// `u` and the columns of `samples` have the length of the batch, or k times that: then the k samples of a ray lie
    /// next to each other, those of ray `i` from `k i` on, and share the set-up of the ray's density.
    ///
    /// Variates need not be independent: stratified and low-discrepancy ones are welcome, in a column of one variate per ray
    /// as among the variates of one ray. The inverse is monotone: it maps every interval of `u` to an interval of `t` with the
    /// same probability.
    ///
    /// Outputs are 0 for an empty or invalid ray. A variate outside `[0, 1]` makes its sample invalid. At `u` = 0 and 1 a density
    /// that vanishes there is sampled next to the end.
    ///
    /// # Accuracy
    /// Of [`Precision::Exact`]; `Fast` has [bounds of its own](Precision). Families of inputs are those of
    /// [accuracy](crate::guide::accuracy#families-of-inputs).
    ///
    /// | output | bound | where | test |
    /// |---|---|---|---|
    /// | all | finite, not negative, `t` in `[t_min, t_max]` | any bits | `tests/hard_cases.rs`, `tests/bad_input.rs` |
    /// | `t` | `u` within 2^-20 of the CDFs of the distances that round to `t` | all families | `tests/hard_cases.rs` |
    /// | `t` | `abs(CDF(t) - u)` at most 6e-6 for 99.9 % of rays | family `generic` | `tests/accuracy.rs` |
    /// | `t` | increases with `u`; of two variates closer than 2^-20 the larger may have the smaller `t`, by at most 5e-6 of the CDF | random scenes | `tests/densities.rs` |
    /// | `t` of `EquiAngular` | distance from the nearer end, beyond the rounding of `t`: 8 ulp for 99.99 % of rays, 16 at most | all families | `tests/hard_cases.rs` |
    /// | `t` of `PointNormal` | the same: 8 ulp for 99.9 %, 10 for 99.99 % of rays, 16 at most | all families | `tests/hard_cases.rs` |
    /// | `pdf` | 1e-5, relative, of [`pdf`](Self::pdf) at `t` | where `t` resolves `r` | `tests/densities.rs` |
    /// | `weight` | 2e-5, relative | all families, optical depth up to 30, density at least a thousandth of its mean | `tests/hard_cases.rs` |
    /// | `weight` | its mean over `u` is the radiance | 200 random scenes; all 2^24 variates of some scenes | `tests/statistics.rs`, `tests/all_variates.rs` |
    /// | `r` | 4 ulp | all families | `tests/hard_cases.rs` |
    /// | bits | equal for equal inputs, whatever the place in the batch, its length and the number of threads | [default floating-point environment](Self#floating-point-environment) | `tests/invariance.rs` |
    ///
    /// `r` and `weight` are those of a distance that rounds to `t`, or of a variate within 2^-20 of `u`: next to the emitter `t`
    /// resolves neither. Below a thousandth of the mean density the error of a weight grows as the density falls.
    ///
    /// # Errors
    /// - [`Error::Length`] if a column has another length than `rays.origin[0]`, if the length of `u` is no multiple of that, or
    ///   if the length of an output is not that of `u`;
    /// - [`Error::Empty`] for a table without entries, also with no rays;
    /// - [`Error::Channels`] if the media of a table have different numbers of channels, or if the number of columns of weights
    ///   is not that of the channels;
    /// - [`Error::Value`] for media of an unsupported number of channels.
    ///
    /// Nothing is written then.
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
        match samples.channels() {
            Some(0) => {}
            channels => inputs.check_channels("samples.weights", channels.unwrap_or(0))?,
        }
        const WEIGHTS: [&str; MOST_CHANNELS] =
            ["samples.weights[0]", "samples.weights[1]", "samples.weights[2]", "samples.weights[3]"];
        let mut weights = WEIGHTS.into_iter().zip(samples.weights.iter().flatten());
        weights.try_for_each(|(field, weight)| inputs.check_given(field, weight))?;
        if let Some(r) = &samples.r {
            inputs.check_given("samples.r", r)?;
        }
        Ok(self.travel::<road::Sample>(&inputs, samples.reborrow()))
    }

    /// The density at given distances `t`, for multiple importance sampling \[1/m\]; 0 outside the sampled interval.
    ///
    /// It is the density of what [`sample`](Self::sample) returns, at `t` as rounded. Next to the emitter, where `t` does not
    /// resolve `r`, the density that `sample` returns is the exact one.
    ///
    /// [`Counts::sampled`] counts the rays that have a sample, whether or not it could be at `t`. A NaN in `t` makes
    /// its ray invalid. A density below f32's range is 0.
    ///
    /// # Accuracy
    /// Error at the given `t` in ulp, of [`Precision::Exact`]; `Fast` has [bounds of its own](Precision). A density below a
    /// thousandth of its mean `1/(t_b - t_a)` over the sampled interval has its error in ulp of that thousandth.
    ///
    /// | densities | family of inputs | 99 % of rays | 99.99 % | test |
    /// |---|---|---|---|---|
    /// | all | all but what follows | 8 | 64 | `tests/hard_cases.rs` |
    /// | all | `generic` | 8 | 64; 1e-3, relative, at most | `tests/accuracy.rs` |
    /// | product densities | `variate`: at the ends of the interval, where they may vanish | 14 | 128 | `tests/hard_cases.rs` |
    /// | product densities | `spot`: the falloff at a knot has ten roundings more | 10 | 64 | `tests/hard_cases.rs` |
    /// | `Product3` | `near-emitter` | 9 | 64 | `tests/hard_cases.rs` |
    /// | `Product3` | `peaks`: `1 - abs(g)` from 2^-24 to 1e-3, next to an emitter | 17 | 96 | `tests/hard_cases.rs` |
    /// | product densities | `random-bits` | 10 | none | `tests/hard_cases.rs` |
    /// | other densities | `random-bits` | 8 | none | `tests/hard_cases.rs` |
    ///
    /// The integral of the density is 1 (`tests/densities.rs`). On `peaks` the set-up in f32 is the limit: where the line of
    /// three knots falls from a peak to almost nothing, its value multiplies the roundings of the set-up. Geometry that is
    /// rounded to f32 alone would leave 2 ulp.
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

    /// The distribution function (CDF) at given distances `t` \[1\]: the probability that [`sample`](Self::sample) returns less,
    /// 0 before the sampled interval and 1 beyond it.
    ///
    /// It is the inverse of `sample`, from `t` back to `u`, which pbrt calls `Invert`: for bidirectional and
    /// primary-sample-space methods. The output is 0 for an empty or invalid ray. A NaN in `t` makes its ray invalid.
    ///
    /// # Accuracy
    ///
    /// | precision | absolute error at the given `t` | where | test |
    /// |---|---|---|---|
    /// | [`Precision::Exact`] | 2^-20 at most, beyond the change of the CDF when distances change by 2^-44 of themselves (matters at optical depths above 1e7; 2^-41 for a direction whose length is 1e-6 off) | all families | `tests/hard_cases.rs`, `tests/cdf.rs` |
    /// | [`Precision::Fast`] | 8e-6 for 99.9 % of rays | [ordinary scenes](Precision), `variate`, `short-intervals`, `spot` | `tests/hard_cases.rs` |
    /// | [`Precision::Fast`] | 2e-3 for 99.9 % of rays | `near-emitter`, `peaks`, `colour` | `tests/hard_cases.rs` |
    /// | [`Precision::Fast`] | 1e-3 for 99.9 % of rays | `infinite-rays` | `tests/hard_cases.rs` |
    /// | [`Precision::Fast`] | 1e-4 for 99.9 % of rays | `random-bits` | `tests/hard_cases.rs` |
    /// | [`Precision::Fast`] | 5e-3 for 99.9 % of rays | product densities on `medium` | `tests/hard_cases.rs` |
    /// | [`Precision::Fast`] | none | `cosine`; product densities on `random-bits` | |
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
    /// `[t_min, t_max]`, and at most `f32::MAX`.
    ///
    /// # Accuracy
    /// Of [`Precision::Exact`], up to an optical depth of 30; `Fast` has no bound. Where `N` is below 1e-3, errors are relative to
    /// `N` = 1e-3.
    ///
    /// | error at the given `t` | where | test |
    /// |---|---|---|
    /// | 48 ulp at most | all families, the emitter at least 1e-7 of its distance off the ray's line | `tests/hard_cases.rs` |
    /// | 32 ulp for 99.9 % of rays, 4096 at most | families `near-emitter`, `spot` and `colour`, the emitter nearer to the line | `tests/hard_cases.rs` |
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
        self.evaluate_coloured(rays, emitters, media, t, [integrand])
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
        let inputs = Inputs::new(rays, emitters, media)?.with(t, "t")?;
        inputs.check_channels("integrand", C)?;
        integrands.iter().try_for_each(|integrand| inputs.check_given("integrand", integrand))?;
        Ok(self.travel::<road::Evaluate>(&inputs, columns(integrands)))
    }

    /// Runs [`sample`](Self::sample) up to a stage, to time it; nothing is written.
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

    /// [`sample`](Self::sample) for one ray; `None` if the ray has no sample, or `u` is not in `[0, 1]`. In a coloured medium the
    /// weight is that of the [mean](Medium::mean).
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

    /// [`evaluate`](Self::evaluate) for one ray; in a coloured medium the integrand of the [mean](Medium::mean).
    #[must_use]
    pub fn evaluate_one(&self, ray: &Ray, emitter: &Emitter, medium: &Medium, t: f32) -> f32 {
        let mut integrand = 0.0;
        self.one::<road::Evaluate>(ray, emitter, medium, t, columns([from_mut(&mut integrand)]));
        integrand
    }

    /// Runs a task on one ray.
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
