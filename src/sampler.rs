//! The public face: sample, pdf and evaluate, for a batch or for one ray.

use crate::batch::{Counts, Emitters, Inputs, Media, Rays, Samples};
use crate::road::Method;
use crate::scene::{Emitter, Medium, Ray};
use crate::simd::Backend;
use crate::{Error, Precision, Strategy, road};
use core::slice::{from_mut, from_ref};

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
    /// A sampler of `strategy`, as exact as there is, on the widest backend of this machine.
    #[must_use]
    pub fn new(strategy: Strategy) -> Self {
        Self { strategy, precision: Precision::default(), backend: Backend::detect() }
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
            Err(Error::Unavailable { field, strategy: self.strategy })
        }
    }

    /// The same on another backend, for tests and measurements.
    #[must_use]
    pub fn with_backend(self, backend: Backend) -> Self {
        Self { backend, ..self }
    }

    pub(crate) fn method(&self) -> Method {
        Method { strategy: self.strategy, precision: self.precision }
    }

    /// The columns of a call.
    pub(crate) fn inputs<'a>(
        &self,
        rays: &Rays<'a>,
        emitters: &Emitters<'a>,
        media: &Media<'a>,
    ) -> Result<Inputs<'a>, Error> {
        check_known(self.strategy, emitters, media)?;
        Inputs::new(rays, emitters, media)
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

    /// Draws a distance for each of the uniform variates `u` in `[0, 1]`.
    ///
    /// `u` and the columns of `samples` have the length of the batch, or k times that: then the k samples of a ray lie
    /// next to each other, those of ray `i` from `k i` on, and share the set-up of the ray's density.
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
    /// an output another one than `u`. [`Error::Unavailable`] for spots and coloured media, which have no kernel yet. Nothing
    /// is written then.
    pub fn sample(
        &self,
        rays: &Rays<'_>,
        emitters: &Emitters<'_>,
        media: &Media<'_>,
        u: &[f32],
        samples: &mut Samples<'_>,
    ) -> Result<Counts, Error> {
        let inputs = self.inputs(rays, emitters, media)?.with(u, "u")?;
        inputs.check_given("samples.t", samples.t)?;
        inputs.check_given("samples.pdf", samples.pdf)?;
        if let Some(weight) = &samples.weight {
            inputs.check_given("samples.weight", weight)?;
        }
        if let Some(r) = &samples.r {
            inputs.check_given("samples.r", r)?;
        }
        let out = Samples {
            t: samples.t,
            pdf: samples.pdf,
            weight: samples.weight.as_deref_mut(),
            r: samples.r.as_deref_mut(),
        };
        Ok(road::travel::<road::Sample>(self.backend, self.method(), &inputs, out))
    }

    /// An estimate of each ray's single-scattered radiance per unit of the emitter's intensity \[1/m^2\], without a
    /// sample: what the product density has for the integral of the integrand. For choosing between emitters, or guiding.
    ///
    /// Relative error against quadrature, for half of the rays and for 99 %; the families are those of `airlight accuracy`:
    ///
    /// | family | 3 knots | 5 | 9 | 17 |
    /// |---|---|---|---|---|
    /// | `generic`: a box of side 10, `mu_t` 0.7, `g` 0 and 0.9 | 5 %, 22 % | 0.2 %, 1.2 % | 0.02 %, 0.2 % | 0.002 %, 0.013 % |
    /// | `near-emitter`: the emitter on the ray or next to it | 2.5 %, 17 % | 0.15 %, 1.8 % | 0.012 %, 0.36 % | 0.0024 %, 0.16 % |
    /// | `infinite-rays` | 5.5 %, 35 % | 0.65 %, 2.8 % | 0.12 %, 0.65 % | 0.008 %, 0.3 % |
    /// | `cosine`: ends at and next to the dark side | 0.35 %, 32 % | 0.045 %, 2.3 % | 0.009 %, 0.37 % | 0.002 %, 0.1 % |
    /// | `phase`: `g` from -1 to 1 | 5.5 %, 23 % | 0.2 %, 1.25 % | 0.021 %, 0.27 % | 0.0017 %, 0.013 % |
    /// | `peaks`: `1 - abs(g)` from 2^-24 to 1e-3, next to an emitter | 2.8 %, 34 % | 0.17 %, 2.2 % | 0.017 %, 0.53 % | 0.002 %, 0.22 % |
    /// | `medium`: `mu_t` from 0 to 1e4 per m | 1.6 %, 30 % | 0.15 %, 2.3 % | 0.014 %, 0.5 % | 0.002 %, 0.22 % |
    ///
    /// No ray of them, 8192 each under two seeds, is off by more than 50 %, 4.2 %, 2 % and 0.9 %. Emitters far away and
    /// short intervals have errors of rounding, below 0.03 %, 0.003 % and 0.0005 % for 99 %. At `abs(g)` = 1 the phase
    /// function is 0 beside its peak, and so is the estimate. It is 0 too where the transmittance to the start of the lit
    /// part is below f32's range, and has few digits where that is below 1e-30.
    ///
    /// # Errors
    /// As [`sample`](Self::sample), and [`Error::Unavailable`] unless [`Strategy::has_radiance`].
    pub fn radiance(
        &self,
        rays: &Rays<'_>,
        emitters: &Emitters<'_>,
        media: &Media<'_>,
        radiance: &mut [f32],
    ) -> Result<Counts, Error> {
        if !self.strategy.has_radiance() {
            return Err(Error::Unavailable { field: "radiance", strategy: self.strategy });
        }
        let inputs = self.inputs(rays, emitters, media)?;
        inputs.check("radiance", radiance)?;
        Ok(road::travel::<road::Radiance>(self.backend, self.method(), &inputs, radiance))
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
        let inputs = self.inputs(rays, emitters, media)?.with(t, "t")?;
        inputs.check_given("pdf", pdf)?;
        Ok(road::travel::<road::Pdf>(self.backend, self.method(), &inputs, pdf))
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
        let inputs = self.inputs(rays, emitters, media)?.with(t, "t")?;
        inputs.check_given("integrand", integrand)?;
        Ok(road::travel::<road::Evaluate>(self.backend, self.method(), &inputs, integrand))
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
        let inputs = self.inputs(rays, emitters, media)?.with(u, "u")?;
        road::travel::<road::stages::UpTo>(self.backend, self.method(), &inputs, stage);
        Ok(())
    }

    /// [`sample`](Self::sample) for one ray; `None` if it has no sample, or `u` is not in `[0, 1]`, or `sample` has no kernel
    /// for the emitter or the medium.
    #[must_use]
    pub fn sample_one(&self, ray: &Ray, emitter: &Emitter, medium: &Medium, u: f32) -> Option<Sample> {
        let [mut t, mut pdf, mut weight, mut r] = [0.0; 4];
        let out = Samples {
            t: from_mut(&mut t),
            pdf: from_mut(&mut pdf),
            weight: Some(from_mut(&mut weight)),
            r: Some(from_mut(&mut r)),
        };
        let counts = one::<road::Sample>(self.backend, self.method(), ray, emitter, medium, u, out);
        (counts.sampled == 1).then_some(Sample { t, pdf, weight, r })
    }

    /// [`pdf`](Self::pdf) for one ray; 0 if there is no kernel for the emitter or the medium.
    #[must_use]
    pub fn pdf_one(&self, ray: &Ray, emitter: &Emitter, medium: &Medium, t: f32) -> f32 {
        let mut pdf = 0.0;
        one::<road::Pdf>(self.backend, self.method(), ray, emitter, medium, t, from_mut(&mut pdf));
        pdf
    }

    /// [`evaluate`](Self::evaluate) for one ray; 0 if there is no kernel for the emitter or the medium.
    #[must_use]
    pub fn evaluate_one(&self, ray: &Ray, emitter: &Emitter, medium: &Medium, t: f32) -> f32 {
        let mut integrand = 0.0;
        one::<road::Evaluate>(self.backend, self.method(), ray, emitter, medium, t, from_mut(&mut integrand));
        integrand
    }
}

/// `Ok` unless there is a spot or a coloured medium: the kernels know neither.
fn check_known(strategy: Strategy, emitters: &Emitters<'_>, media: &Media<'_>) -> Result<(), Error> {
    let unavailable = |field| Err(Error::Unavailable { field, strategy });
    match (emitters, media) {
        (Emitters::One(emitter), _) if emitter.cone().is_some() => unavailable("spots"),
        (_, Media::One(medium)) if medium.channels() > 1 => unavailable("coloured media"),
        _ => Ok(()),
    }
}

/// A batch of one ray.
fn one<T: road::Task>(
    backend: Backend,
    method: Method,
    ray: &Ray,
    emitter: &Emitter,
    medium: &Medium,
    given: f32,
    out: road::Out<'_, T>,
) -> Counts {
    if check_known(method.strategy, &Emitters::One(*emitter), &Media::One(*medium)).is_err() {
        return Counts::default();
    }
    let (origin, direction) = (ray.origin().to_array(), ray.direction().to_array());
    let (t_min, t_max) = (ray.t_min(), ray.t_max());
    let rays = Rays {
        origin: [0, 1, 2].map(|k| from_ref(&origin[k])),
        direction: [0, 1, 2].map(|k| from_ref(&direction[k])),
        t_min: from_ref(&t_min),
        t_max: from_ref(&t_max),
    };
    let inputs = Inputs::one(rays, *emitter, *medium, from_ref(&given));
    road::travel::<T>(backend, method, &inputs, out)
}
