//! The oracle's word on a subset of a wavefront's rays.

use crate::strata::Strata;
use crate::wavefront::Wavefront;
use airlight::oracle::Coloured;
use airlight::{Medium, Strategy};
use airlight_tools::variates;
use rayon::prelude::*;

/// Relative size of a difference that f32 weights cannot resolve, however many of them are averaged. Nor can they hold
/// what is below `f32::MIN_POSITIVE`.
const RESOLUTION: f64 = 4.0 * f32::EPSILON as f64;

/// A subset of rays with their scenes in f64.
#[derive(Debug)]
pub(crate) struct Check {
    /// The rays, in ascending order.
    pub(crate) rays: Vec<usize>,
    /// Their scenes and radiances by quadrature, in every channel.
    scenes: Vec<(Coloured, Vec<f64>)>,
}

/// A strategy's estimate beside the quadrature.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Comparison {
    /// The mean over the subset of each ray's mean weight.
    pub(crate) estimate: f64,
    /// Its standard error, from the variances that the oracle foretells.
    pub(crate) stderr: f64,
    /// The mean of the radiances.
    pub(crate) quadrature: f64,
}

impl Comparison {
    /// By how many standard errors the estimate is above the quadrature; none where there is no light, or less than f32
    /// can hold, in either.
    pub(crate) fn z(&self) -> Option<f64> {
        let least = f64::from(f32::MIN_POSITIVE);
        let difference = self.estimate - self.quadrature;
        (self.estimate > 0.0 || self.quadrature >= least)
            .then(|| difference / self.stderr.hypot(RESOLUTION * self.quadrature + least))
    }
}

impl Check {
    /// `count` of the rays `valid`, the same for every seed.
    pub(crate) fn new(wavefront: &Wavefront, medium: &Medium, valid: &[usize], count: usize) -> Self {
        let drawn = spread(valid.len(), count.min(valid.len()), 0);
        let scene = |i: usize| {
            let (ray, emitter) = wavefront.ray(valid[i]).ok()?;
            let scene = Coloured::new(&ray, &emitter, medium);
            let radiances = scene.radiance();
            Some((valid[i], (scene, radiances)))
        };
        let (rays, scenes) = drawn.into_par_iter().filter_map(scene).unzip();
        Self { rays, scenes }
    }

    /// What `strategy` made of the subset in every channel, of which there are strata; none if it is empty.
    pub(crate) fn compare(&self, strategy: Strategy, strata: &[Strata]) -> Vec<Option<Comparison>> {
        let count = self.rays.len() as f64;
        // By quadrature: a weight with a heavy tail hides its variance from its own samples. Collected before they are summed:
        // the order must not depend on the threads.
        let variances: Vec<_> = self.scenes.par_iter().map(|(scene, _)| scene.relative_variance(strategy)).collect();
        let of_channel = |(c, strata): (usize, &Strata)| {
            let radiance = |i: usize| self.scenes[i].1[c];
            let quadrature = (0..self.rays.len()).map(radiance).sum::<f64>() / count;
            let of_mean = |(i, variances): (usize, &Option<Vec<f64>>)| {
                Some(variances.as_ref()?[c] * radiance(i) * radiance(i) / strata.samples(self.rays[i]))
            };
            // The sum of no numbers is -0.
            let stderr = (0.0 + variances.iter().enumerate().filter_map(of_mean).sum::<f64>()).sqrt() / count;
            Some(Comparison { estimate: strata.of(&self.rays).mean?, stderr, quadrature })
        };
        strata.iter().enumerate().map(of_channel).collect()
    }

    /// `|CDF(t) - u|` of the rays that have a sample, in ascending order.
    pub(crate) fn cdf_errors(&self, strategy: Strategy, u: &[f32], t: &[f32], pdf: &[f32]) -> Vec<f64> {
        let error = |(&i, (scene, _)): (&usize, &(Coloured, Vec<f64>))| {
            (pdf[i] > 0.0).then(|| (scene.cdf(strategy, f64::from(t[i])) - f64::from(u[i])).abs())
        };
        let mut errors: Vec<f64> = self.rays.par_iter().zip(&self.scenes).filter_map(error).collect();
        errors.sort_by(f64::total_cmp);
        errors
    }
}

/// One of each of `count` equal stretches of the numbers below `end`. Which one is drawn by lot: every k-th would be a
/// few columns of the image.
pub(crate) fn spread(end: usize, count: usize, seed: u64) -> Vec<usize> {
    let mut lots = vec![0.0; count];
    variates::fill(seed, 0, &mut lots);
    let stretch = |i| i * end / count..(i + 1) * end / count;
    lots.iter()
        .enumerate()
        .map(|(i, lot)| stretch(i).start + (f64::from(*lot) * stretch(i).len() as f64) as usize)
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_subset_is_spread_and_distinct() {
        for (end, count) in [(65536, 256), (1000, 7), (1000, 999), (5, 5), (5, 0)] {
            let rays = spread(end, count, 0);
            assert_eq!(rays.len(), count);
            assert!(rays.iter().enumerate().all(|(i, ray)| (i * end / count..(i + 1) * end / count).contains(ray)));
        }
        let columns: std::collections::HashSet<_> = spread(65536, 256, 0).iter().map(|ray| ray % 256).collect();
        assert!(columns.len() > 128, "{} of 256 columns", columns.len());
    }

    #[test]
    fn z_counts_standard_errors_and_not_the_rounding_of_f32() {
        let z = |estimate, stderr| Comparison { estimate, stderr, quadrature: 2.0 }.z().unwrap();
        assert!((z(2.3, 0.1) - 3.0).abs() < 1e-6);
        assert!(z(2.0 + 2e-7, 0.0) < 1.0);
        assert_eq!(z(2.0, 0.0), 0.0);
    }

    #[test]
    fn nothing_beside_nothing_has_no_z() {
        let z = |estimate, quadrature| Comparison { estimate, stderr: 0.0, quadrature }.z();
        assert_eq!((z(0.0, 0.0), z(0.0, 1e-39)), (None, None));
        assert!(z(0.0, 1e-30).unwrap() < -1e3);
        assert!(z(1e-30, 0.0).unwrap() > 1e3);
    }
}
