//! `airlight sample`: samples a wavefront over and over, and holds the result against the oracle.

mod figures;
mod resampling;

pub(crate) use self::figures::{Figures, Row};
pub(crate) use self::resampling::{Resampled, resample};
use crate::arguments::{self, Json};
use crate::check::{Check, Comparison};
use crate::output::{self, Target};
use crate::progress::{self, Part};
use crate::strata::Strata;
use crate::validity::Validity;
use crate::wavefront::Wavefront;
use airlight::{Counts, Media, Medium, Precision, Sampler, Samples, Strategy};
use airlight_tools::variates;
use anyhow::{Context, Result, ensure};
use std::path::PathBuf;
use std::time::{Duration, Instant};

/// Sample a wavefront with each strategy; report throughput, radiance and agreement with quadrature
#[derive(Debug, clap::Args)]
#[command(
    after_help = "Examples:\n  airlight sample                                    the built-in wavefront, every strategy\n  airlight sample queue.npz --medium 0.1,0.3,0.6     your own rays, in your own medium\n  airlight sample --strategy product-5 --json -      figures as JSON, on standard output"
)]
pub(crate) struct Args {
    /// Wavefront to sample; with the columns cos_outer and cos_inner its emitters are spots along their normals, except where
    /// both are -1 [default: the built-in Cornell box in fog]
    #[arg(value_name = "WAVEFRONT.npz")]
    wavefront: Option<PathBuf>,
    /// Medium: absorption and scattering coefficient [1/m], mean cosine; a coefficient may be three or four numbers, one for each
    /// channel, as in 0.1,0.2:0.3:0.5,0.6, and the radiance of each channel is then reported
    #[arg(long, value_name = "MU_A,MU_S,G", default_value = "0.1,0.3,0.6", allow_hyphen_values = true)]
    #[arg(value_parser = arguments::medium)]
    medium: Medium,
    /// Rays to sample with each strategy, by repeating the wavefront with fresh variates
    #[arg(long, value_name = "RAYS", default_value = "16000000", value_parser = arguments::positive)]
    rays: usize,
    #[arg(long, value_name = "NAME", help = format!("Strategy to run, may be repeated [default: all of {}]", names()))]
    strategy: Vec<Strategy>,
    /// Precision: exact, or fast, which leaves out the strategies that do not have it
    #[arg(long, value_name = "NAME", default_value_t)]
    precision: Precision,
    /// Rays of the wavefront to compare with quadrature
    #[arg(long, value_name = "RAYS", default_value_t = 4096)]
    check: usize,
    /// Seed of the variates; the first repetition has the wavefront's own
    #[arg(long, default_value_t = 0)]
    seed: u64,
    /// Threads to sample with, at most 1024 [default: one per core]
    #[arg(long, value_name = "N", value_parser = arguments::threads)]
    threads: Option<usize>,
    /// Write the columns t, pdf and weight (weight_0, weight_1, ... of several channels) of the first repetition; needs
    /// exactly one --strategy
    #[arg(long, value_name = "FILE.npz")]
    output: Option<PathBuf>,
    #[command(flatten)]
    json: Json,
}

/// Runs the job.
pub(crate) fn run(args: &Args) -> Result<()> {
    ensure!(args.output.is_none() || args.strategy.len() == 1, "--output takes exactly one --strategy");
    let output = args.output.as_deref().map(Target::file).transpose()?;
    let json = args.json.target()?;
    let pool = rayon::ThreadPoolBuilder::new()
        .num_threads(args.threads.unwrap_or(0))
        .build()
        .context("cannot start the threads")?;

    let progress = progress::bar(args.steps()?)?;
    let (figures, columns) = pool.install(|| measure(args, Part::whole(&progress)))?;
    progress.finish_and_clear();

    if let Some(output) = output {
        let Columns { t, pdf, weights } = &columns;
        let names = if let [_] = &weights[..] { &["weight"] } else { &WEIGHTS[..] };
        let weights = names.iter().copied().zip(weights).map(|(name, weight)| (name, &weight[..]));
        let named: Vec<(&str, &[f32])> = [("t", &t[..]), ("pdf", pdf)].into_iter().chain(weights).collect();
        output.write(&output::npz(&named)?)?;
    }
    output::report(&figures, json.as_ref())
}

/// The figures of every sampler, and the first repetition of the last.
pub(crate) fn measure(args: &Args, progress: Part<'_>) -> Result<(Figures, Columns)> {
    let samplers = args.samplers()?;
    let wavefront = &args.wavefront()?;
    let check = |i| wavefront.ray(i).and(wavefront.variate(i)).map(|_| ());
    let validity = Validity::of(wavefront.len(), check);
    let valid = validity.first(args.rays.min(wavefront.len())).with_context(|| wavefront.name.clone())?;
    progress.tell("quadrature");
    let check = Check::new(wavefront, &args.medium, valid, args.check);

    let mut rows = Vec::new();
    let mut first = Columns::default();
    for sampler in samplers {
        progress.tell(sampler.strategy().name());
        let run = sample(args, wavefront, sampler, progress)?;
        rows.extend(run.rows(args, wavefront, &check));
        first = run.first;
    }
    let figures = Figures {
        version: env!("CARGO_PKG_VERSION"),
        wavefront: wavefront.name.clone(),
        wavefront_rays: wavefront.len(),
        rays: args.rays,
        medium: (&args.medium).into(),
        seed: args.seed,
        threads: rayon::current_num_threads(),
        invalid_rays: validity.invalid,
        results: rows,
    };
    Ok((figures, first))
}

impl Args {
    fn wavefront(&self) -> Result<Wavefront> {
        self.wavefront.as_deref().map_or_else(Wavefront::cornell, Wavefront::read)
    }

    fn samplers(&self) -> Result<Vec<Sampler>> {
        arguments::samplers(&self.strategy, &[self.precision])
    }

    /// Samples to draw with each strategy.
    pub(crate) fn rays(&self) -> usize {
        self.rays
    }

    /// Samples to draw in all.
    pub(crate) fn steps(&self) -> Result<usize> {
        Ok(self.samplers()?.len().saturating_mul(self.rays))
    }
}

/// What one sampler made of the wavefront.
struct Run {
    sampler: Sampler,
    counts: Counts,
    /// Time inside the sampler alone.
    sampling: Duration,
    /// Of every channel.
    strata: Vec<Strata>,
    first: Columns,
}

/// What was sampled.
#[derive(Clone, Default)]
pub(crate) struct Columns {
    t: Vec<f32>,
    pdf: Vec<f32>,
    /// Of every channel.
    weights: Vec<Vec<f32>>,
}

/// What the columns of weights are called, if there are several.
const WEIGHTS: [&str; 4] = ["weight_0", "weight_1", "weight_2", "weight_3"];

/// Samples the wavefront in batches of one repetition; the last one may be a part of it.
fn sample(args: &Args, wavefront: &Wavefront, sampler: Sampler, progress: Part<'_>) -> Result<Run> {
    let reached = args.rays.min(wavefront.len());
    let media = Media::one(args.medium);
    let (mut counts, mut sampling) = (Counts::default(), Duration::ZERO);
    let mut strata = vec![Strata::new(reached); args.medium.channels()];
    let mut u = wavefront.u[..reached].to_vec();
    let mut columns = Columns::new(reached, args.medium.channels());
    let mut first = Columns::default();

    for start in (0..args.rays).step_by(reached) {
        let count = reached.min(args.rays - start);
        if start > 0 {
            variates::fill(args.seed, start as u64, &mut u[..count]);
        }
        let rays = wavefront.rays(count);
        let emitters = wavefront.emitters(count);
        let mut samples = columns.samples(count);
        let clock = Instant::now();
        counts = counts + sampler.sample(&rays, &emitters, &media, &u[..count], &mut samples)?;
        sampling += clock.elapsed();

        for (strata, weight) in strata.iter_mut().zip(&columns.weights) {
            strata.add(&weight[..count]);
        }
        if start == 0 {
            first = columns.clone();
        }
        progress.inc(count);
    }
    Ok(Run { sampler, counts, sampling, strata, first })
}

impl Run {
    /// One for each channel.
    fn rows(&self, args: &Args, wavefront: &Wavefront, check: &Check) -> Vec<Row> {
        let strategy = self.sampler.strategy();
        let errors = check.cdf_errors(strategy, &wavefront.u, &self.first.t, &self.first.pdf);
        let compared = check.compare(strategy, &self.strata);
        let channel = |c: usize| (self.strata.len() > 1).then_some(c);
        let row = |(c, subset)| self.row(args, channel(c), (&self.strata[c], subset), check, &errors);
        compared.into_iter().enumerate().map(row).collect()
    }

    fn row(
        &self,
        args: &Args,
        channel: Option<usize>,
        (strata, subset): (&Strata, Option<Comparison>),
        check: &Check,
        errors: &[f64],
    ) -> Row {
        let whole = strata.all();
        Row {
            strategy: self.sampler.strategy().name(),
            channel,
            precision: self.sampler.precision().name(),
            rays: args.rays,
            msamples_per_s: args.rays as f64 / (1e6 * self.sampling.as_secs_f64()),
            sampled: self.counts.sampled,
            empty: self.counts.empty,
            invalid: self.counts.invalid,
            bisected: self.counts.bisected,
            radiance: whole.mean,
            radiance_stderr: whole.stderr,
            check_rays: check.rays.len(),
            check_estimate: subset.map(|c| c.estimate),
            check_stderr: subset.map(|c| c.stderr),
            check_quadrature: subset.map(|c| c.quadrature),
            check_z: subset.and_then(|c| c.z()),
            cdf_p999: quantile(errors, 0.999),
            cdf_max: errors.last().copied(),
        }
    }
}

impl Columns {
    fn new(length: usize, channels: usize) -> Self {
        let column = vec![0.0; length];
        Self { t: column.clone(), pdf: column.clone(), weights: vec![column; channels] }
    }

    /// The first `count` rows, to be written.
    fn samples(&mut self, count: usize) -> Samples<'_> {
        let Self { t, pdf, weights } = self;
        let mut samples = Samples::new(&mut t[..count], &mut pdf[..count]);
        for (column, weight) in samples.weights.iter_mut().zip(weights) {
            *column = Some(&mut weight[..count]);
        }
        samples
    }
}

/// The smallest of the values, which ascend, that a share of at least `p` of them does not exceed.
fn quantile(ascending: &[f64], p: f64) -> Option<f64> {
    let rank = (p * ascending.len() as f64).ceil() as usize;
    ascending.get(rank.max(1) - 1).copied()
}

fn names() -> String {
    Strategy::ALL.iter().map(|s| s.name()).collect::<Vec<_>>().join(", ")
}
