//! What `airlight variance` found, as JSON and as a table.

use crate::table;
use airlight::Precision;
use airlight_tools::contender::Contender;
use serde::Serialize;
use std::fmt;

/// A row per set and density.
#[derive(Debug, Serialize)]
#[serde(transparent)]
pub(crate) struct Figures(pub(crate) Vec<Row>);

/// The relative variances of one density on one set; the names of the fields are the keys of the JSON, which others
/// read. None where no density is valid.
#[derive(Debug, Serialize)]
pub(crate) struct Row {
    pub(crate) strategy: &'static str,
    /// That of quadrature in f64.
    precision: &'static str,
    pub(crate) set: String,
    pub(crate) scenes: usize,
    pub(crate) median: Option<f64>,
    pub(crate) mean: Option<f64>,
    pub(crate) p90: Option<f64>,
    p99: Option<f64>,
    max: Option<f64>,
    share_above_1: Option<f64>,
    /// Scenes whose density is no number somewhere, or is 0 where the integrand is not; they count for nothing else.
    invalid: usize,
}

/// What the quadrature may leave of a variance of 0.
const ROUNDING: f64 = 1e-6;

impl Row {
    pub(super) fn new(contender: Contender, set: &str, mut variances: Vec<f64>) -> Self {
        let scenes = variances.len();
        variances.retain(|v| v.is_finite() && *v >= -ROUNDING);
        variances.sort_by(f64::total_cmp);
        let valid = variances.len();
        let share = |count: usize| (valid > 0).then(|| count as f64 / valid as f64);
        let quantile = |p: f64| variances.get(((p * valid as f64).ceil() as usize).max(1) - 1).copied();
        Self {
            strategy: contender.name(),
            precision: Precision::Exact.name(),
            set: set.to_owned(),
            scenes,
            median: quantile(0.5),
            mean: (valid > 0).then(|| variances.iter().sum::<f64>() / valid as f64),
            p90: quantile(0.9),
            p99: quantile(0.99),
            max: quantile(1.0),
            share_above_1: share(variances.iter().filter(|v| **v > 1.0).count()),
            invalid: scenes - valid,
        }
    }
}

impl fmt::Display for Figures {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        for (i, rows) in self.0.chunk_by(|a, b| a.set == b.set).enumerate() {
            let gap = if i == 0 { "" } else { "\n" };
            writeln!(f, "{gap}{}, {} scenes: relative variance of one sample", rows[0].set, rows[0].scenes)?;
            let mut table =
                table::new(["strategy", "precision", "median", "mean", "p90", "p99", "max", "above 1", "invalid"]);
            for row in rows {
                let told = |value: Option<f64>| value.map_or("-".to_owned(), |value| format!("{value:.2e}"));
                let [median, mean, p90, p99, max] = [row.median, row.mean, row.p90, row.p99, row.max].map(told);
                let share = row.share_above_1.map_or("-".to_owned(), |share| format!("{:.1} %", 100.0 * share));
                let names = [row.strategy, row.precision].map(str::to_owned);
                let figures = [median, mean, p90, p99, max, share, row.invalid.to_string()];
                table.add_row(names.into_iter().chain(figures));
            }
            writeln!(f, "{}", table::text(&table))?;
        }
        writeln!(
            f,
            "\nV: variance of a sample's weight, divided by the square of its mean; median to max: over the scenes"
        )?;
        writeln!(f, "precision: V is computed by quadrature in f64; the density is the same in every precision")?;
        writeln!(f, "above 1: share of the scenes with V > 1")?;
        writeln!(
            f,
            "invalid: scenes where the density is not a number, or is 0 where there is light; no other column has them"
        )
    }
}
