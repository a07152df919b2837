//! Where samples are written.

use super::{Column, Columns, OfRuns, Outputs, Run, columns};
use crate::scene::MOST_CHANNELS;
use core::ops::Range;

/// Where a batch of samples is written; every column has the length of the variates: that of the batch, or a multiple of
/// it, the samples of one ray next to each other.
///
/// Made by [`Samples::new`] alone, so that samples can get more columns without breaking a caller.
#[derive(Debug)]
#[non_exhaustive]
pub struct Samples<'a> {
    /// Distances along the rays, in `[t_min, t_max]`, 0 where there is no sample \[m\].
    pub t: &'a mut [f32],
    /// Probability densities over distance \[1/m\]; one below f32's range is 0.
    pub pdf: &'a mut [f32],
    /// `mu_s T rho N / (r^2 pdf)`: the one-sample estimate of the ray's single-scattered radiance per unit of the
    /// emitter's intensity \[1/m^2\], with `1/r^2` cancelled analytically and `T` counted from `t_min`.
    ///
    /// `T` takes the whole leg from the sample to the emitter to lie in the medium. If the length `outside` \[m\] of it does
    /// not, as with a lamp outside the fog, `weight * exp(mu_t * outside)` is the unbiased estimate. A transmittance below
    /// f32's range, at an optical depth above 87, makes the weight 0: there is nothing to correct then.
    ///
    /// None, or one for each channel of the medium, from the first on.
    pub weights: [Option<&'a mut [f32]>; MOST_CHANNELS],
    /// Distances from the samples to the emitters \[m\], exact also where `t` alone cannot resolve them.
    pub r: Option<&'a mut [f32]>,
}

impl<'a> Samples<'a> {
    /// Distances and their densities, and nothing else.
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

    /// Weights as well, of a grey medium.
    #[must_use]
    pub fn weight(self, weight: &'a mut [f32]) -> Self {
        self.weights([weight])
    }

    /// Weights as well, a column for each channel of a coloured medium; columns beyond the fourth are not written.
    ///
    /// ```
    /// # use airlight::Samples;
    /// let [mut t, mut pdf, mut red, mut green, mut blue] = [[0.0; 8]; 5];
    /// let samples = Samples::new(&mut t, &mut pdf).weights([&mut red, &mut green, &mut blue]);
    /// ```
    #[must_use]
    pub fn weights<const C: usize>(self, weights: [&'a mut [f32]; C]) -> Self {
        Self { weights: columns(weights), ..self }
    }

    /// Distances to the emitters as well.
    #[must_use]
    pub fn r(self, r: &'a mut [f32]) -> Self {
        Self { r: Some(r), ..self }
    }

    /// How many columns of weights there are.
    pub(crate) fn channels(&self) -> usize {
        self.weights.iter().flatten().count()
    }

    /// The same columns, borrowed.
    pub(crate) fn reborrow(&mut self) -> Samples<'_> {
        let weights = self.weights.each_mut().map(Option::as_deref_mut);
        Samples { t: self.t, pdf: self.pdf, weights, r: self.r.as_deref_mut() }
    }

    /// The columns that are there always, and those that may be wanted.
    fn columns(self) -> ([&'a mut [f32]; 2], Optional<'a>) {
        let [w_0, w_1, w_2, w_3] = self.weights;
        ([self.t, self.pdf], [w_0, w_1, w_2, w_3, self.r])
    }

    fn of([t, pdf]: [&'a mut [f32]; 2], [w_0, w_1, w_2, w_3, r]: Optional<'a>) -> Self {
        Self { t, pdf, weights: [w_0, w_1, w_2, w_3], r }
    }
}

/// Weights and `r`.
type Optional<'a> = [Option<&'a mut [f32]>; MOST_CHANNELS + 1];

/// Those of [`Samples`].
pub(crate) struct OfSamples;

impl Outputs for OfSamples {
    type At<'a> = Samples<'a>;

    fn split_at<'a>(out: Self::At<'a>, k: usize) -> (Self::At<'a>, Self::At<'a>) {
        let ([t, pdf], optional) = out.columns();
        let ((t, t_rest), (pdf, pdf_rest)) = (t.split_at_mut(k), pdf.split_at_mut(k));
        let (optional, optional_rest) = Columns::split_at(optional, k);
        (Samples::of([t, pdf], optional), Samples::of([t_rest, pdf_rest], optional_rest))
    }

    fn part<'b>(out: &'b mut Samples<'_>, range: Range<usize>) -> Samples<'b> {
        let ([t, pdf], optional) = out.reborrow().columns();
        let optional = optional.map(|column| column.map(|column| &mut column[range.clone()]));
        Samples::of([&mut t[range.clone()], &mut pdf[range]], optional)
    }

    fn by_pads<R>(out: Samples<'_>, write: impl FnOnce(Samples<'_>) -> R) -> R {
        let ([t, pdf], optional) = out.columns();
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
        let ([t, pdf], mut optional) = out.reborrow().columns();
        run.scatter(t, |t| {
            run.scatter(pdf, |pdf| {
                Columns::of_run(&mut optional, run, |optional| write(Samples::of([t, pdf], optional)))
            })
        })
    }
}
