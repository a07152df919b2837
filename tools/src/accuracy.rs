//! `airlight accuracy`: the errors of the kernels on families of hard inputs, held against what is promised.

use crate::arguments::{self, Json, Samplers};
use crate::progress::Part;
use crate::{output, progress, table};
use airlight::{Backend, Sampler};
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
#[command(
    after_help = "Examples:\n  airlight accuracy --family generic --rays 1048576\n  airlight accuracy --strategy product-5 --precision exact"
)]
pub(crate) struct Args {
    /// Rays per strategy and family
    #[arg(long, value_name = "RAYS", default_value = "65536", value_parser = arguments::positive)]
    rays: usize,
    /// Seed of the families
    #[arg(long, default_value_t = 0)]
    seed: u64,
    #[command(flatten)]
    samplers: Samplers,
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
    let progress = progress::bar(args.steps()?)?;
    let figures = measure(args, Part::whole(&progress))?;
    progress.finish_and_clear();

    let kept = figures.0.iter().all(|row| row.broken.is_empty());
    output::report(&figures, json.as_ref())?;
    Ok(if kept { ExitCode::SUCCESS } else { ExitCode::from(BROKEN) })
}

/// The errors of everything that was asked for.
pub(crate) fn measure(args: &Args, progress: Part<'_>) -> Result<Figures> {
    let samplers = args.samplers.all()?;
    let mut rows = Vec::new();
    for &family in args.families() {
        for backend in distinct() {
            for sampler in &samplers {
                progress.tell(format!("{} {} {}", family.name(), sampler.strategy(), sampler.precision()));
                let sampler = sampler.with_backend(backend);
                let errors = Errors::measure(&sampler, family, args.rays, args.seed, |done| progress.inc(done));
                rows.push(Row::new(&sampler, family, backend, &errors));
            }
        }
    }
    Ok(Figures(rows))
}

impl Args {
    fn families(&self) -> &[Family] {
        if self.family.is_empty() { &Family::ALL } else { &self.family }
    }

    /// Rays to measure in all.
    pub(crate) fn steps(&self) -> Result<usize> {
        let samplers = self.samplers.all()?.len();
        Ok((distinct().count() * self.families().len() * samplers).saturating_mul(self.rays))
    }
}

/// A row per family, backend, strategy and precision.
#[derive(Serialize)]
#[serde(transparent)]
pub(crate) struct Figures(pub(crate) Vec<Row>);

/// The figures of one; the names of the fields are the keys of the JSON.
#[derive(Serialize)]
pub(crate) struct Row {
    pub(crate) strategy: &'static str,
    pub(crate) precision: &'static str,
    family: &'static str,
    pub(crate) backend: &'static str,
    rays: usize,
    sampled: usize,
    nonfinite: usize,
    out_of_range: usize,
    misjudged: usize,
    misjudged_light: f64,
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

    /// The kinds that there are errors of: a list with nothing in it has no quantiles.
    fn printed(&self) -> impl Iterator<Item = &Kind> {
        self.kinds.iter().filter(|kind| !kind.quantiles[0].is_nan())
    }

    fn new(sampler: &Sampler, family: Family, backend: Backend, errors: &Errors) -> Self {
        let (strategy, precision) = (sampler.strategy(), sampler.precision());
        let kinds: Vec<Kind> = errors
            .lists()
            .map(|(name, list)| Kind { name, quantiles: QUANTILES.map(|(_, p)| quantile(list, p)) })
            .into();
        let keys = kinds.iter().flat_map(|kind| {
            QUANTILES.iter().zip(kind.quantiles).map(|((p, _), value)| (format!("{}_{p}", kind.name), json!(value)))
        });
        let broken = bounds(strategy, precision, family)
            .iter()
            .filter(|bound| !bound.holds(errors))
            .map(|bound| match (bound.read)(errors) {
                figure if figure.is_nan() => format!("{}: there is no ray to check it on", bound.figure),
                figure => format!("{} = {figure:.2e} exceeds {:.2e}", bound.figure, bound.limit),
            })
            .collect();
        Self {
            strategy: strategy.name(),
            precision: precision.name(),
            family: family.name(),
            backend: backend.name(),
            rays: errors.rays,
            sampled: errors.sampled,
            nonfinite: errors.nonfinite,
            out_of_range: errors.out_of_range,
            misjudged: errors.misjudged,
            misjudged_light: errors.misjudged_light,
            bisected: errors.bisected,
            quantiles: keys.collect(),
            broken,
            kinds,
        }
    }
}

/// What the errors of a name are.
fn legend(name: &str) -> &'static str {
    match name {
        "cdf" => "|CDF(t) - u|",
        "cdf_resolved" => "the same where half an ulp of t changes the CDF by 2^-18 at most",
        "cdf_floor" => "cdf of exact arithmetic that is rounded to f32 once; on every 16th ray",
        "cdf_at_t" => {
            "how far Sampler::cdf at t is from the CDF there, beyond the change of the CDF when distances change by 2^-44 of themselves"
        }
        "cdf_beyond_t" => "how far u is from the CDFs of all distances that round to t",
        "offset" => "error of the distance from the nearer end of the interval, beyond the rounding of t [ulp]",
        "offset_floor" => "offset of exact arithmetic on geometry that is rounded to f32; on every 16th ray [ulp]",
        "pdf" => "error of the density at t [ulp]",
        "pdf_floor" => "pdf of exact arithmetic on geometry that is rounded to f32; on every 16th ray [ulp]",
        "r" => "error of the distance to the emitter, beyond the rounding of t, or of u to 2^-20 [ulp]",
        "integrand" => "error of the integrand at t, where h is at least 1e-7 of the distance to the emitter [ulp]",
        "integrand_near" => "the same where h is less [ulp]",
        "weight" => "relative error of the weight, beyond the rounding of t, or of u to 2^-20; on every 16th ray",
        _ => "",
    }
}

impl fmt::Display for Figures {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        for row in &self.0 {
            writeln!(
                f,
                "{}, {}, {}, {}: {} of {} rays sampled; nonfinite {}, out of range {}, misjudged {}{}, \
                 bisected {}",
                row.family,
                row.strategy,
                row.precision,
                row.backend,
                row.sampled,
                row.rays,
                row.nonfinite,
                row.out_of_range,
                row.misjudged,
                if row.misjudged > 0 { format!(" (light {:.1e})", row.misjudged_light) } else { String::new() },
                row.bisected
            )?;
            let mut table = table::new(["error", "median", "p99", "p99.9", "p99.99", "max"]);
            for kind in row.printed() {
                let cells = kind.quantiles.map(|value| format!("{value:.1e}"));
                table.add_row([kind.name.to_owned()].into_iter().chain(cells));
            }
            writeln!(f, "{}\n", table::text(&table))?;
            for broken in &row.broken {
                writeln!(f, "  BROKEN: {broken}")?;
            }
        }
        let printed = |name: &str| self.0.iter().flat_map(Row::printed).any(|kind| kind.name == name);
        let kinds: Vec<&str> = Errors::default().lists().map(|(name, _)| name).into();
        if kinds.iter().any(|name| printed(name)) {
            writeln!(f, "errors: quantiles over the sampled rays, and the maximum")?;
        }
        for name in kinds.into_iter().filter(|name| printed(name)) {
            writeln!(f, "  {name:14}  {}", legend(name))?;
        }
        writeln!(f, "numbers of rays")?;
        writeln!(f, "  nonfinite       something is NaN or infinite")?;
        writeln!(f, "  out of range    t is outside [t_min, t_max], or something is negative")?;
        writeln!(f, "  misjudged       sampled although nothing is lit, or not sampled although something is")?;
        writeln!(
            f,
            "  light           the most light of a misjudged ray, relative to that of an emitter that faces the ray squarely;"
        )?;
        writeln!(f, "                  if the ray is dark, how far N is below 0")?;
        writeln!(f, "  bisected        the iteration fell back to bisection, or took many steps\n")?;
        let broken: usize = self.0.iter().map(|row| row.broken.len()).sum();
        match broken {
            0 => writeln!(f, "every bound holds"),
            _ => writeln!(f, "{broken} bounds are broken"),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use airlight::Strategy;

    #[test]
    fn every_kind_of_error_has_a_legend() {
        for (name, _) in Errors::default().lists() {
            assert!(!legend(name).is_empty(), "{name}");
        }
    }

    #[test]
    fn what_is_printed_is_explained_and_nothing_else() {
        let sampler = Sampler::new(Strategy::Product5);
        let row = |rays| {
            let errors = Errors::measure(&sampler, Family::Generic, rays, 0, |_| ());
            Row::new(&sampler, Family::Generic, Backend::detect(), &errors)
        };
        let text = Figures(vec![row(200)]).to_string();
        for name in ["cdf_resolved", "pdf_floor", "integrand"] {
            assert!(text.lines().any(|line| line.trim().starts_with(name) && line.contains(legend(name))), "{text}");
        }
        // A product density has no offsets, and no generic ray passes so near.
        assert!(!text.contains("offset") && !text.contains("integrand_near"), "{text}");
        let nothing = Figures(vec![row(0)]).to_string();
        assert!(
            !nothing.contains("= NaN") && nothing.contains("cdf_p999: there is no ray to check it on"),
            "{nothing}"
        );
    }
}
