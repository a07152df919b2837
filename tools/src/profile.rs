//! `airlight profile`: how fast the kernels are, stage by stage, beside what the machine allows.

mod arithmetic;
mod clock;
mod figures;
mod instructions;
mod peers;
mod rounds;
mod streams;
mod subject;
mod work;

use self::arithmetic::{Need, Strain};
pub(crate) use self::figures::{Figures, Row};
use self::peers::{Peer, Peers};
use self::rounds::take_turns;
use self::streams::Stream;
use self::work::{Contestant, LEAST, Work};
use crate::arguments::{self, Json};
use crate::progress::Part;
use crate::{output, progress};
use airlight::{Backend, Limit, Stage, Strategy};
use airlight_tools::threads;
use airlight_tools::workload::{Wanted, Workload};
use anyhow::{Context, Result};
use rayon::ThreadPool;
use std::path::PathBuf;

/// Sizes of batches, unless told otherwise: from what a core's cache holds to what only memory does.
const SIZES: [usize; 4] = [1 << 12, 1 << 16, 1 << 20, 1 << 24];
/// The larger ones take a while, so that they are left to the faster backends unless told otherwise.
const LARGEST_OF_ALL: usize = 1 << 16;
const LARGEST_OF_PORTABLE: usize = 1 << 20;
/// Rays whose operations are counted.
const COUNTED: usize = 4096;
/// Samples that share the set-up of one ray, where they do.
const SHARED: usize = 8;
/// Rays of calls that have few.
const FEW: [usize; 5] = [1, 8, 33, 64, 1000];
/// Rays and samples for each of them, where these are many, and the strategy that is measured so.
const MANY: [(usize, usize); 2] = [(1, 1 << 22), (1 << 17, 1 << 5)];
const OF_MANY: Strategy = Strategy::Product9;

/// Measure how fast every kernel is, its stages apart, beside what the machine allows
#[derive(Debug, clap::Args)]
pub(crate) struct Args {
    /// Rays of a batch, may be repeated [default: 4096, 65536, 1048576, 16777216]
    #[arg(long, value_name = "RAYS", value_parser = arguments::batch)]
    rays: Vec<usize>,
    /// Threads to sample with, may be repeated [default: one, and one per core]
    #[arg(long, value_name = "N", value_parser = arguments::threads)]
    threads: Vec<usize>,
    /// Strategy to measure, may be repeated [default: all]
    #[arg(long, value_name = "NAME")]
    strategy: Vec<Strategy>,
    /// Backend to measure, may be repeated [default: all of this machine, the slower ones on smaller batches]
    #[arg(long, value_name = "NAME", value_parser = arguments::backend)]
    backend: Vec<Backend>,
    /// Rounds in which all take their turn; reported are medians over these [default: 9, or 3 with --quick]
    #[arg(long, value_name = "ROUNDS", value_parser = arguments::positive)]
    rounds: Option<usize>,
    /// Fewer rounds, and batches of 65536 and 1048576 rays unless told otherwise
    #[arg(long)]
    quick: bool,
    /// Measure the kernels of a shared library as well
    #[arg(long, value_name = "LIBRARY.so")]
    peers: Option<PathBuf>,
    /// Count instructions per ray with valgrind, and measure no time
    #[arg(long, conflicts_with_all = ["rays", "threads", "rounds", "quick", "peers"])]
    instructions: bool,
    /// Only draw samples, so many batches of them: what is counted by --instructions
    #[arg(long, hide = true, requires_all = ["strategy", "backend"])]
    batches: Option<usize>,
    #[command(flatten)]
    json: Json,
}

/// Measures.
pub(crate) fn run(args: &Args) -> Result<()> {
    if let Some(batches) = args.batches {
        return instructions::sample(&args.strategy, &args.backend, batches);
    }
    let json = args.json.target()?;
    if args.instructions {
        return match instructions::count(&args.strategies(), &args.backend)? {
            Some(figures) => output::report(&figures, json.as_ref()),
            None => Ok(()),
        };
    }
    let progress = progress::bar(args.steps()?)?;
    let figures = measure(args, Part::whole(&progress))?;
    progress.finish_and_clear();
    output::report(&figures, json.as_ref())
}

/// The times of everything that was asked for.
pub(crate) fn measure(args: &Args, progress: Part<'_>) -> Result<Figures> {
    let peers = args.peers.as_deref().map(Peers::load).transpose()?;
    let pools = Pools::new(args)?;
    let (sizes, rounds) = (args.sizes(), args.rounds());
    let largest = sizes.iter().copied().max().unwrap_or(0);
    let many = if args.has_many() { &MANY[..] } else { &[] };
    let rays = many.iter().map(|(rays, _)| *rays).fold(largest.max(LEAST), usize::max);
    let samples = many.iter().map(|(rays, per_ray)| rays * per_ray).fold(rays, usize::max);
    let mut workload = Workload::with_variates(rays, samples);

    progress.tell("limits of arithmetic");
    let strains = take_turns(args.strains(&pools.wanted), rounds, Strain::time)?;
    let counted = COUNTED.min(largest);
    let need = |&strategy: &Strategy| Ok((strategy, Need::of(strategy, counted, &mut workload)?));
    let needs: Vec<(Strategy, Need)> = args.strategies().iter().map(need).collect::<Result<_>>()?;

    let mut measured: Vec<_> = strains.into_iter().map(|(strain, times)| (strain.subject(), times)).collect();
    for (name, contestants) in args.groups(&pools, peers.as_ref()) {
        progress.tell(name);
        let group = take_turns(contestants, rounds, |contestant| {
            let time = contestant.time(&mut workload);
            progress.inc(contestant.taken());
            time
        })?;
        measured.extend(group.into_iter().map(|(contestant, times)| (contestant.subject(), times)));
    }
    Ok(Figures::new(&measured, &needs))
}

/// Threads to measure on.
struct Pools {
    /// Those that were asked for.
    wanted: Vec<ThreadPool>,
    /// One thread.
    one: ThreadPool,
}

impl Pools {
    fn new(args: &Args) -> Result<Self> {
        let pool = |n| threads::pool(n).context("cannot start the threads");
        let threads = if args.threads.is_empty() { threads::one_and_all() } else { args.threads.clone() };
        Ok(Self { wanted: threads.into_iter().map(pool).collect::<Result<_>>()?, one: pool(1)? })
    }
}

impl Args {
    /// Samples to draw in all.
    pub(crate) fn steps(&self) -> Result<usize> {
        let pools = Pools::new(self)?;
        let groups = self.groups(&pools, None);
        let ours: usize = groups.iter().flat_map(|(_, contestants)| contestants).map(Contestant::taken).sum();
        let peers = if self.peers.is_some() { Peer::ALL.len() } else { 0 };
        let theirs = peers * self.sizes().iter().map(|&rays| rays.max(LEAST)).sum::<usize>();
        Ok((ours + theirs).saturating_mul(self.rounds() + 1))
    }

    fn rounds(&self) -> usize {
        self.rounds.unwrap_or(if self.quick { 3 } else { 9 })
    }

    fn strategies(&self) -> Vec<Strategy> {
        if self.strategy.is_empty() { Strategy::ALL.to_vec() } else { self.strategy.clone() }
    }

    fn sizes(&self) -> Vec<usize> {
        let default = if self.quick { &SIZES[1..3] } else { &SIZES };
        if self.rays.is_empty() { default.to_vec() } else { self.rays.clone() }
    }

    /// The backends to measure on batches of that size, the fastest first.
    fn backends(&self, rays: usize) -> Vec<Backend> {
        if !self.backend.is_empty() {
            return self.backend.clone();
        }
        let all = Backend::available().enumerate().filter(|(index, backend)| match backend.name() {
            _ if *index == 0 => true,
            "portable" => rays <= LARGEST_OF_PORTABLE,
            _ => rays <= LARGEST_OF_ALL,
        });
        all.map(|(_, backend)| backend).collect()
    }

    /// The limits of arithmetic.
    fn strains<'a>(&self, pools: &'a [ThreadPool]) -> Vec<Strain<'a>> {
        let mut strains = Vec::new();
        for backend in self.backends(0) {
            for limit in [Limit::MultiplyAdd, Limit::Division] {
                strains.extend(pools.iter().map(|pool| Strain { limit, backend, pool }));
            }
        }
        strains
    }

    /// Whether many samples for each of few rays are measured.
    fn has_many(&self) -> bool {
        !self.quick && self.strategies().contains(&OF_MANY)
    }

    /// The fastest of the backends to measure.
    fn fastest(&self) -> Option<Backend> {
        let wanted = |name| self.backend.is_empty() || self.backend.iter().any(|backend| backend.name() == name);
        Backend::available().find(|backend| wanted(backend.name()))
    }

    /// All that is measured but for the arithmetic: contestants that take turns, and what they have in common.
    fn groups<'a>(&self, pools: &'a Pools, peers: Option<&'a Peers>) -> Vec<(String, Vec<Contestant<'a>>)> {
        let batches = |&rays: &usize| (format!("batches of {rays}"), self.batches(rays, &pools.wanted, peers));
        let mut groups: Vec<_> = self.sizes().iter().map(batches).collect();
        groups.push(("calls of few rays".to_owned(), self.calls(&pools.one)));
        groups.push(("few rays, many variates".to_owned(), self.many(&pools.wanted)));
        groups
    }

    /// Calls of few rays, one thread.
    fn calls<'a>(&self, pool: &'a ThreadPool) -> Vec<Contestant<'a>> {
        let Some(backend) = self.fastest() else { return Vec::new() };
        let of_strategy = |strategy| {
            let one = Contestant { work: Work::OneByOne { strategy, backend }, samples: 1, pool };
            let calls = move |samples| Contestant { work: Work::Calls { strategy, backend }, samples, pool };
            [one].into_iter().chain(FEW.map(calls))
        };
        self.strategies().into_iter().flat_map(of_strategy).collect()
    }

    /// Many samples for each of few rays.
    fn many<'a>(&self, pools: &'a [ThreadPool]) -> Vec<Contestant<'a>> {
        let Some(backend) = self.fastest().filter(|_| self.has_many()) else { return Vec::new() };
        let of_pool = |pool| {
            MANY.map(|(rays, per_ray)| {
                let work = Work::Sample { strategy: OF_MANY, backend, per_ray, wanted: Wanted::Densities };
                Contestant { work, samples: rays * per_ray, pool }
            })
        };
        pools.iter().flat_map(of_pool).collect()
    }

    /// All that is measured on batches of one size.
    fn batches<'a>(&self, rays: usize, pools: &'a [ThreadPool], peers: Option<&'a Peers>) -> Vec<Contestant<'a>> {
        let backends = self.backends(rays);
        let strategies = self.strategies();
        let mut contestants = Vec::new();
        for pool in pools {
            let alone = pool.current_num_threads() == 1;
            let mut enter = |work| contestants.push(Contestant { work, samples: rays, pool });
            Stream::ALL.into_iter().for_each(|stream| enter(Work::Stream(stream)));
            for &backend in &backends {
                for &strategy in &strategies {
                    let sample = |per_ray, wanted| Work::Sample { strategy, backend, per_ray, wanted };
                    enter(sample(1, Wanted::Densities));
                    if alone && rays <= LARGEST_OF_ALL {
                        for stage in [Stage::Geometry, Stage::SetUp, Stage::Inversion] {
                            enter(Work::UpTo { strategy, backend, stage });
                        }
                        enter(sample(1, Wanted::Weights));
                        if rays.is_multiple_of(SHARED) {
                            enter(sample(SHARED, Wanted::Densities));
                        }
                    }
                }
            }
            if let Some(peers) = peers.filter(|_| alone) {
                Peer::ALL.into_iter().for_each(|peer| enter(Work::Peer(peers, peer)));
            }
        }
        contestants
    }
}
