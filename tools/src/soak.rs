//! `airlight soak`: random batches of all families, in all forms that a call takes, for as long as one likes, held against what
//! is promised; or rays of random bits.

mod bits;

use crate::arguments::{self, Json};
use crate::output;
use airlight::{Backend, Integral, Nodes, Precision, Rays, Sampler};
use airlight_tools::batch::{Columns, FORMS, push};
use airlight_tools::bounds::bounds;
use airlight_tools::errors::Errors;
use airlight_tools::families::{self, Case, Family};
use airlight_tools::promises::{Again, Choices, Kept};
use airlight_tools::room::Random;
use airlight_tools::{samplers, variates};
use anyhow::Result;
use rayon::prelude::*;
use serde::Serialize;
use std::fmt;
use std::panic::catch_unwind;
use std::process::ExitCode;
use std::time::{Duration, Instant};

/// Exit code where a promise is broken.
const BROKEN: u8 = 1;
/// Rounds between two looks at the clock.
const STEP: u64 = 32;
/// Failures that are printed.
const TOLD: usize = 20;
/// Rays of a round that are compared with the oracle.
const COMPARED: usize = 64;
/// The figures of `airlight accuracy` that no single ray may exceed, whatever its family.
const FIGURES: [&str; 4] = ["nonfinite", "out_of_range", "cdf_beyond_t_max", "cdf_at_t_max"];

/// Check all promises on random batches, in all forms, on all backends; exit with 1 if one is broken
#[derive(Debug, clap::Args)]
#[command(
    after_help = "Examples:\n  airlight soak --minutes 10 --seed 7\n  airlight soak --seed 7 --first 1234 --rounds 1     one round again"
)]
pub(crate) struct Args {
    /// Minutes to run
    #[arg(long, value_name = "MINUTES", default_value = "1", value_parser = arguments::minutes)]
    minutes: Duration,
    /// Rounds to run, in place of --minutes
    #[arg(long, value_name = "ROUNDS", conflicts_with = "minutes")]
    rounds: Option<u64>,
    /// Number of the first round, to repeat one that failed
    #[arg(long, value_name = "ROUND", default_value_t = 0)]
    first: u64,
    /// Rounds of 2^14 rays of random bits, one call on two backends for each, as fast as can be; nothing is compared with the oracle
    #[arg(long)]
    bits: bool,
    /// Seed of the rounds
    #[arg(long, default_value_t = 0)]
    seed: u64,
    #[command(flatten)]
    json: Json,
}

/// Runs it.
pub(crate) fn run(args: &Args) -> Result<ExitCode> {
    let json = args.json.target()?;
    let figures = measure(args);
    output::report(&figures, json.as_ref())?;
    Ok(if figures.failures == 0 { ExitCode::SUCCESS } else { ExitCode::from(BROKEN) })
}

fn measure(args: &Args) -> Figures {
    let (start, mut figures) = (Instant::now(), Figures { seed: args.seed, bits: args.bits, ..Figures::default() });
    let more = |done: u64| args.rounds.map_or_else(|| start.elapsed() < args.minutes, |rounds| done < rounds);
    while more(figures.rounds) {
        let step = args.rounds.map_or(STEP, |rounds| STEP.min(rounds - figures.rounds));
        let first = args.first + figures.rounds;
        let tried: Vec<_> = (first..first + step).into_par_iter().map(|round| (round, guarded(args, round))).collect();
        tried.into_iter().for_each(|(round, tried)| figures.add(round, tried));
    }
    figures
}

/// What the rounds came to; the names of the fields are the keys of the JSON.
#[derive(Default, Serialize)]
struct Figures {
    seed: u64,
    bits: bool,
    rounds: u64,
    rays: usize,
    results: usize,
    compared: usize,
    failures: usize,
    /// The first of them.
    told: Vec<String>,
}

impl Figures {
    fn add(&mut self, round: u64, tried: Result<Tried, String>) {
        self.rounds += 1;
        match tried {
            Ok(Tried { rays, results, compared }) => {
                self.rays += rays;
                self.results += results;
                self.compared += compared;
            }
            Err(broken) => {
                self.failures += 1;
                if self.told.len() < TOLD {
                    let (seed, bits) = (self.seed, if self.bits { "--bits " } else { "" });
                    self.told.push(format!("{bits}--seed {seed} --first {round} --rounds 1: {broken}"));
                }
            }
        }
    }
}

impl fmt::Display for Figures {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { seed, bits, rounds, rays, results, compared, failures, told } = self;
        told.iter().try_for_each(|told| writeln!(f, "BROKEN: {told}"))?;
        writeln!(f, "seed {seed}, {rounds} rounds: {rays} rays, {failures} failures")?;
        if *bits {
            writeln!(
                f,
                "  results     {results}: values of a call on a backend, compared with those of another with fused"
            )?;
            return writeln!(f, "              multiply-add or of the batch in two parts, and finite and in range");
        }
        writeln!(
            f,
            "  results     {results}: values of a call on a backend, compared with those of the other backends with"
        )?;
        writeln!(f, "              fused multiply-add and of the batch in two parts, and finite and in range")?;
        writeln!(
            f,
            "  compared    {compared} rays with the oracle: |CDF - u| and the error of cdf, within their bounds"
        )
    }
}

/// What a round tried.
struct Tried {
    rays: usize,
    results: usize,
    compared: usize,
}

/// A round, whose panic is a failure.
fn guarded(args: &Args, round: u64) -> Result<Tried, String> {
    let tried =
        || if args.bits { bits::run(&mut random(args.seed, round)) } else { Round::new(args.seed, round).run() };
    catch_unwind(tried).unwrap_or_else(|_| Err("panic".to_owned()))
}

/// All that a round draws depends on seed and number alone.
fn random(seed: u64, round: u64) -> Random {
    Random::new(variates::bits(seed, round))
}

/// One round.
struct Round {
    /// Of the families' cases.
    seed: u64,
    random: Random,
}

impl Round {
    fn new(seed: u64, round: u64) -> Self {
        Self { seed: variates::bits(seed, round), random: random(seed, round) }
    }

    fn run(mut self) -> Result<Tried, String> {
        // Few rays, or more than one thread takes.
        let n = if self.below(64) == 0 { 4097 + self.below(5000) } else { 1 + self.below(200) } as usize;
        let per_ray = if n > 200 { 1 } else { [1, 1, 1, 2, 3, 7, 33][self.below(7) as usize] };
        // One family, or all of them side by side.
        let family = Family::ALL[self.below(Family::ALL.len() as u64) as usize];
        let mixed = self.below(4) == 0;
        let case = |i: usize| if mixed { Family::ALL[i % Family::ALL.len()] } else { family }.case(self.seed, i as u64);
        let cases: Vec<Case> = (0..n).map(case).collect();
        let columns = self.columns(&cases, per_ray);

        let all: Vec<Sampler> = samplers::all().collect();
        let sampler = all[self.below(all.len() as u64) as usize];
        let nodes = Nodes::ALL[self.below(Nodes::ALL.len() as u64) as usize];
        let integral = Integral::new(nodes).with_precision(sampler.precision());
        let table = columns.emitters();
        let weights = table.iter().map(|_| self.below(5) as f32).collect();
        let choices = Choices { table, weights };
        let (form, cut) = (self.below(FORMS as u64) as usize, self.below(n as u64) as usize);
        let batch = columns.batch(form, |n| self.below(n));
        let again = Again::Everywhere { cut };
        let place = |broken: String| {
            let name = if mixed { "all families" } else { family.name() };
            format!("{name}, {n} rays, {per_ray} variates each, form {form}: {broken}")
        };
        let results: Kept = [
            batch.hold_sample(&sampler, again),
            batch.hold_densities(&sampler, again),
            batch.hold_radiance(&integral, again),
            batch.hold_choose(&integral, &choices, again),
        ]
        .into_iter()
        .sum();
        let results = results.map_err(place)?;

        let backends: Vec<Backend> = Backend::available().collect();
        let backend = backends[self.below(backends.len() as u64) as usize];
        let compared = compare(&sampler.with_backend(backend), family, self.seed)?;
        Ok(Tried { rays: n, results, compared })
    }

    fn below(&mut self, n: u64) -> u64 {
        self.random.below(n)
    }

    /// The cases as columns of every form. The channels of a colour are the media of rays next to each other.
    fn columns(&mut self, cases: &[Case], per_ray: usize) -> Columns {
        let given = families::Columns::new(cases);
        let (Rays { origin, direction, t_min, t_max, .. }, position, normal) =
            (given.rays(), given.position(), given.normal());
        let (cones, [mu_a, mu_s, g]) = (given.cones(), given.medium());
        let mut columns = Columns::default();
        for i in 0..cases.len() {
            let ([ox, oy, oz], [dx, dy, dz]) = (origin.map(|x| x[i]), direction.map(|x| x[i]));
            let ([px, py, pz], [nx, ny, nz]) = (position.map(|x| x[i]), normal.map(|x| x[i]));
            let [outer, inner] = cones.map_or([-1.0; 2], |cones| cones.map(|x| x[i]));
            let channel = |of: &[f32]| [0, 1, 2, 3].map(|c| of[(i + c) % of.len()]);
            let ([a0, a1, a2, a3], [s0, s1, s2, s3]) = (channel(mu_a), channel(mu_s));
            push(&mut columns.rays, [ox, oy, oz, dx, dy, dz, t_min[i], t_max[i]]);
            push(&mut columns.lights, [px, py, pz, nx, ny, nz, outer, inner]);
            push(&mut columns.fog, [a0, a1, a2, a3, s0, s1, s2, s3, g[i]]);
            columns.u.extend(
                (0..per_ray).map(|k| if k == 0 { given.u[i] } else { self.below(1 << 24) as f32 * 2f32.powi(-24) }),
            );
            // Anywhere on the ray and a little beyond, at its ends, or any bits.
            let end = t_max[i].min(t_min[i] + 20.0);
            columns.t.extend((0..per_ray).map(|_| match self.below(8) {
                0 => f32::from_bits(self.below(1 << 32) as u32),
                1 => t_min[i],
                2 => t_max[i],
                _ => t_min[i] + (end - t_min[i]) * 1.1 * self.below(1 << 24) as f32 * 2f32.powi(-24),
            }));
        }
        columns
    }
}

/// Holds a sampler against the oracle on some rays of a family; returns how many of them have a sample.
fn compare(sampler: &Sampler, family: Family, seed: u64) -> Result<usize, String> {
    let errors = Errors::measure(sampler, family, COMPARED, seed, |_| ());
    let bounds = bounds(sampler.strategy(), sampler.precision(), family);
    let looked_at = bounds.iter().filter(|bound| FIGURES.contains(&bound.figure));
    for bound in looked_at {
        let figure = (bound.read)(&errors);
        // NaN: there is no ray to look at.
        if figure > bound.limit {
            let (strategy, precision, backend) = (sampler.strategy(), sampler.precision(), sampler.backend().name());
            let (name, family, limit) = (bound.figure, family.name(), bound.limit);
            return Err(format!("{family}, {strategy} {precision}, {backend}: {name} = {figure:e} exceeds {limit:e}"));
        }
    }
    Ok(if sampler.precision() == Precision::Exact { errors.sampled } else { 0 })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn soak(first: u64, rounds: u64, seed: u64, bits: bool) -> Figures {
        measure(&Args { minutes: Duration::ZERO, rounds: Some(rounds), first, bits, seed, json: Json::default() })
    }

    #[test]
    fn random_batches_keep_every_promise() {
        let seed = std::process::id().into();
        let figures = soak(0, 300, seed, false);
        assert_eq!(figures.failures, 0, "{figures}");
        assert!(figures.rays > 10_000 && figures.compared > 1_000, "{figures}");
    }

    #[test]
    fn random_bits_keep_every_promise() {
        let seed = std::process::id().into();
        let figures = soak(0, 20, seed, true);
        assert_eq!(figures.failures, 0, "{figures}");
        assert_eq!(figures.rays, 20 << 14, "{figures}");
    }

    #[test]
    fn a_round_can_be_repeated() {
        for bits in [false, true] {
            let [whole, first, second] = [soak(3, 2, 7, bits), soak(3, 1, 7, bits), soak(4, 1, 7, bits)];
            assert_eq!((whole.rays, whole.results), (first.rays + second.rays, first.results + second.results));
        }
    }
}
