//! The measurements that the report is made of: what the other subcommands do, given these command lines.

use super::Args;
use crate::progress::Part;
use crate::{accuracy, arguments, integral, output, profile, sample, variance};
use anyhow::Result;
use indicatif::ProgressBar;

/// What a step of each takes, roughly \[ns\]: the time left depends on it, and nothing else.
const TIME: usize = 60;
const SAMPLE: usize = 60;
const ERROR: usize = 4_300;
const VARIANCE: usize = 220_000;
const INTEGRAL: usize = 60_000_000;
const RESAMPLING: usize = 160;

/// A subcommand's arguments, and the line that they come from.
struct Job<A> {
    line: String,
    args: A,
}

impl<A: clap::Args> Job<A> {
    fn new(command: &str, options: &[String]) -> Result<Self> {
        Ok(Self { line: format!("airlight {command} {}", options.join(" ")), args: arguments::parse(options)? })
    }
}

/// All of them.
pub(super) struct Jobs {
    profile: Job<profile::Args>,
    broad: Job<variance::Args>,
    canonical: Job<variance::Args>,
    accuracy: Job<accuracy::Args>,
    sample: Job<sample::Args>,
    integral: Job<integral::Args>,
}

/// What they found.
pub(super) struct Measured {
    pub(super) profile: profile::Figures,
    pub(super) broad: variance::Figures,
    pub(super) canonical: variance::Figures,
    pub(super) accuracy: accuracy::Figures,
    pub(super) sample: sample::Figures,
    /// Of the same wavefront.
    pub(super) resampled: sample::Resampled,
    pub(super) integral: integral::Figures,
}

impl Jobs {
    pub(super) fn new(args: &Args) -> Result<Self> {
        let size = |given: Option<usize>, full: usize, quick: usize| {
            given.unwrap_or(if args.quick { quick } else { full }).to_string()
        };
        let option = |name: &str, value: &str| [format!("--{name}"), value.to_owned()];
        let mut timing: Vec<String> = args.quick.then(|| "--quick".to_owned()).into_iter().collect();
        timing.extend(args.batch.iter().flat_map(|batch| option("rays", &batch.to_string())));
        timing.extend(args.rounds.iter().flat_map(|rounds| option("rounds", &rounds.to_string())));
        timing.extend(args.peers.iter().flat_map(|peers| option("peers", peers)));
        let precisions: Vec<String> = args.precision.iter().flat_map(|p| option("precision", p.name())).collect();
        let main_precision = option("precision", args.main_precision().name());
        timing.extend(precisions.clone());
        let scenes = option("scenes", &size(args.scenes, 2000, 400));
        let set = |name| [option("set", name), scenes.clone()].concat();
        let rays = option("rays", &size(args.rays, 1 << 20, 1 << 16));
        let samples = option("rays", &size(args.samples, 16_000_000, 1 << 19));
        // Of the wavefront the errors are taken from the samples: the oracle need not look at many.
        let check = option("check", "256");
        Ok(Self {
            profile: Job::new("profile", &timing)?,
            broad: Job::new("variance", &set("broad"))?,
            canonical: Job::new("variance", &set("canonical"))?,
            accuracy: Job::new(
                "accuracy",
                &[&option("family", "generic")[..], &option("seed", "1"), &rays, &precisions].concat(),
            )?,
            sample: Job::new("sample", &[&samples[..], &check, &main_precision].concat())?,
            integral: Job::new("integral", &[set("generic"), main_precision.to_vec()].concat())?,
        })
    }

    /// The command lines.
    pub(super) fn commands(&self) -> [&str; 6] {
        let Self { profile, broad, canonical, accuracy, sample, integral } = self;
        [&profile.line, &broad.line, &canonical.line, &accuracy.line, &sample.line, &integral.line]
    }

    /// The length of a bar for [`measure`](Self::measure).
    pub(super) fn steps(&self) -> Result<usize> {
        let variances = self.broad.args.steps() + self.canonical.args.steps();
        let parts = [
            (self.profile.args.steps()?, TIME),
            (variances, VARIANCE),
            (self.accuracy.args.steps()?, ERROR),
            (self.sample.args.steps()?, SAMPLE),
            (self.sample.args.rays(), RESAMPLING),
            (self.integral.args.steps(), INTEGRAL),
        ];
        Ok(parts.into_iter().fold(0, |sum, (steps, step)| sum.saturating_add(steps.saturating_mul(step))))
    }

    pub(super) fn measure(&self, bar: &ProgressBar) -> Result<Measured> {
        let part = |step| Part::weighted(bar, step);
        Ok(Measured {
            profile: profile::measure(&self.profile.args, part(TIME))?,
            broad: variance::measure(&self.broad.args, part(VARIANCE))?,
            canonical: variance::measure(&self.canonical.args, part(VARIANCE))?,
            accuracy: accuracy::measure(&self.accuracy.args, part(ERROR))?,
            sample: sample::measure(&self.sample.args, part(SAMPLE))?.0,
            resampled: sample::resample(&self.sample.args, part(RESAMPLING))?,
            integral: integral::measure(&self.integral.args, part(INTEGRAL))?,
        })
    }
}

impl Measured {
    /// The JSON files, as `--json` of the subcommands writes them.
    pub(super) fn files(&self) -> Result<[(&'static str, Vec<u8>); 7]> {
        Ok([
            ("profile.json", output::json(&self.profile)?),
            ("variance-broad.json", output::json(&self.broad)?),
            ("variance-canonical.json", output::json(&self.canonical)?),
            ("accuracy.json", output::json(&self.accuracy)?),
            ("sample.json", output::json(&self.sample)?),
            ("resampling.json", output::json(&self.resampled)?),
            ("integral.json", output::json(&self.integral)?),
        ])
    }
}
