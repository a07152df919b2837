//! `airlight render`: renders a built-in scene with the wavefront renderer, or compares the densities on it.

mod comparison;
mod exposure;
mod figures;
mod image_file;
mod sheet;

use self::exposure::{Budget, Exposure};
use self::figures::{Figures, Job, Run};
use self::image_file::ImageFile;
use crate::arguments::{self, Json};
use crate::output::{self, Target};
use crate::progress;
use airlight::{Precision, Sampler, Strategy};
use airlight_tools::renderer::Settings;
use airlight_tools::renderer::emitter_choice::EmitterChoice;
use airlight_tools::renderer::picture::{Picture, Size};
use airlight_tools::renderer::scene::Scene;
use airlight_tools::renderer::scenes::Name;
use airlight_tools::renderer::shadow::Shadows;
use airlight_tools::renderer::variate::Sequence;
use anyhow::{Context, Result, ensure};
use serde::Serialize;
use std::fmt::Display;
use std::path::PathBuf;
use std::slice::from_mut;
use std::time::Duration;

/// Passes, unless told otherwise.
const PASSES: usize = 64;

/// Render a scene of spheres and planes in fog, or compare the strategies on it
#[derive(Debug, clap::Args)]
#[command(
    after_help = "Examples:\n  airlight render --out fog.png                      one picture\n  airlight render --scene spots --spp 256 --out spots.exr\n  airlight render --compare --time 3                 every strategy, for three seconds each"
)]
pub(crate) struct Args {
    /// Scene: shaft, many-lights, forward, dense or spots
    #[arg(long, value_name = "NAME", default_value_t = Name::Shaft)]
    scene: Name,
    #[arg(long, value_name = "NAME", help = format!("Strategy of the distances [default: product-5]; with --compare it may be repeated [default: all of {}]", names()))]
    strategy: Vec<Strategy>,
    /// Precision: exact, or fast, which with --compare leaves out the strategies that do not have it
    #[arg(long, value_name = "NAME", default_value_t)]
    precision: Precision,
    /// Take a second sample of every ray from the transmittance, and combine the two by the balance heuristic
    #[arg(long)]
    mis: bool,
    /// Choice of a light for each ray: choose, in proportion to the integrals with 4 nodes, or uniform
    #[arg(long, value_name = "NAME", default_value_t)]
    lights: EmitterChoice,
    /// Estimate of the scattered light: plain, the mean of the samples that see their light, or ratio, the integral times the
    /// share of the samples that do [default: plain]; with --compare it may be repeated
    #[arg(long, value_name = "NAME")]
    shadows: Vec<Shadows>,
    /// Random numbers of the passes: sobol, an Owen-scrambled Sobol sequence for each pixel, or independent
    #[arg(long, value_name = "NAME", default_value_t)]
    variates: Sequence,
    /// Passes, each of which takes one sample of every pixel [default: 64]
    #[arg(long, value_name = "N", value_parser = arguments::positive, conflicts_with = "time")]
    spp: Option<usize>,
    /// Render whole passes for this many seconds
    #[arg(long, value_name = "SECONDS", value_parser = arguments::seconds, allow_negative_numbers = true)]
    time: Option<Duration>,
    /// Width and height of the picture in pixels
    #[arg(long, value_name = "WxH", default_value = "512x288")]
    size: Size,
    /// Seed of the random numbers
    #[arg(long, default_value_t = 0)]
    seed: u64,
    /// Threads to render with, at most 1024 [default: one per core]
    #[arg(long, value_name = "N", value_parser = arguments::threads)]
    threads: Option<usize>,
    /// Write the picture: linear as .exr, with a tone curve as .png
    #[arg(long, value_name = "IMAGE")]
    out: Option<PathBuf>,
    /// Render with each strategy and each of --shadows for the same time or number of passes, and report the errors; --out gets
    /// the pictures side by side
    #[arg(long)]
    compare: bool,
    /// Passes of the picture that errors are measured against, rendered with product-17
    #[arg(long, value_name = "N", default_value = "1024", value_parser = arguments::positive, requires = "compare")]
    reference: usize,
    #[command(flatten)]
    json: Json,
}

/// Renders.
pub(crate) fn run(args: &Args) -> Result<()> {
    ensure!(args.compare || args.strategy.len() <= 1, "several --strategy need --compare");
    ensure!(args.compare || args.shadows.len() <= 1, "several --shadows need --compare");
    let out = args.out.as_deref().map(ImageFile::new).transpose()?;
    let json = args.json.target()?;
    if out.is_none() && !args.compare {
        eprintln!("no picture is written without --out");
    }
    let pool = rayon::ThreadPoolBuilder::new()
        .num_threads(args.threads.unwrap_or(0))
        .build()
        .context("cannot start the threads")?;
    let scene = args.scene.scene()?;

    if args.compare {
        let (figures, sheet) = pool.install(|| comparison::compare(args, &scene))?;
        deliver(&sheet, scene.exposure, out, &figures, json.as_ref())
    } else {
        let (figures, picture) = pool.install(|| single(args, &scene))?;
        deliver(&picture, scene.exposure, out, &figures, json.as_ref())
    }
}

/// Renders with one strategy.
fn single(args: &Args, scene: &Scene) -> Result<(Figures, Picture)> {
    let strategy = args.strategy.first().copied().unwrap_or_default();
    let sampler = Sampler::new(strategy).with_precision(args.precision)?;
    let settings = args.settings(sampler, args.shadows.first().copied().unwrap_or_default());
    let progress = progress::bar(exposure::STEPS)?;
    progress.set_message(strategy.name());
    let mut exposure = Exposure::new(scene, args.size, &settings, args.budget());
    Exposure::complete(from_mut(&mut exposure), &progress)?;
    progress.finish_and_clear();
    let figures = Figures { job: args.job(), run: Run::new(&settings, &exposure), radiance: exposure.film.average() };
    Ok((figures, exposure.film.picture()))
}

/// Writes the picture, then the figures: none of a picture that could not be written.
fn deliver<F: Serialize + Display>(
    picture: &Picture,
    exposure: f32,
    out: Option<ImageFile>,
    figures: &F,
    json: Option<&Target>,
) -> Result<()> {
    if let Some(out) = out {
        out.write(picture, exposure)?;
    }
    output::report(figures, json)
}

impl Args {
    fn settings(&self, sampler: Sampler, shadows: Shadows) -> Settings {
        let Self { mis, lights: choice, variates, seed, .. } = *self;
        Settings { sampler, mis, choice, shadows, variates, seed }
    }

    fn budget(&self) -> Budget {
        self.time.map_or(Budget::Passes(self.spp.unwrap_or(PASSES) as u64), Budget::Time)
    }

    /// What all figures begin with.
    fn job(&self) -> Job {
        Job {
            version: env!("CARGO_PKG_VERSION"),
            scene: self.scene.name(),
            width: self.size.width,
            height: self.size.height,
            mis: self.mis,
            lights: self.lights.name(),
            variates: self.variates.name(),
            seed: self.seed,
            threads: rayon::current_num_threads(),
        }
    }
}

fn names() -> String {
    Strategy::ALL.iter().map(|s| s.name()).collect::<Vec<_>>().join(", ")
}
