//! `airlight integral`: how near the integral without a sample is to quadrature, and what it costs, beside rules that are
//! written in a minute.

mod figures;
mod plain;

pub(crate) use self::figures::{Figures, Row};
use self::plain::{Line, Plain};
use crate::arguments::{self, Json};
use crate::profile::clock::{nanoseconds, warm_up};
use crate::profile::rounds::take_turns;
use crate::progress::Part;
use crate::{output, progress};
use airlight::oracle::{Coloured, Scene};
use airlight::{Integral, Nodes, Precision};
use airlight_tools::errors::is_comparable;
use airlight_tools::families::{CHANNELS, Case, Columns};
use airlight_tools::scenes::Set;
use airlight_tools::threads;
use anyhow::{Context, Result};
use rayon::prelude::*;
use std::hint::black_box;

/// Rounds in which all rules take their turn.
const ROUNDS: usize = 9;
/// Rays that a measurement of time takes at least.
const RAYS: usize = 1 << 16;
/// The same of rules in scalar code.
const SCALAR_RAYS: usize = 1 << 12;

/// Compare the integral without a sample with quadrature and with plain rules, on sets of scenes
#[derive(Debug, clap::Args)]
#[command(after_help = "Examples:\n  airlight integral --set generic --scenes 8000")]
pub(crate) struct Args {
    /// Scenes: generic, broad, dense, tame, spot, colour, colour-strong or canonical, may be repeated [default: generic, broad, dense]
    #[arg(long, value_name = "NAME", value_parser = set)]
    set: Vec<Sets>,
    /// Scenes of each set
    #[arg(long, value_name = "SCENES", default_value = "2000", value_parser = arguments::batch)]
    scenes: usize,
    /// Seed of the scenes
    #[arg(long, default_value_t = 0)]
    seed: u64,
    /// Precision, exact or fast
    #[arg(long, value_name = "NAME", default_value_t)]
    precision: Precision,
    #[command(flatten)]
    json: Json,
}

/// What a name stands for.
#[derive(Clone, Debug)]
struct Sets(Vec<Set>);

fn set(name: &str) -> Result<Sets, String> {
    let unknown = || {
        format!(
            "no set is called '{name}'; there are generic, broad, dense, tame, spot, colour, colour-strong and canonical"
        )
    };
    Set::named(name).map(Sets).ok_or_else(unknown)
}

/// Runs the comparison.
pub(crate) fn run(args: &Args) -> Result<()> {
    let json = args.json.target()?;
    let progress = progress::bar(args.steps())?;
    let figures = measure(args, Part::whole(&progress))?;
    progress.finish_and_clear();
    output::report(&figures, json.as_ref())
}

/// Errors and times of everything that was asked for.
pub(crate) fn measure(args: &Args, progress: Part<'_>) -> Result<Figures> {
    let one = threads::pool(1).context("cannot start a thread")?;
    let mut rows = Vec::new();
    for set in args.sets() {
        progress.tell(set.name());
        let cases: Vec<Case> = set.cases(args.seed, args.scenes).into_iter().map(|(case, _)| case).collect();
        let scenes = set.coloured(args.seed, args.scenes);
        let truth = |scene: &Scene| {
            let radiance = scene.radiance();
            is_comparable(scene, radiance).then_some(radiance)
        };
        let truth: Vec<Option<f64>> = scenes.par_iter().flat_map_iter(Coloured::channels).map(truth).collect();
        let batch = Batch::new(&cases)?;
        let rules = one.install(|| take_turns(Rule::all(args.precision), ROUNDS, |rule| rule.time(&batch)))?;
        for (rule, times) in rules {
            let errors = rule.radiances(&batch)?.into_iter().zip(&truth);
            let errors = errors.filter_map(|(found, truth)| truth.map(|truth| (found / truth - 1.0).abs()));
            rows.push(Row::new(&rule, set, args.scenes, errors.collect(), times.spread().median));
            progress.inc(1);
        }
    }
    Ok(Figures(rows))
}

impl Args {
    /// Rules on sets of scenes.
    pub(crate) fn steps(&self) -> usize {
        self.sets().len() * Rule::all(self.precision).len()
    }

    fn sets(&self) -> Vec<Set> {
        if self.set.is_empty() {
            return vec![Set::Generic, Set::Broad, Set::Dense];
        }
        self.set.iter().flat_map(|Sets(sets)| sets.iter().copied()).collect()
    }
}

/// The scenes of a set, as every rule takes them.
struct Batch {
    columns: Columns,
    /// Of every channel, those of a ray next to each other.
    lines: Vec<Line>,
    rays: usize,
}

impl Batch {
    fn new(cases: &[Case]) -> Result<Self> {
        let mut lines = Vec::new();
        for case in cases {
            let ((ray, emitter, _), medium) = (case.parts()?, case.whole_medium()?);
            lines.extend((0..).map_while(|c| medium.channel(c)).map(|medium| Line::new(&(ray, emitter, medium))));
        }
        Ok(Self { columns: Columns::new(cases), lines, rays: cases.len() })
    }

    fn channels(&self) -> usize {
        self.lines.len() / self.rays
    }

    /// Room for radiances.
    fn room(&self) -> [Vec<f32>; CHANNELS] {
        [(); CHANNELS].map(|()| vec![0.0; self.rays])
    }
}

/// What integrates.
enum Rule {
    Integral(Integral),
    Plain(Plain),
}

impl Rule {
    fn all(precision: Precision) -> Vec<Self> {
        let integral = |nodes: &Nodes| Self::Integral(Integral::new(*nodes).with_precision(precision));
        let gauss = Nodes::ALL.iter().map(|nodes| Plain::gauss_in_angle(nodes.count()));
        let plain = [Plain::steps_in_angle(), Plain::steps_in_t()].into_iter().chain(gauss);
        Nodes::ALL.iter().map(integral).chain(plain.map(Self::Plain)).collect()
    }

    fn radiances(&self, batch: &Batch) -> Result<Vec<f64>> {
        match self {
            Self::Integral(integral) => {
                let mut radiances = batch.room();
                batch.columns.integrate(integral, &mut radiances)?;
                let of_ray = |i: usize| radiances[..batch.channels()].iter().map(move |channel| f64::from(channel[i]));
                Ok((0..batch.rays).flat_map(of_ray).collect())
            }
            Self::Plain(plain) => Ok(batch.lines.iter().map(|line| plain.radiance(line)).collect()),
        }
    }

    /// Its time for one ray with all its channels \[ns\].
    fn time(&self, batch: &Batch) -> Result<f64> {
        let (rays, mut radiances) = (batch.rays, batch.room());
        let (least, mut work): (usize, Box<dyn FnMut() -> Result<()>>) = match self {
            Self::Integral(integral) => {
                let mut integrate = move || batch.columns.integrate(integral, black_box(&mut radiances)).map(|_| ());
                (RAYS, Box::new(move || Ok(integrate()?)))
            }
            Self::Plain(plain) => {
                let some = &batch.lines[..rays.min(SCALAR_RAYS) * batch.channels()];
                let sum = move || {
                    black_box(some.iter().map(|line| plain.radiance(line)).sum::<f64>());
                    Ok(())
                };
                (SCALAR_RAYS, Box::new(sum))
            }
        };
        let at_once = if let Self::Plain(_) = self { rays.min(SCALAR_RAYS) } else { rays };
        let times = least.div_ceil(at_once);
        warm_up(&mut work)?;
        let (elapsed, done) = nanoseconds(|| (0..times).try_for_each(|_| work()));
        done.map(|()| elapsed / (times * at_once) as f64)
    }
}
