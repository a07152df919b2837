//! Stratified estimates: the rays of a wavefront are the strata, their repetitions the samples.

/// Running mean and spread of each ray's weights, by Welford's recurrence in f64.
#[derive(Clone, Debug)]
pub(crate) struct Strata {
    rays: Vec<Moments>,
}

#[derive(Clone, Copy, Debug, Default)]
struct Moments {
    count: u32,
    mean: f64,
    /// Sum of squared deviations from the mean.
    spread: f64,
}

/// A mean over rays and how well the sampling resolves it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Estimate {
    /// The mean over the rays of each ray's mean weight; none of no rays.
    pub(crate) mean: Option<f64>,
    /// Its standard error; none unless every ray was sampled at least twice.
    pub(crate) stderr: Option<f64>,
}

impl Strata {
    /// Strata of `rays` rays without a sample.
    pub(crate) fn new(rays: usize) -> Self {
        Self { rays: vec![Moments::default(); rays] }
    }

    /// Adds one repetition: a weight for each ray, or for the first of them.
    pub(crate) fn add(&mut self, weights: &[f32]) {
        for (ray, &weight) in self.rays.iter_mut().zip(weights) {
            ray.add(f64::from(weight));
        }
    }

    /// How often `ray` was sampled.
    pub(crate) fn samples(&self, ray: usize) -> f64 {
        f64::from(self.rays[ray].count)
    }

    /// The estimate over all rays.
    pub(crate) fn all(&self) -> Estimate {
        estimate(self.rays.iter())
    }

    /// The estimate over the rays `subset`.
    pub(crate) fn of(&self, subset: &[usize]) -> Estimate {
        estimate(subset.iter().map(|&ray| &self.rays[ray]))
    }
}

impl Moments {
    fn add(&mut self, weight: f64) {
        self.count += 1;
        let deviation = weight - self.mean;
        self.mean += deviation / f64::from(self.count);
        self.spread += deviation * (weight - self.mean);
    }

    /// Variance of the mean.
    fn variance(&self) -> Option<f64> {
        (self.count > 1).then(|| self.spread / (f64::from(self.count) * f64::from(self.count - 1)))
    }
}

/// The strata are independent, so the variances of their means add up; what differs between rays is no error.
fn estimate<'a>(rays: impl ExactSizeIterator<Item = &'a Moments> + Clone) -> Estimate {
    let count = rays.len() as f64;
    let mean = rays.clone().map(|ray| ray.mean).sum::<f64>() / count;
    let variance: Option<f64> = rays.map(Moments::variance).sum();
    let of_any = count > 0.0;
    Estimate { mean: of_any.then_some(mean), stderr: variance.filter(|_| of_any).map(|v| v.sqrt() / count) }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_differs_between_rays_is_no_error() {
        let mut strata = Strata::new(2);
        for _ in 0..3 {
            strata.add(&[1.0, 101.0]);
        }
        assert_eq!(strata.all(), Estimate { mean: Some(51.0), stderr: Some(0.0) });
    }

    #[test]
    fn the_standard_error_is_that_of_the_rays_means() {
        let mut strata = Strata::new(3);
        for weights in [[0.0, 5.0, 9.0], [2.0, 5.0, 9.0], [4.0, 8.0, 9.0]] {
            strata.add(&weights);
        }
        // Variances 4 and 3 of single samples; a third of each is that of the mean.
        let two = strata.of(&[0, 1]);
        assert!((two.mean.unwrap() - 4.0).abs() < 1e-15);
        assert!((two.stderr.unwrap() - (7.0f64 / 3.0).sqrt() / 2.0).abs() < 1e-15);
    }

    #[test]
    fn rays_of_a_begun_repetition_weigh_no_more_than_the_others() {
        let mut strata = Strata::new(2);
        for weights in [&[1.0, 4.0][..], &[1.0, 4.0], &[1.0]] {
            strata.add(weights);
        }
        assert_eq!(strata.all().mean, Some(2.5));
    }

    #[test]
    fn one_sample_has_no_spread() {
        let mut strata = Strata::new(2);
        strata.add(&[1.0, 3.0]);
        strata.add(&[1.0]);
        assert_eq!(strata.all(), Estimate { mean: Some(2.0), stderr: None });
        assert_eq!(strata.of(&[]), Estimate { mean: None, stderr: None });
    }
}
