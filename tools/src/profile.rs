//! `airlight profile`: how fast the kernels are, stage by stage, beside what the machine allows.

mod arithmetic;
pub(crate) mod clock;
mod figures;
mod instructions;
mod peers;
pub(crate) mod rounds;
mod streams;
mod subject;
mod work;

use self::arithmetic::{Need, Strain};
pub(crate) use self::figures::{Figures, Row};
use self::peers::{Peer, Peers, Source};
use self::rounds::take_turns;
use self::streams::Stream;
use self::subject::Subject;
use self::work::{Contestant, Kernel, LEAST, Work};
use crate::arguments::{self, Json, Samplers};
use crate::progress::Part;
use crate::{output, progress};
use airlight::{Backend, Integral, Limit, Nodes, Precision, Sampler, Stage, Strategy};
use airlight_tools::threads;
use airlight_tools::workload::{Wanted, Workload};
use anyhow::{Context, Result, ensure};
use rayon::ThreadPool;

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
/// Rays of which the integral is measured, and emitters of a choice.
const INTEGRALS: usize = 1 << 16;
const EMITTERS: usize = 32;

/// Measure the time of every kernel and of its stages, beside the limits of the machine
#[derive(Debug, clap::Args)]
#[command(
    after_help = "Examples:\n  airlight profile --quick\n  airlight profile --rays 65536 --threads 1 --backend avx2"
)]
pub(crate) struct Args {
    /// Rays per batch, may be repeated [default: 4096, 65536, 1048576, 16777216]
    #[arg(long, value_name = "RAYS", value_parser = arguments::batch)]
    rays: Vec<usize>,
    /// Threads to sample with, may be repeated [default: one, and one per core]
    #[arg(long, value_name = "N", value_parser = arguments::threads)]
    threads: Vec<usize>,
    #[command(flatten)]
    samplers: Samplers,
    /// Backend to measure, may be repeated [default: all of this machine, the slower ones on smaller batches]
    #[arg(long, value_name = "NAME", value_parser = arguments::backend)]
    backend: Vec<Backend>,
    /// Rounds of measurement, in each of which all kernels take their turn; medians are reported [default: 9, or 3 with --quick]
    #[arg(long, value_name = "ROUNDS", value_parser = arguments::positive)]
    rounds: Option<usize>,
    /// Fewer rounds, and batches of 65536 and 1048576 rays unless told otherwise
    #[arg(long)]
    quick: bool,
    /// Also measure the kernels of a shared library, beside the backend of their width; may be repeated, once for each
    /// backend [default backend: the fastest that is measured]
    #[arg(long, value_name = "[BACKEND=]LIBRARY.so")]
    peers: Vec<Source>,
    /// Count instructions per ray with valgrind, and measure no time
    #[arg(long, conflicts_with_all = ["rays", "threads", "rounds", "quick", "peers"])]
    instructions: bool,
    /// Only draw samples, for this many batches: --instructions counts this process
    #[arg(long, hide = true, requires_all = ["strategy", "precision", "backend"])]
    batches: Option<usize>,
    #[command(flatten)]
    json: Json,
}

/// Measures.
pub(crate) fn run(args: &Args) -> Result<()> {
    if let Some(batches) = args.batches {
        return instructions::sample(&args.samplers.all()?, &args.backend, batches);
    }
    let json = args.json.target()?;
    if args.instructions {
        return match instructions::count(&args.samplers.all()?, &args.backend)? {
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
    let samplers = args.samplers.all()?;
    let peers = args.peers()?;
    let pools = Pools::new(args)?;
    let (sizes, rounds) = (args.sizes(), args.rounds());
    let largest = sizes.iter().copied().max().unwrap_or(0);
    let many = if args.has_many(&samplers) { &MANY[..] } else { &[] };
    let rays = many.iter().map(|(rays, _)| *rays).fold(largest.max(LEAST), usize::max);
    let samples = many.iter().map(|(rays, per_ray)| rays * per_ray).fold(rays, usize::max);
    let mut workload = Workload::with_variates(rays, samples);

    progress.tell("limits of arithmetic");
    let strains = take_turns(args.strains(&pools.wanted), rounds, Strain::time)?;
    let counted = COUNTED.min(largest);
    let need = |sampler: &Sampler| Ok((*sampler, Need::of(sampler, counted, &mut workload)?));
    let needs: Vec<(Sampler, Need)> = samplers.iter().map(need).collect::<Result<_>>()?;
    let mut errors = Vec::new();
    for peers in &peers {
        progress.tell(format!("errors of peers, {}", peers.backend.name()));
        let error = |peer| (peers.subject(peer, Subject::default()), peers.cdf_p999(peer, LEAST, &mut workload));
        errors.extend(Peer::ALL.map(error));
    }

    let mut measured: Vec<_> = strains.into_iter().map(|(strain, times)| (strain.subject(), times)).collect();
    for (name, contestants) in args.groups(&samplers, &pools, &peers) {
        progress.tell(name);
        let group = take_turns(contestants, rounds, |contestant| {
            let time = contestant.time(&mut workload);
            progress.inc(contestant.taken());
            time
        })?;
        measured.extend(group.into_iter().map(|(contestant, times)| (contestant.subject(), times)));
    }
    Ok(Figures::new(&measured, &needs, &errors))
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
        let groups = self.groups(&self.samplers.all()?, &pools, &[]);
        let ours: usize = groups.iter().flat_map(|(_, contestants)| contestants).map(Contestant::taken).sum();
        let peers = self.peers.len() * Peer::ALL.len();
        let theirs = peers * self.sizes().iter().map(|&rays| rays.max(LEAST)).sum::<usize>();
        Ok((ours + theirs).saturating_mul(self.rounds() + 1))
    }

    fn rounds(&self) -> usize {
        self.rounds.unwrap_or(if self.quick { 3 } else { 9 })
    }

    /// The libraries of peers.
    fn peers(&self) -> Result<Vec<Peers>> {
        let mut loaded: Vec<Peers> = Vec::new();
        for Source { backend, path } in &self.peers {
            let backend = backend.or(self.fastest()).context("no backend is measured")?;
            let name = backend.name();
            let measured = self.backend.is_empty() || self.backend.iter().any(|backend| backend.name() == name);
            ensure!(measured, "--peers {name}={}: the backend {name} is not measured", path.display());
            let twice = loaded.iter().any(|peers| peers.backend.name() == name);
            ensure!(!twice, "--peers {name}={}: there is another library for {name}", path.display());
            loaded.push(Peers::load(path, backend)?);
        }
        Ok(loaded)
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
    fn has_many(&self, samplers: &[Sampler]) -> bool {
        !self.quick && samplers.iter().any(|sampler| sampler.strategy() == OF_MANY)
    }

    /// The fastest of the backends to measure.
    fn fastest(&self) -> Option<Backend> {
        let wanted = |name| self.backend.is_empty() || self.backend.iter().any(|backend| backend.name() == name);
        Backend::available().find(|backend| wanted(backend.name()))
    }

    /// All that is measured but for the arithmetic: contestants that take turns, and what they have in common.
    fn groups<'a>(
        &self,
        samplers: &[Sampler],
        pools: &'a Pools,
        peers: &'a [Peers],
    ) -> Vec<(String, Vec<Contestant<'a>>)> {
        let of_size = |rays| self.batches(rays, samplers, &pools.wanted, peers);
        let batches = |&rays: &usize| (format!("batches of {rays}"), of_size(rays));
        let mut groups: Vec<_> = self.sizes().iter().map(batches).collect();
        groups.push(("calls of few rays".to_owned(), self.calls(samplers, &pools.one)));
        groups.push(("few rays, many variates".to_owned(), self.many(samplers, &pools.wanted)));
        groups.push(("the integral".to_owned(), self.integrals(samplers, &pools.one)));
        groups
    }

    /// Calls of few rays, one thread.
    fn calls<'a>(&self, samplers: &[Sampler], pool: &'a ThreadPool) -> Vec<Contestant<'a>> {
        let Some(backend) = self.fastest() else { return Vec::new() };
        let of_sampler = |sampler| {
            let kernel = Kernel::new(sampler, backend);
            let one = Contestant { work: Work::OneByOne(kernel), samples: 1, pool };
            let calls = move |samples| Contestant { work: Work::Calls(kernel), samples, pool };
            [one].into_iter().chain(FEW.map(calls))
        };
        samplers.iter().flat_map(of_sampler).collect()
    }

    /// Many samples for each of few rays.
    fn many<'a>(&self, samplers: &[Sampler], pools: &'a [ThreadPool]) -> Vec<Contestant<'a>> {
        let Some(backend) = self.fastest().filter(|_| self.has_many(samplers)) else { return Vec::new() };
        let mut contestants = Vec::new();
        for pool in pools {
            for sampler in samplers.iter().filter(|sampler| sampler.strategy() == OF_MANY) {
                let kernel = Kernel::new(sampler, backend);
                contestants.extend(MANY.map(|(rays, per_ray)| {
                    let work = Work::Sample { kernel, per_ray, wanted: Wanted::Densities };
                    Contestant { work, samples: rays * per_ray, pool }
                }));
            }
        }
        contestants
    }

    /// The integral by nodes and a choice by it, one thread, in every precision that a sampler has.
    fn integrals<'a>(&self, samplers: &[Sampler], pool: &'a ThreadPool) -> Vec<Contestant<'a>> {
        let has = |precision: &&Precision| samplers.iter().any(|sampler| sampler.precision() == **precision);
        let mut contestants = Vec::new();
        for backend in self.backends(INTEGRALS) {
            for &precision in Precision::ALL.iter().filter(has) {
                let integral = |nodes| Integral::new(nodes).with_precision(precision).with_backend(backend);
                let works = Nodes::ALL.iter().map(|&nodes| Work::Radiance(integral(nodes)));
                let works = works.chain([Work::Choose(integral(Nodes::Four), EMITTERS)]);
                contestants.extend(works.map(|work| Contestant { work, samples: INTEGRALS, pool }));
            }
        }
        contestants
    }

    /// All that is measured on batches of one size.
    fn batches<'a>(
        &self,
        rays: usize,
        samplers: &[Sampler],
        pools: &'a [ThreadPool],
        peers: &'a [Peers],
    ) -> Vec<Contestant<'a>> {
        let backends = self.backends(rays);
        let mut contestants = Vec::new();
        for pool in pools {
            let alone = pool.current_num_threads() == 1;
            let mut enter = |work| contestants.push(Contestant { work, samples: rays, pool });
            Stream::ALL.into_iter().for_each(|stream| enter(Work::Stream(stream)));
            for &backend in &backends {
                for sampler in samplers {
                    let kernel = Kernel::new(sampler, backend);
                    let sample = |per_ray, wanted| Work::Sample { kernel, per_ray, wanted };
                    enter(sample(1, Wanted::Densities));
                    if alone && rays <= LARGEST_OF_ALL {
                        for stage in [Stage::Geometry, Stage::SetUp, Stage::Inversion] {
                            enter(Work::UpTo { kernel, stage });
                        }
                        enter(sample(1, Wanted::Weights));
                        if rays.is_multiple_of(SHARED) {
                            enter(sample(SHARED, Wanted::Densities));
                        }
                    }
                }
            }
            // Where there is something to compare them with.
            let beside = |peers: &&Peers| alone && backends.iter().any(|b| b.name() == peers.backend.name());
            for peers in peers.iter().filter(beside) {
                Peer::ALL.into_iter().for_each(|peer| enter(Work::Peer(peers, peer)));
            }
        }
        contestants
    }
}
