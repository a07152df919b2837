//! The oracle's word on a subset of a wavefront's rays.

use crate::strata::Estimate;
use crate::variates;
use crate::wavefront::Wavefront;
use airlight::oracle::Scene;
use airlight::{Medium, Strategy};
use rayon::prelude::*;

/// Relative size of a difference that f32 weights cannot resolve, however many of them are averaged.
const RESOLUTION: f64 = 4.0 * f32::EPSILON as f64;

/// A subset of rays with their scenes in f64.
#[derive(Debug)]
pub(crate) struct Check {
    /// The rays, in ascending order.
    pub(crate) rays: Vec<usize>,
    /// Their scenes; none for an invalid ray.
    scenes: Vec<Option<Scene>>,
    /// The mean of their radiances by quadrature; none if there are no rays.
    pub(crate) quadrature: Option<f64>,
}

impl Check {
    /// `count` of the first `reached` rays, the same for every seed.
    pub(crate) fn new(wavefront: &Wavefront, medium: &Medium, reached: usize, count: usize) -> Self {
        let rays = spread(reached, count.min(reached));
        let scene = |&i: &usize| Some(Scene::new(&wavefront.ray(i).ok()?, &wavefront.emitter(i).ok()?, medium));
        let scenes: Vec<_> = rays.par_iter().map(scene).collect();
        let radiances: Vec<f64> = scenes.par_iter().map(|scene| scene.as_ref().map_or(0.0, Scene::radiance)).collect();
        let quadrature = (!rays.is_empty()).then(|| radiances.iter().sum::<f64>() / rays.len() as f64);
        Self { rays, scenes, quadrature }
    }

    /// By how many standard errors `estimate` is above the quadrature.
    pub(crate) fn z(&self, estimate: &Estimate) -> Option<f64> {
        let quadrature = self.quadrature?;
        let difference = estimate.mean? - quadrature;
        let scale = estimate.stderr?.hypot(RESOLUTION * quadrature);
        Some(if difference == 0.0 { 0.0 } else { difference / scale })
    }

    /// `|CDF(t) - u|` of the rays that have a sample, in ascending order.
    pub(crate) fn cdf_errors(&self, strategy: Strategy, u: &[f32], t: &[f32], pdf: &[f32]) -> Vec<f64> {
        let error = |(&i, scene): (&usize, &Option<Scene>)| {
            let scene = scene.as_ref().filter(|_| pdf[i] > 0.0)?;
            Some((scene.cdf(strategy, f64::from(t[i])) - f64::from(u[i])).abs())
        };
        let mut errors: Vec<f64> = self.rays.par_iter().zip(&self.scenes).filter_map(error).collect();
        errors.sort_by(f64::total_cmp);
        errors
    }
}

/// One of each of `count` equal stretches of the numbers below `end`. Which one is drawn by lot: every k-th would be a
/// few columns of the image.
fn spread(end: usize, count: usize) -> Vec<usize> {
    let mut lots = vec![0.0; count];
    variates::fill(0, 0, &mut lots);
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
            let rays = spread(end, count);
            assert_eq!(rays.len(), count);
            assert!(rays.iter().enumerate().all(|(i, ray)| (i * end / count..(i + 1) * end / count).contains(ray)));
        }
        let columns: std::collections::HashSet<_> = spread(65536, 256).iter().map(|ray| ray % 256).collect();
        assert!(columns.len() > 128, "{} of 256 columns", columns.len());
    }

    #[test]
    fn z_counts_standard_errors_and_not_the_rounding_of_f32() {
        let check = Check { rays: vec![0], scenes: vec![None], quadrature: Some(2.0) };
        let z = |mean, stderr| check.z(&Estimate { mean: Some(mean), stderr });
        assert!((z(2.3, Some(0.1)).unwrap() - 3.0).abs() < 1e-6);
        assert!(z(2.0 + 2e-7, Some(0.0)).unwrap() < 1.0);
        assert_eq!(z(2.0, Some(0.0)), Some(0.0));
        assert_eq!(z(2.3, None), None);
    }
}
