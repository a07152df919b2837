//! Where samples are written.

use super::{Column, OfRuns, Outputs, Pad, Run};
use crate::simd::MOST_LANES;
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
    pub weight: Option<&'a mut [f32]>,
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
        Self { t, pdf, weight: None, r: None }
    }

    /// Weights as well.
    #[must_use]
    pub fn weight(self, weight: &'a mut [f32]) -> Self {
        Self { weight: Some(weight), ..self }
    }

    /// Distances to the emitters as well.
    #[must_use]
    pub fn r(self, r: &'a mut [f32]) -> Self {
        Self { r: Some(r), ..self }
    }

    /// The same columns, borrowed.
    pub(crate) fn reborrow(&mut self) -> Samples<'_> {
        Samples { t: self.t, pdf: self.pdf, weight: self.weight.as_deref_mut(), r: self.r.as_deref_mut() }
    }
}

/// Those of [`Samples`].
pub(crate) struct OfSamples;

impl Outputs for OfSamples {
    type At<'a> = Samples<'a>;

    fn split_at<'a>(out: Self::At<'a>, k: usize) -> (Self::At<'a>, Self::At<'a>) {
        let (t, t_rest) = out.t.split_at_mut(k);
        let (pdf, pdf_rest) = out.pdf.split_at_mut(k);
        let (weight, weight_rest) = out.weight.map(|column| column.split_at_mut(k)).unzip();
        let (r, r_rest) = out.r.map(|column| column.split_at_mut(k)).unzip();
        (Samples { t, pdf, weight, r }, Samples { t: t_rest, pdf: pdf_rest, weight: weight_rest, r: r_rest })
    }

    fn part<'b>(out: &'b mut Samples<'_>, range: Range<usize>) -> Samples<'b> {
        Samples {
            t: &mut out.t[range.clone()],
            pdf: &mut out.pdf[range.clone()],
            weight: out.weight.as_mut().map(|column| &mut column[range.clone()]),
            r: out.r.as_mut().map(|column| &mut column[range]),
        }
    }

    fn by_pads<R>(out: Samples<'_>, write: impl FnOnce(Samples<'_>) -> R) -> R {
        let Samples { t, pdf, weight, r } = out;
        Column::by_pads(t, |t| {
            Column::by_pads(pdf, |pdf| {
                let (mut weight_pad, mut r_pad): (Pad, Pad) = ([0.0; MOST_LANES], [0.0; MOST_LANES]);
                let result = write(Samples {
                    t,
                    pdf,
                    weight: weight.as_ref().map(|_| &mut weight_pad[..]),
                    r: r.as_ref().map(|_| &mut r_pad[..]),
                });
                for (column, pad) in [(weight, weight_pad), (r, r_pad)] {
                    if let Some(column) = column {
                        column.copy_from_slice(&pad[..column.len()]);
                    }
                }
                result
            })
        })
    }
}

impl OfRuns for OfSamples {
    fn of_run<R>(out: &mut Samples<'_>, run: Run<'_>, write: impl FnOnce(Samples<'_>) -> R) -> R {
        if let Some(range) = run.together() {
            return write(Self::part(out, range));
        }
        let Samples { t, pdf, weight, r } = out;
        run.scatter(t, |t| {
            run.scatter(pdf, |pdf| {
                optional(run, weight, |weight| optional(run, r, |r| write(Samples { t, pdf, weight, r })))
            })
        })
    }
}

/// The values of a run of a column, if there is one.
fn optional<R>(run: Run<'_>, column: &mut Option<&mut [f32]>, write: impl FnOnce(Option<&mut [f32]>) -> R) -> R {
    match column {
        Some(column) => run.scatter(column, |column| write(Some(column))),
        None => write(None),
    }
}
