//! `airlight accuracy`: the errors of the kernels on families of hard inputs, held against what is promised.

use crate::arguments::{self, Json};
use crate::progress::Part;
use crate::{output, progress, table};
use airlight::{Backend, Sampler, Strategy};
use airlight_tools::backends::distinct;
use airlight_tools::bounds::bounds;
use airlight_tools::errors::{Errors, quantile};
use airlight_tools::families::Family;
use anyhow::Result;
use serde::Serialize;
use serde_json::{Map, Value, json};
use std::fmt;
use std::process::ExitCode;

/// Exit code where a promise is broken.
const BROKEN: u8 = 1;

/// Compare the kernels with the f64 oracle on families of hard inputs; exit with 1 if a promised bound is broken
#[derive(Debug, clap::Args)]
pub(crate) struct Args {
    /// Rays per strategy and family
    #[arg(long, value_name = "RAYS", default_value = "65536", value_parser = arguments::positive)]
    rays: usize,
    /// Seed of the families
    #[arg(long, default_value_t = 0)]
    seed: u64,
    /// Strategy to measure, may be repeated [default: all]
    #[arg(long, value_name = "NAME")]
    strategy: Vec<Strategy>,
    #[arg(long, value_name = "NAME", help = format!("Family to measure, may be repeated [default: all of {}]", names()))]
    family: Vec<Family>,
    #[command(flatten)]
    json: Json,
}

fn names() -> String {
    Family::ALL.map(Family::name).join(", ")
}

/// Runs the comparison.
pub(crate) fn run(args: &Args) -> Result<ExitCode> {
    let json = args.json.target()?;
    let progress = progress::bar(args.steps())?;
    let figures = measure(args, Part::whole(&progress));
    progress.finish_and_clear();

    let kept = figures.0.iter().all(|row| row.broken.is_empty());
    output::report(&figures, json.as_ref())?;
    Ok(if kept { ExitCode::SUCCESS } else { ExitCode::from(BROKEN) })
}

/// The errors of everything that was asked for.
pub(crate) fn measure(args: &Args, progress: Part<'_>) -> Figures {
    let mut rows = Vec::new();
    for &family in args.families() {
        for backend in distinct() {
            for &strategy in args.strategies() {
                progress.tell(format!("{} {}", family.name(), strategy.name()));
                let sampler = Sampler::new(strategy).with_backend(backend);
                let errors = Errors::measure(&sampler, family, args.rays, args.seed, |done| progress.inc(done));
                rows.push(Row::new(strategy, family, backend, &errors));
            }
        }
    }
    Figures(rows)
}

impl Args {
    fn strategies(&self) -> &[Strategy] {
        if self.strategy.is_empty() { Strategy::ALL } else { &self.strategy }
    }

    fn families(&self) -> &[Family] {
        if self.family.is_empty() { &Family::ALL } else { &self.family }
    }

    /// Rays to measure in all.
    pub(crate) fn steps(&self) -> usize {
        (distinct().count() * self.families().len() * self.strategies().len()).saturating_mul(self.rays)
    }
}

/// A row per family, backend and strategy.
#[derive(Serialize)]
#[serde(transparent)]
pub(crate) struct Figures(pub(crate) Vec<Row>);

/// The figures of one; the names of the fields are the keys of the JSON.
#[derive(Serialize)]
pub(crate) struct Row {
    pub(crate) strategy: &'static str,
    family: &'static str,
    pub(crate) backend: &'static str,
    rays: usize,
    sampled: usize,
    nonfinite: usize,
    out_of_range: usize,
    misjudged: usize,
    bisected: usize,
    /// For every kind of error its median, p99, p99.9, p99.99 and maximum, as `cdf_p50` and so on.
    #[serde(flatten)]
    quantiles: Map<String, Value>,
    /// Promises that are not kept.
    broken: Vec<String>,
    #[serde(skip)]
    kinds: Vec<Kind>,
}

/// A kind of error and its quantiles.
struct Kind {
    name: &'static str,
    quantiles: [f64; QUANTILES.len()],
}

const QUANTILES: [(&str, f64); 5] = [("p50", 0.5), ("p99", 0.99), ("p999", 0.999), ("p9999", 0.9999), ("max", 1.0)];

impl Row {
    /// The quantile of the errors that JSON has under this key.
    pub(crate) fn quantile(&self, key: &str) -> Option<f64> {
        self.quantiles.get(key)?.as_f64()
    }

    fn new(strategy: Strategy, family: Family, backend: Backend, errors: &Errors) -> Self {
        let kinds: Vec<Kind> = errors
            .lists()
            .map(|(name, list)| Kind { name, quantiles: QUANTILES.map(|(_, p)| quantile(list, p)) })
            .into();
        let keys = kinds.iter().flat_map(|kind| {
            QUANTILES.iter().zip(kind.quantiles).map(|((p, _), value)| (format!("{}_{p}", kind.name), json!(value)))
        });
        let broken = bounds(strategy, family)
            .iter()
            .filter(|bound| !bound.holds(errors))
            .map(|bound| format!("{} = {:.2e} exceeds {:.2e}", bound.figure, (bound.read)(errors), bound.limit))
            .collect();
        Self {
            strategy: strategy.name(),
            family: family.name(),
            backend: backend.name(),
            rays: errors.rays,
            sampled: errors.sampled,
            nonfinite: errors.nonfinite,
            out_of_range: errors.out_of_range,
            misjudged: errors.misjudged,
            bisected: errors.bisected,
            quantiles: keys.collect(),
            broken,
            kinds,
        }
    }
}

impl fmt::Display for Figures {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        for row in &self.0 {
            writeln!(
                f,
                "{}, {}, {}: {} of {} rays sampled; nonfinite {}, out of range {}, misjudged {}, bisected {}",
                row.family,
                row.strategy,
                row.backend,
                row.sampled,
                row.rays,
                row.nonfinite,
                row.out_of_range,
                row.misjudged,
                row.bisected
            )?;
            let mut table = table::new(["error", "median", "p99", "p99.9", "p99.99", "max"]);
            // A list with nothing in it has no quantiles.
            for kind in row.kinds.iter().filter(|kind| !kind.quantiles[0].is_nan()) {
                let cells = kind.quantiles.map(|value| format!("{value:.1e}"));
                table.add_row([kind.name.to_owned()].into_iter().chain(cells));
            }
            writeln!(f, "{}\n", table::text(&table))?;
            for broken in &row.broken {
                writeln!(f, "  BROKEN: {broken}")?;
            }
        }
        let broken: usize = self.0.iter().map(|row| row.broken.len()).sum();
        match broken {
            0 => writeln!(f, "every bound holds"),
            _ => writeln!(f, "{broken} bounds are broken"),
        }
    }
}
