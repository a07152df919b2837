//! What the measurements say of each strategy in each precision, put together.

use super::jobs::Measured;
use super::palette;
use crate::profile::Row;
use airlight::{Backend, Precision, Strategy};
use serde::Serialize;

/// Rays of the batch that stands for all; of other sizes, the nearest.
const BATCH: f64 = 65536.0;

/// The figures of one strategy in one precision; the names of the fields are the keys of the JSON.
#[derive(Debug, Serialize)]
pub(super) struct Finding {
    #[serde(serialize_with = "name")]
    pub(super) strategy: Strategy,
    #[serde(serialize_with = "name")]
    pub(super) precision: Precision,
    /// Its colour in all figures.
    colour: String,
    /// On one thread, with the fastest backend.
    pub(super) ns_per_sample: f64,
    /// Relative variances of the density, whatever the precision, the mean over the four sets `canonical`, and over most of `broad`, whose mean a few decide.
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
    /// That of figures which show one alone.
    pub(super) precision: Precision,
    /// In every precision that was measured.
    pub(super) all: Vec<Finding>,
}

/// A kernel of others: its time and what 0.1 % of rays exceed in `|CDF(t) - u|`.
pub(super) struct Other {
    pub(super) name: String,
    pub(super) ns_per_sample: f64,
    pub(super) cdf_p999: f64,
}

fn name<T: ToString, S: serde::Serializer>(named: &T, serializer: S) -> Result<S::Ok, S::Error> {
    serializer.serialize_str(&named.to_string())
}

impl<'a> Findings<'a> {
    pub(super) fn new(measured: &'a Measured, precision: Precision) -> Self {
        let backend = Backend::available().next().expect("the portable one is on every machine");
        let sizes = measured.profile.0.iter().filter(|row| is_whole(row)).filter_map(|row| row.subject.rays);
        let distance = |&rays: &usize| ((rays as f64 / BATCH).log2().abs() * 1e6) as u64;
        let batch = sizes.min_by_key(distance).unwrap_or(0);
        let mut findings = Self { measured, backend, batch, precision, all: Vec::new() };
        for &strategy in Strategy::ALL {
            for &precision in Precision::ALL {
                if findings.has(strategy, precision) {
                    findings.all.push(findings.of(strategy, precision));
                }
            }
        }
        let product = |finding: &Finding| finding.variance_canonical * finding.ns_per_sample;
        let equi_angular = findings.of_one().find(|finding| finding.strategy == Strategy::EquiAngular).map(product);
        for finding in &mut findings.all {
            finding.efficiency = equi_angular.unwrap_or(f64::NAN) / product(finding);
        }
        findings
    }

    /// Those in the one precision.
    pub(super) fn of_one(&self) -> impl Iterator<Item = &Finding> {
        self.all.iter().filter(|finding| finding.precision == self.precision)
    }

    /// Whether it was measured at all.
    fn has(&self, strategy: Strategy, precision: Precision) -> bool {
        self.times(precision, 1).any(|row| row.subject.strategy == Some(strategy.name()))
    }

    fn of(&self, strategy: Strategy, precision: Precision) -> Finding {
        let name = strategy.name();
        let Measured { broad, canonical, accuracy, .. } = self.measured;
        let broad = broad.0.iter().find(|row| row.strategy == name);
        let canonical: Vec<f64> =
            canonical.0.iter().filter(|row| row.strategy == name).filter_map(|row| row.mean).collect();
        let errors = accuracy.0.iter().filter(|row| (row.strategy, row.precision) == (name, precision.name()));
        let errors = errors.max_by_key(|row| row.backend == self.backend.name());
        Finding {
            strategy,
            precision,
            colour: palette::colour(strategy).hex(),
            ns_per_sample: self
                .time((strategy, precision), self.backend, self.batch)
                .and_then(|row| row.ns_per_sample)
                .unwrap_or(f64::NAN),
            variance_canonical: canonical.iter().sum::<f64>() / canonical.len() as f64,
            variance_broad: broad.and_then(|row| row.median).unwrap_or(f64::NAN),
            variance_broad_p90: broad.and_then(|row| row.p90).unwrap_or(f64::NAN),
            efficiency: f64::NAN,
            cdf_p999: errors.and_then(|row| row.quantile("cdf_p999")).unwrap_or(f64::NAN),
        }
    }

    /// The time of a whole kernel with a sample per ray, on one thread.
    pub(super) fn time(
        &self,
        (strategy, precision): (Strategy, Precision),
        backend: Backend,
        rays: usize,
    ) -> Option<&'a Row> {
        self.times(precision, 1).find(|row| {
            row.subject.strategy == Some(strategy.name())
                && row.subject.backend == Some(backend.name())
                && row.subject.rays == Some(rays)
        })
    }

    /// The times of all whole kernels of a precision with a sample per ray.
    pub(super) fn times(&self, precision: Precision, threads: usize) -> impl Iterator<Item = &'a Row> {
        let wanted =
            move |row: &&Row| (row.subject.precision, row.subject.threads) == (Some(precision.name()), threads);
        self.measured.profile.0.iter().filter(|row| is_whole(row)).filter(wanted)
    }

    /// The peers of the width of the backend.
    pub(super) fn others(&self) -> Vec<Other> {
        let of_batch =
            |row: &&Row| (row.subject.backend, row.subject.rays) == (Some(self.backend.name()), Some(self.batch));
        let other = |row: &Row| {
            // All that are Taylor densities are of the transmittance.
            let name = format!("peer {}", row.subject.peer?.replace("taylor-transmittance", "taylor"));
            Some(Other { name, ns_per_sample: row.ns_per_sample?, cdf_p999: row.cdf_p999? })
        };
        self.measured.profile.0.iter().filter(of_batch).filter_map(other).collect()
    }
}

/// Whether it is the time of a whole kernel with a sample per ray.
fn is_whole(row: &Row) -> bool {
    let subject = &row.subject;
    let whole = subject.stage == Some("total") && subject.samples_per_ray == 1 && row.ratio.is_none();
    whole && subject.strategy.is_some()
}
