//! What is measured on a batch: a kernel as a whole, a part of its road, bare columns, a peer.

use super::clock::{nanoseconds, warm_up};
use super::peers::{Peer, Peers};
use super::streams::Stream;
use super::subject::{CALL, CHOOSE, ONE, RADIANCE, Subject, TOTAL};
use airlight::{Backend, Integral, Sampler, Stage};
use airlight_tools::workload::{Wanted, Workload, emitter, emitters, medium};
use anyhow::Result;
use rayon::ThreadPool;
use std::hint::black_box;

/// Samples that a measurement of batches takes at least, so that the clock resolves their time.
pub(super) const LEAST: usize = 1 << 16;
/// Calls that a measurement of calls takes at most.
const CALLS: usize = 1 << 12;

/// A sampler on a backend.
#[derive(Clone, Copy, Debug)]
pub(super) struct Kernel {
    sampler: Sampler,
    backend: Backend,
}

impl Kernel {
    pub(super) fn new(sampler: &Sampler, backend: Backend) -> Self {
        Self { sampler: sampler.with_backend(backend), backend }
    }
}

/// Something that is done to a batch.
#[derive(Clone, Copy, Debug)]
pub(super) enum Work<'a> {
    /// All of a kernel, with this many samples per ray.
    Sample { kernel: Kernel, per_ray: usize, wanted: Wanted },
    /// The kernel up to a stage.
    UpTo { kernel: Kernel, stage: Stage },
    /// Columns that are read and written.
    Stream(Stream),
    /// A kernel of others.
    Peer(&'a Peers, Peer),
    /// Calls of so few rays, one after the other, each of the next rays.
    Calls(Kernel),
    /// The same of [`Sampler::sample_one`].
    OneByOne(Kernel),
    /// The integral of each ray.
    Radiance(Integral),
    /// A choice among this many emitters for each ray.
    Choose(Integral, usize),
}

/// Work of the threads of a pool on this many samples.
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
        let of = |Kernel { sampler, backend }: Kernel, stage| Subject {
            strategy: Some(sampler.strategy().name()),
            precision: Some(sampler.precision().name()),
            backend: Some(backend.name()),
            stage: Some(stage),
            ..subject
        };
        let of_integral = |integral: Integral, stage| Subject {
            precision: Some(integral.precision().name()),
            backend: Some(integral.backend().name()),
            nodes: Some(integral.nodes().count()),
            stage: Some(stage),
            ..subject
        };
        match self.work {
            Work::Sample { kernel, per_ray, wanted } => {
                let stage = match wanted {
                    Wanted::Densities => TOTAL,
                    Wanted::Weights => "with-weight",
                };
                Subject { rays: Some(self.samples / per_ray), samples_per_ray: per_ray, ..of(kernel, stage) }
            }
            Work::UpTo { kernel, stage } => {
                let stage = match stage {
                    Stage::Geometry => "geometry",
                    Stage::SetUp => "set-up",
                    Stage::Inversion => "inversion",
                };
                of(kernel, stage)
            }
            Work::Stream(stream) => Subject { limit: Some(stream.name()), ..subject },
            Work::Peer(peers, peer) => peers.subject(peer, subject),
            Work::Calls(kernel) => of(kernel, CALL),
            Work::OneByOne(kernel) => of(kernel, ONE),
            Work::Radiance(integral) => of_integral(integral, RADIANCE),
            Work::Choose(integral, emitters) => Subject { emitters: Some(emitters), ..of_integral(integral, CHOOSE) },
        }
    }

    /// Samples that a measurement takes.
    pub(super) fn taken(&self) -> usize {
        self.times() * self.at_once()
    }

    /// Its time for one sample \[ns\], on threads that are awake.
    pub(super) fn time(&self, workload: &mut Workload) -> Result<f64> {
        let elapsed = self.pool.install(|| {
            warm_up(self.shortened().task(workload))?;
            let mut task = self.task(workload);
            let (elapsed, done) = nanoseconds(|| (0..self.times()).try_for_each(|_| task()));
            done.map(|()| elapsed)
        })?;
        Ok(elapsed / self.taken() as f64)
    }

    /// How often a measurement does its task.
    fn times(&self) -> usize {
        match self.work {
            Work::Calls(_) | Work::OneByOne(_) => 1,
            _ => LEAST.div_ceil(self.samples),
        }
    }

    /// Samples of its task.
    fn at_once(&self) -> usize {
        match self.work {
            Work::Calls(_) | Work::OneByOne(_) => self.calls() * self.samples,
            _ => self.samples,
        }
    }

    /// Calls of its task, where that is several.
    fn calls(&self) -> usize {
        CALLS.min(LEAST / self.samples)
    }

    /// The same with no more samples than warm the threads up.
    fn shortened(&self) -> Self {
        let samples = self.samples.min(LEAST);
        let work = match self.work {
            Work::Sample { kernel, per_ray, wanted } => Work::Sample { kernel, per_ray: per_ray.min(samples), wanted },
            work => work,
        };
        Self { work, samples, ..*self }
    }

    /// What it does at once, on the caller's thread or its pool; what comes before it is done by then.
    pub(super) fn task<'w>(&self, workload: &'w mut Workload) -> Box<dyn FnMut() -> Result<()> + Send + 'w>
    where
        Self: 'w,
    {
        let Self { work, samples, .. } = *self;
        match work {
            Work::Sample { kernel, per_ray, wanted } => {
                let mut call = workload.call(samples / per_ray, per_ray, wanted);
                Box::new(move || {
                    black_box(call.sample(&kernel.sampler)?);
                    Ok(())
                })
            }
            Work::UpTo { kernel, stage } => {
                let call = workload.call(samples, 1, Wanted::Densities);
                Box::new(move || Ok(kernel.sampler.up_to(stage, &call.rays, &call.emitters, &call.media, call.u)?))
            }
            Work::Stream(stream) => {
                let mut call = workload.call(samples, 1, Wanted::Densities);
                Box::new(move || {
                    stream.run(&mut call);
                    Ok(())
                })
            }
            Work::Peer(peers, peer) => {
                let mut call = workload.call(samples, 1, Wanted::Densities);
                Box::new(move || {
                    peers.sample(peer, &mut call);
                    Ok(())
                })
            }
            Work::Calls(kernel) => {
                let calls = self.calls();
                let mut all = workload.call(calls * samples, 1, Wanted::Densities);
                Box::new(move || {
                    for call in 0..calls {
                        black_box(all.part(call * samples, samples).sample(&kernel.sampler)?);
                    }
                    Ok(())
                })
            }
            Work::Radiance(integral) => {
                let call = workload.call(samples, 1, Wanted::Densities);
                Box::new(move || {
                    integral.radiance(&call.rays, &call.emitters, &call.media, call.samples.t)?;
                    Ok(())
                })
            }
            Work::Choose(integral, count) => {
                let call = workload.call(samples, 1, Wanted::Densities);
                let (table, weights, mut index) = (emitters(count), vec![1.0; count], vec![0; samples]);
                Box::new(move || {
                    let (rays, media, probability) = (&call.rays, &call.media, &mut *call.samples.pdf);
                    integral.choose(rays, &table, &weights, media, call.u, &mut index, probability)?;
                    Ok(())
                })
            }
            Work::OneByOne(kernel) => {
                let rays = workload.one_by_one(self.calls());
                let (emitter, medium) = (emitter(), medium());
                Box::new(move || {
                    for (ray, u) in &rays {
                        black_box(kernel.sampler.sample_one(ray, &emitter, &medium, *u));
                    }
                    Ok(())
                })
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use airlight::Strategy;

    #[test]
    fn a_warm_up_draws_some_samples_and_not_too_many() {
        let pool = airlight_tools::threads::pool(1).unwrap();
        let kernel = Kernel::new(&Sampler::new(Strategy::Product9), Backend::detect());
        for (samples, per_ray) in [(64, 1), (1 << 20, 1), (1 << 20, 8), (1 << 22, 1 << 22)] {
            let work = Work::Sample { kernel, per_ray, wanted: Wanted::Densities };
            let warm_up = Contestant { work, samples, pool: &pool }.shortened();
            let Subject { rays, samples_per_ray, .. } = warm_up.subject();
            assert_eq!(rays.map(|rays| rays * samples_per_ray), Some(samples.min(LEAST)), "{samples}, {per_ray}");
            assert!(rays > Some(0));
        }
    }
}
