//! What `airlight sample` found, as JSON and as a table.

use crate::table;
use crate::validity::Invalid;
use airlight::Medium;
use serde::Serialize;
use std::fmt;

/// The settings and a row per strategy. The names of the fields are the keys of the JSON, which others read.
#[derive(Debug, Serialize)]
pub(crate) struct Figures {
    pub(crate) version: &'static str,
    pub(crate) wavefront: String,
    pub(crate) wavefront_rays: usize,
    pub(crate) rays: usize,
    pub(crate) medium: Coefficients,
    pub(crate) seed: u64,
    pub(crate) threads: usize,
    /// What is wrong with the wavefront, if anything.
    pub(crate) invalid_rays: Option<Invalid>,
    pub(crate) results: Vec<Row>,
}

/// A medium, spelt out.
#[derive(Debug, Serialize)]
pub(crate) struct Coefficients {
    mu_a: Coefficient,
    mu_s: Coefficient,
    g: f32,
}

/// A number, or those of all channels.
#[derive(Debug, Serialize)]
#[serde(untagged)]
enum Coefficient {
    Grey(f32),
    Coloured(Vec<f32>),
}

impl From<&Medium> for Coefficients {
    fn from(medium: &Medium) -> Self {
        let coefficient = |of: fn(&Medium) -> f32| match medium.channels() {
            1 => Coefficient::Grey(of(medium)),
            _ => Coefficient::Coloured((0..).map_while(|c| medium.channel(c)).map(|channel| of(&channel)).collect()),
        };
        Self { mu_a: coefficient(Medium::mu_a), mu_s: coefficient(Medium::mu_s), g: medium.g() }
    }
}

impl fmt::Display for Coefficient {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Grey(value) => write!(f, "{value}"),
            Self::Coloured(values) => write!(f, "{}", values.iter().map(f32::to_string).collect::<Vec<_>>().join(":")),
        }
    }
}

/// One strategy, in one channel; what cannot be told, such as the standard error of a single repetition, is none.
#[derive(Debug, Serialize)]
pub(crate) struct Row {
    pub(crate) strategy: &'static str,
    /// Which one, of a medium of several channels.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(crate) channel: Option<usize>,
    pub(crate) precision: &'static str,
    pub(crate) rays: usize,
    pub(crate) msamples_per_s: f64,
    pub(crate) sampled: usize,
    pub(crate) empty: usize,
    pub(crate) invalid: usize,
    pub(crate) bisected: usize,
    /// Mean weight over the wavefront \[1/m^2\].
    pub(crate) radiance: Option<f64>,
    /// Its standard error, from the spread of each ray's samples.
    pub(crate) radiance_stderr: Option<f64>,
    /// Rays that were compared with the oracle; the following hold for them alone.
    pub(crate) check_rays: usize,
    pub(crate) check_estimate: Option<f64>,
    /// The standard error that the oracle foretells.
    pub(crate) check_stderr: Option<f64>,
    pub(crate) check_quadrature: Option<f64>,
    pub(crate) check_z: Option<f64>,
    /// The 0.999 quantile and the maximum of `|CDF(t) - u|` in the first repetition.
    pub(crate) cdf_p999: Option<f64>,
    pub(crate) cdf_max: Option<f64>,
}

impl fmt::Display for Figures {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Coefficients { mu_a, mu_s, g } = &self.medium;
        writeln!(f, "{}: {} rays, {} samples per strategy", self.wavefront, self.wavefront_rays, self.rays)?;
        writeln!(f, "medium: mu_a {mu_a} /m, mu_s {mu_s} /m, g {g}; seed {}, threads {}", self.seed, self.threads)?;

        let mut speed = table::new(["strategy", "precision", "Msamples/s", "sampled", "empty", "invalid", "bisected"]);
        for row in self.results.iter().filter(|row| row.channel.is_none_or(|channel| channel == 0)) {
            speed.add_row([
                row.strategy.to_owned(),
                row.precision.to_owned(),
                format!("{:.1}", row.msamples_per_s),
                row.sampled.to_string(),
                row.empty.to_string(),
                row.invalid.to_string(),
                row.bisected.to_string(),
            ]);
        }
        writeln!(f, "\n{}\n", table::text(&speed))?;
        writeln!(
            f,
            "sampled: samples with a distance; empty: samples of rays on which nothing is lit; invalid: of invalid rays"
        )?;
        writeln!(f, "bisected: samples whose iteration fell back to bisection, or took many steps")?;
        if let Some(invalid) = &self.invalid_rays {
            writeln!(f, "{invalid}")?;
        }

        let mut radiance = table::new([
            "strategy",
            "precision",
            "radiance",
            "+-",
            "estimate",
            "+-",
            "quadrature",
            "z",
            "CDF p99.9",
            "CDF max",
        ]);
        for row in &self.results {
            radiance.add_row([
                row.channel.map_or(row.strategy.to_owned(), |channel| format!("{}[{channel}]", row.strategy)),
                row.precision.to_owned(),
                figure(row.radiance, |x| format!("{x:.5e}")),
                figure(row.radiance_stderr, |x| format!("{x:.1e}")),
                figure(row.check_estimate, |x| format!("{x:.5e}")),
                figure(row.check_stderr, |x| format!("{x:.1e}")),
                figure(row.check_quadrature, |x| format!("{x:.5e}")),
                figure(row.check_z, |x| format!("{x:+.2}")),
                figure(row.cdf_p999, |x| format!("{x:.1e}")),
                figure(row.cdf_max, |x| format!("{x:.1e}")),
            ]);
        }
        let checked = self.results.first().map_or(0, |row| row.check_rays);
        writeln!(f, "\n{}\n", table::text(&radiance))?;
        writeln!(
            f,
            "radiance: mean weight [1/m^2], 0 for an invalid ray; estimate: the same on {checked} of the rays; +-: standard errors"
        )?;
        if self.results.iter().any(|row| row.channel.is_some()) {
            writeln!(f, "[0], [1], ...: the channels of the medium")?;
        }
        writeln!(f, "quadrature: the oracle's value of the estimate, from which it is z standard errors away")?;
        writeln!(f, "CDF: the 99.9 % quantile and the maximum of |CDF(t) - u| on the same rays")
    }
}

fn figure(value: Option<f64>, format: impl Fn(f64) -> String) -> String {
    value.map_or_else(|| "-".to_owned(), format)
}
