//! What is measured on a batch: a kernel as a whole, a part of its road, bare columns, a peer.

use super::clock::nanoseconds;
use super::peers::{Peer, Peers};
use super::streams::Stream;
use super::subject::{Subject, TOTAL};
use airlight::{Backend, Sampler, Stage, Strategy};
use airlight_tools::workload::{Wanted, Workload};
use anyhow::Result;
use rayon::ThreadPool;
use std::hint::black_box;

/// Samples that a measurement takes at least.
const LEAST: usize = 1 << 16;

/// Something that is done to a batch.
#[derive(Clone, Copy, Debug)]
pub(super) enum Work<'a> {
    /// All of a strategy's kernel, with so many samples per ray.
    Sample { strategy: Strategy, backend: Backend, per_ray: usize, wanted: Wanted },
    /// The kernel up to a stage.
    UpTo { strategy: Strategy, backend: Backend, stage: Stage },
    /// Columns that are read and written.
    Stream(Stream),
    /// A kernel of others.
    Peer(&'a Peers, Peer),
}

/// Work of the threads of a pool on so many samples.
#[derive(Clone, Copy, Debug)]
pub(super) struct Contestant<'a> {
    pub(super) work: Work<'a>,
    pub(super) samples: usize,
    pub(super) pool: &'a ThreadPool,
}

impl Contestant<'_> {
    pub(super) fn subject(&self) -> Subject {
        let subject = Subject {
            threads: self.pool.current_num_threads(),
            rays: Some(self.samples),
            samples_per_ray: 1,
            ..Subject::default()
        };
        let of = |strategy: Strategy, backend: Backend, stage| Subject {
            strategy: Some(strategy.name()),
            backend: Some(backend.name()),
            stage: Some(stage),
            ..subject
        };
        match self.work {
            Work::Sample { strategy, backend, per_ray, wanted } => {
                let stage = match wanted {
                    Wanted::Densities => TOTAL,
                    Wanted::Weights => "with-weight",
                };
                Subject { rays: Some(self.samples / per_ray), samples_per_ray: per_ray, ..of(strategy, backend, stage) }
            }
            Work::UpTo { strategy, backend, stage } => {
                let stage = match stage {
                    Stage::Geometry => "geometry",
                    Stage::SetUp => "set-up",
                    Stage::Inversion => "inversion",
                };
                of(strategy, backend, stage)
            }
            Work::Stream(stream) => Subject { limit: Some(stream.name()), ..subject },
            Work::Peer(_, peer) => Subject { peer: Some(peer.name()), stage: Some(TOTAL), ..subject },
        }
    }

    /// Its time for one sample \[ns\].
    pub(super) fn time(&self, workload: &mut Workload) -> Result<f64> {
        let times = LEAST.div_ceil(self.samples);
        let (elapsed, done) = nanoseconds(self.pool, || (0..times).try_for_each(|_| self.run(workload)));
        done?;
        Ok(elapsed / (times * self.samples) as f64)
    }

    /// Does it once, on the caller's thread or its pool.
    pub(super) fn run(&self, workload: &mut Workload) -> Result<()> {
        match self.work {
            Work::Sample { strategy, backend, per_ray, wanted } => {
                let mut call = workload.call(self.samples / per_ray, per_ray, wanted);
                let sampler = Sampler::new(strategy).with_backend(backend);
                black_box(call.sample(&sampler)?);
            }
            Work::UpTo { strategy, backend, stage } => {
                let call = workload.call(self.samples, 1, Wanted::Densities);
                let sampler = Sampler::new(strategy).with_backend(backend);
                sampler.up_to(stage, &call.rays, &call.emitters, &call.media, call.u)?;
            }
            Work::Stream(stream) => stream.run(&mut workload.call(self.samples, 1, Wanted::Densities)),
            Work::Peer(peers, peer) => peers.sample(peer, workload.call(self.samples, 1, Wanted::Densities)),
        }
        Ok(())
    }
}
