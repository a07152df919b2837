//! What the measurements say of each strategy, put together.

use super::jobs::Measured;
use super::palette;
use crate::profile::Row;
use airlight::{Backend, Strategy};
use serde::Serialize;

/// Rays of the batch that stands for all; of other sizes, the nearest.
const BATCH: f64 = 65536.0;

/// The figures of one strategy; the names of the fields are the keys of the JSON.
#[derive(Debug, Serialize)]
pub(super) struct Finding {
    #[serde(serialize_with = "name")]
    pub(super) strategy: Strategy,
    /// Its colour in all figures.
    colour: String,
    /// On one thread, with the fastest backend.
    pub(super) ns_per_sample: f64,
    /// Relative variances, the mean over the four sets `canonical`, and over most of `broad`, whose mean a few decide.
    pub(super) variance_canonical: f64,
    pub(super) variance_broad: f64,
    pub(super) variance_broad_p90: f64,
    /// Canonical estimates of equal error in the same time, in those of equi-angular.
    pub(super) efficiency: f64,
    /// What 0.1 % of generic rays exceed in `|CDF(t) - u|`.
    pub(super) cdf_p999: f64,
}

/// All of them, and what they come from.
pub(super) struct Findings<'a> {
    pub(super) measured: &'a Measured,
    /// The fastest one.
    pub(super) backend: Backend,
    /// Rays of the batch that was timed.
    pub(super) batch: usize,
    pub(super) strategies: Vec<Finding>,
}

fn name<S: serde::Serializer>(strategy: &Strategy, serializer: S) -> Result<S::Ok, S::Error> {
    serializer.serialize_str(strategy.name())
}

impl<'a> Findings<'a> {
    pub(super) fn new(measured: &'a Measured) -> Self {
        let backend = Backend::available().next().expect("the portable one is on every machine");
        let sizes = measured.profile.0.iter().filter(|row| is_whole(row)).filter_map(|row| row.subject.rays);
        let distance = |&rays: &usize| ((rays as f64 / BATCH).log2().abs() * 1e6) as u64;
        let batch = sizes.min_by_key(distance).unwrap_or(0);
        let mut findings = Self { measured, backend, batch, strategies: Vec::new() };
        let of = |strategy| findings.of(strategy);
        findings.strategies = Strategy::ALL.iter().map(|&strategy| of(strategy)).collect();
        let product = |finding: &Finding| finding.variance_canonical * finding.ns_per_sample;
        let equi_angular =
            findings.strategies.iter().find(|finding| finding.strategy == Strategy::EquiAngular).map(product);
        for finding in &mut findings.strategies {
            finding.efficiency = equi_angular.unwrap_or(f64::NAN) / product(finding);
        }
        findings
    }

    fn of(&self, strategy: Strategy) -> Finding {
        let name = strategy.name();
        let Measured { broad, canonical, accuracy, .. } = self.measured;
        let broad = broad.0.iter().find(|row| row.strategy == name);
        let canonical: Vec<f64> =
            canonical.0.iter().filter(|row| row.strategy == name).filter_map(|row| row.mean).collect();
        let errors =
            accuracy.0.iter().filter(|row| row.strategy == name).max_by_key(|row| row.backend == self.backend.name());
        Finding {
            strategy,
            colour: palette::colour(strategy).hex(),
            ns_per_sample: self
                .time(strategy, self.backend, 1, self.batch)
                .and_then(|row| row.ns_per_sample)
                .unwrap_or(f64::NAN),
            variance_canonical: canonical.iter().sum::<f64>() / canonical.len() as f64,
            variance_broad: broad.and_then(|row| row.median).unwrap_or(f64::NAN),
            variance_broad_p90: broad.and_then(|row| row.p90).unwrap_or(f64::NAN),
            efficiency: f64::NAN,
            cdf_p999: errors.and_then(|row| row.quantile("cdf_p999")).unwrap_or(f64::NAN),
        }
    }

    /// The time of a whole kernel with a sample per ray.
    pub(super) fn time(&self, strategy: Strategy, backend: Backend, threads: usize, rays: usize) -> Option<&'a Row> {
        self.times(threads).find(|row| {
            row.subject.strategy == Some(strategy.name())
                && row.subject.backend == Some(backend.name())
                && row.subject.rays == Some(rays)
        })
    }

    /// The times of all whole kernels with a sample per ray.
    pub(super) fn times(&self, threads: usize) -> impl Iterator<Item = &'a Row> {
        self.measured.profile.0.iter().filter(move |row| is_whole(row) && row.subject.threads == threads)
    }
}

/// Whether it is the time of a whole kernel with a sample per ray.
fn is_whole(row: &Row) -> bool {
    let subject = &row.subject;
    let whole = subject.stage == Some("total") && subject.samples_per_ray == 1 && row.ratio.is_none();
    whole && subject.strategy.is_some()
}
