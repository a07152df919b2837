//! `airlight report`: measures speed, variance and accuracy, and writes one page of figures.

mod canvas;
mod drawing;
mod examples;
mod figures;
mod findings;
mod jobs;
mod labels;
mod machine;
mod page;
mod palette;
mod scale;
mod strategies;
mod summary;

use self::findings::Findings;
use self::jobs::Jobs;
use crate::output::{self, Target};
use crate::{arguments, progress};
use airlight::Precision;
use anyhow::{Context, Result};
use std::fs;
use std::path::{Path, PathBuf};

/// Measure speed, variance and accuracy, and write a page of figures with their data
#[derive(Debug, clap::Args)]
#[command(
    after_help = "Examples:\n  airlight report --out report --quick               half a minute on two cores\n  airlight report --strategies docs/strategies"
)]
pub(crate) struct Args {
    /// Folder to write: the page index.html, its figures as .svg and .png, their data as .json
    #[arg(long, value_name = "DIR", required_unless_present = "strategies")]
    out: Option<PathBuf>,
    /// Draw the plots of the documentation's page of Strategy into this folder, and measure nothing
    #[arg(long, value_name = "DIR", exclusive = true)]
    strategies: Option<PathBuf>,
    /// Fewer scenes, rays and rounds: about half a minute
    #[arg(long)]
    quick: bool,
    /// Scenes of each set, for the variances [default: 2000, or 400 with --quick]
    #[arg(long, value_name = "SCENES", value_parser = arguments::positive)]
    scenes: Option<usize>,
    /// Rays of the family generic, for the errors [default: 1048576, or 65536 with --quick]
    #[arg(long, value_name = "RAYS", value_parser = arguments::positive)]
    rays: Option<usize>,
    /// Samples of the wavefront with each strategy [default: 16000000, or 524288 with --quick]
    #[arg(long, value_name = "SAMPLES", value_parser = arguments::positive)]
    samples: Option<usize>,
    /// Rays per batch that is timed, may be repeated [default: as in `airlight profile`]
    #[arg(long, value_name = "RAYS", value_parser = arguments::batch)]
    batch: Vec<usize>,
    /// Rounds of timing [default: 9, or 3 with --quick]
    #[arg(long, value_name = "ROUNDS", value_parser = arguments::positive)]
    rounds: Option<usize>,
    /// Precision to measure, exact or fast, may be repeated [default: both]; figures of one precision show the first
    #[arg(long, value_name = "NAME")]
    precision: Vec<Precision>,
    /// Also measure the kernels of a shared library, as in `airlight profile`; may be repeated
    #[arg(long, value_name = "[BACKEND=]LIBRARY.so")]
    peers: Vec<String>,
}

impl Args {
    /// That of figures which show one alone.
    fn main_precision(&self) -> Precision {
        self.precision.first().copied().unwrap_or_default()
    }
}

pub(crate) fn run(args: &Args) -> Result<()> {
    args.strategies.as_deref().map_or(Ok(()), strategies::write)?;
    args.out.as_deref().map_or(Ok(()), |out| write(args, out))
}

/// Measures everything, then writes everything.
fn write(args: &Args, out: &Path) -> Result<()> {
    fs::create_dir_all(out).with_context(|| format!("cannot write {}", out.display()))?;
    let file = |name: &str| Target::file(&out.join(name));
    let index = file("index.html")?;

    let jobs = Jobs::new(args)?;
    let bar = progress::bar(jobs.steps()?)?;
    let measured = jobs.measure(&bar)?;
    bar.finish_and_clear();

    let findings = Findings::new(&measured, args.main_precision());
    let drawn = figures::all(&findings)?;
    for (name, json) in measured.files()? {
        file(name)?.write(&json)?;
    }
    file("summary.json")?.write(&output::json(&findings.all)?)?;
    for drawing in drawn.iter().flat_map(|figure| &figure.drawings) {
        file(&format!("{}.svg", drawing.name))?.write(drawing.file().as_bytes())?;
        file(&format!("{}.png", drawing.name))?.write(&drawing.png()?)?;
    }
    index.write(page::page(&findings, &drawn, &jobs.commands()).as_bytes())?;
    eprintln!("{}", out.join("index.html").display());
    Ok(())
}
