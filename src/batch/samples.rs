//! The output columns of samples.

use super::{Column, Columns, OfRuns, Outputs, Run, columns};
use crate::scene::MOST_CHANNELS;
use core::ops::Range;

/// The output columns of a batch of samples. Every column has the length of the variates: that of the batch or a multiple of
/// it, the samples of one ray next to each other.
///
/// Only [`Samples::new`] makes samples, so that later versions can add columns.
#[derive(Debug)]
#[non_exhaustive]
pub struct Samples<'a> {
    /// Distances along the rays, in `[t_min, t_max]`, 0 where there is no sample \[m\].
    pub t: &'a mut [f32],
    /// Probability densities over distance \[1/m\]; a density below f32's range is 0.
    pub pdf: &'a mut [f32],
    /// `mu_s T rho N / (r^2 pdf)`: the one-sample estimate of the ray's single-scattered radiance per unit of the
    /// emitter's intensity \[1/m^2\], with `1/r^2` cancelled analytically and `T` counted from `t_min`.
    ///
    /// `T` assumes that the whole leg from the sample to the emitter lies in the medium. If a length `outside` \[m\] of it does
    /// not, as with a lamp outside the fog, `weight * exp(mu_t * outside)` is the unbiased estimate. A transmittance below
    /// f32's range, at an optical depth above 87, makes the weight 0, which this factor cannot correct.
    ///
    /// There are no columns, or one for each channel of the medium, from the first on.
    pub weights: [Option<&'a mut [f32]>; MOST_CHANNELS],
    /// Distances from the samples to the emitters \[m\], exact also where `t` alone cannot resolve them.
    pub r: Option<&'a mut [f32]>,
}

impl<'a> Samples<'a> {
    /// Distances and densities.
    ///
    /// ```
    /// # use airlight::Samples;
    /// let [mut t, mut pdf, mut weight, mut r] = [[0.0; 8]; 4];
    /// let samples = Samples::new(&mut t, &mut pdf).weight(&mut weight).r(&mut r);
    /// ```
    #[must_use]
    pub fn new(t: &'a mut [f32], pdf: &'a mut [f32]) -> Self {
        Self { t, pdf, weights: columns([]), r: None }
    }

    /// Adds weights of a grey medium.
    #[must_use]
    pub fn weight(self, weight: &'a mut [f32]) -> Self {
        self.weights([weight])
    }

    /// Adds weights of a coloured medium, a column for each of its channels, which are at most 4.
    ///
    /// ```
    /// # use airlight::Samples;
    /// let [mut t, mut pdf, mut red, mut green, mut blue] = [[0.0; 8]; 5];
    /// let samples = Samples::new(&mut t, &mut pdf).weights([&mut red, &mut green, &mut blue]);
    /// ```
    #[must_use]
    pub fn weights<const C: usize>(self, weights: [&'a mut [f32]; C]) -> Self {
        const { assert!(C <= MOST_CHANNELS, "no medium has more channels") };
        Self { weights: columns(weights), ..self }
    }

    /// Adds distances to the emitters.
    #[must_use]
    pub fn r(self, r: &'a mut [f32]) -> Self {
        Self { r: Some(r), ..self }
    }

    /// The number of columns of weights, if the first ones are those that are there.
    pub(crate) fn channels(&self) -> Option<usize> {
        let first = self.weights.iter().take_while(|weight| weight.is_some()).count();
        (self.weights.iter().flatten().count() == first).then_some(first)
    }

    /// The same columns, borrowed.
    pub(crate) fn reborrow(&mut self) -> Samples<'_> {
        let weights = self.weights.each_mut().map(Option::as_deref_mut);
        Samples { t: self.t, pdf: self.pdf, weights, r: self.r.as_deref_mut() }
    }

    /// The columns that are always there, and the optional ones.
    fn parts(self) -> ([&'a mut [f32]; 2], Optional<'a>) {
        let [w_0, w_1, w_2, w_3] = self.weights;
        ([self.t, self.pdf], [w_0, w_1, w_2, w_3, self.r])
    }

    fn of([t, pdf]: [&'a mut [f32]; 2], [w_0, w_1, w_2, w_3, r]: Optional<'a>) -> Self {
        Self { t, pdf, weights: [w_0, w_1, w_2, w_3], r }
    }
}

/// Weights and `r`.
type Optional<'a> = [Option<&'a mut [f32]>; MOST_CHANNELS + 1];

/// The outputs of [`Samples`].
pub(crate) struct OfSamples;

impl Outputs for OfSamples {
    type At<'a> = Samples<'a>;

    fn split_at<'a>(out: Self::At<'a>, k: usize) -> (Self::At<'a>, Self::At<'a>) {
        let ([t, pdf], optional) = out.parts();
        let ((t, t_rest), (pdf, pdf_rest)) = (t.split_at_mut(k), pdf.split_at_mut(k));
        let (optional, optional_rest) = Columns::split_at(optional, k);
        (Samples::of([t, pdf], optional), Samples::of([t_rest, pdf_rest], optional_rest))
    }

    fn part<'b>(out: &'b mut Samples<'_>, range: Range<usize>) -> Samples<'b> {
        let ([t, pdf], optional) = out.reborrow().parts();
        let optional = optional.map(|column| column.map(|column| &mut column[range.clone()]));
        Samples::of([&mut t[range.clone()], &mut pdf[range]], optional)
    }

    fn by_pads<R>(out: Samples<'_>, write: impl FnOnce(Samples<'_>) -> R) -> R {
        let ([t, pdf], optional) = out.parts();
        Column::by_pads(t, |t| {
            Column::by_pads(pdf, |pdf| Columns::by_pads(optional, |optional| write(Samples::of([t, pdf], optional))))
        })
    }
}

impl OfRuns for OfSamples {
    fn of_run<R>(out: &mut Samples<'_>, run: Run<'_>, write: impl FnOnce(Samples<'_>) -> R) -> R {
        if let Some(range) = run.together() {
            return write(Self::part(out, range));
        }
        let ([t, pdf], mut optional) = out.reborrow().parts();
        run.scatter(t, |t| {
            run.scatter(pdf, |pdf| {
                Columns::of_run(&mut optional, run, |optional| write(Samples::of([t, pdf], optional)))
            })
        })
    }
}
