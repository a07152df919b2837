//! `airlight variance`: how far single samples stray with every density, by quadrature.

mod adversarial;
mod figures;
mod source;

pub(crate) use self::figures::{Figures, Row};
use self::source::Source;
use crate::arguments::{self, Json};
use crate::progress::Part;
use crate::{output, progress};
use airlight::{Medium, Precision};
use airlight_tools::contender::{Contender, PRODUCTS};
use anyhow::{Result, ensure};
use rayon::prelude::*;

/// Scenes of a set, unless told otherwise.
const SCENES: usize = 2000;
/// Climbs of the search, unless told otherwise.
const CLIMBS: usize = 256;

/// Compare the relative variances of all densities, by quadrature, on a set of scenes
#[derive(Debug, clap::Args)]
#[command(
    after_help = "Examples:\n  airlight variance --set broad\n  airlight variance --set colour --strategy product-5"
)]
pub(crate) struct Args {
    /// Scenes: broad, generic, dense, tame, spot, colour, colour-strong, canonical, or the rays of a wavefront
    #[arg(long, value_name = "NAME|FILE.npz", default_value = "broad", conflicts_with = "adversarial")]
    set: Source,
    /// Medium of the rays of a wavefront: absorption and scattering coefficient [1/m], mean cosine; a coefficient may be three
    /// numbers, r:g:b, and the variance is then the mean over the channels
    #[arg(long, value_name = "MU_A,MU_S,G", default_value = "0.1,0.3,0.6", allow_hyphen_values = true)]
    #[arg(value_parser = arguments::medium, conflicts_with = "adversarial")]
    medium: Medium,
    /// Scenes of the set, or climbs of --adversarial [default: 2000, or 256]
    #[arg(long, value_name = "SCENES", value_parser = arguments::positive)]
    scenes: Option<usize>,
    /// Seed of the scenes
    #[arg(long, default_value_t = 0)]
    seed: u64,
    #[arg(long, value_name = "NAME", help = format!("Density to measure, may be repeated [default: all of {}]", names()))]
    strategy: Vec<Contender>,
    /// Precision: only exact, as the variance of a density is computed by quadrature in f64, without samples
    #[arg(long, value_name = "NAME", default_value_t)]
    precision: Precision,
    /// Search for the scenes on which the product densities do worst, by climbing from random ones
    #[arg(long)]
    adversarial: bool,
    #[command(flatten)]
    json: Json,
}

/// Runs the comparison, or the search.
pub(crate) fn run(args: &Args) -> Result<()> {
    ensure!(
        args.precision == Precision::Exact,
        "--precision {}: variances are those of the densities in exact arithmetic, by quadrature",
        args.precision
    );
    let json = args.json.target()?;
    if args.adversarial {
        return output::report(&adversarial::search(args)?, json.as_ref());
    }
    let progress = progress::bar(args.steps())?;
    let figures = measure(args, Part::whole(&progress))?;
    progress.finish_and_clear();
    output::report(&figures, json.as_ref())
}

/// The variances of everything that was asked for.
pub(crate) fn measure(args: &Args, progress: Part<'_>) -> Result<Figures> {
    let mut rows = Vec::new();
    for (name, scenes) in &args.set.scenes(&args.medium, args.seed, args.count())? {
        for contender in args.contenders(Contender::all()) {
            progress.tell(format!("{name} {}", contender.name()));
            let variance = |scene| {
                let variance = contender.mean_variance(scene);
                progress.inc(1);
                variance
            };
            rows.push(Row::new(contender, name, scenes.par_iter().filter_map(variance).collect()));
        }
    }
    Ok(Figures(rows))
}

impl Args {
    /// Scenes of a set.
    fn count(&self) -> usize {
        self.scenes.unwrap_or(SCENES)
    }

    /// Variances to measure in all; of a wavefront, at most.
    pub(crate) fn steps(&self) -> usize {
        (self.set.count() * self.contenders(Contender::all()).len()).saturating_mul(self.count())
    }

    /// Those asked for, or else `all`.
    fn contenders(&self, all: Vec<Contender>) -> Vec<Contender> {
        if self.strategy.is_empty() { all } else { self.strategy.clone() }
    }
}

fn names() -> String {
    Contender::all().into_iter().map(Contender::name).collect::<Vec<_>>().join(", ")
}
