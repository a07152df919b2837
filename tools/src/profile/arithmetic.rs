//! How fast the cores are at single operations, and what a strategy needs of them.

use super::clock::{nanoseconds, warm_up};
use super::subject::Subject;
use airlight::{Backend, Limit, Operations, Sampler};
use airlight_tools::workload::{Wanted, Workload};
use anyhow::Result;
use rayon::ThreadPool;
use std::hint::black_box;

/// Operations of every chain.
const STEPS: usize = 1 << 15;
/// Numbers of chains, of which the fastest counts.
const CHAINS: [usize; 3] = [4, 8, 12];

/// An operation, over and over.
#[derive(Clone, Copy, Debug)]
pub(super) struct Strain<'a> {
    pub(super) limit: Limit,
    pub(super) backend: Backend,
    pub(super) pool: &'a ThreadPool,
}

impl Strain<'_> {
    pub(super) fn subject(&self) -> Subject {
        let limit = match self.limit {
            Limit::MultiplyAdd => "fma",
            Limit::Division => "division",
        };
        Subject {
            limit: Some(limit),
            backend: Some(self.backend.name()),
            threads: self.pool.current_num_threads(),
            samples_per_ray: 1,
            ..Subject::default()
        }
    }

    /// The time of one operation of one lane \[ns\].
    pub(super) fn time(&self) -> Result<f64> {
        let with = |chains| {
            let strain = |_: rayon::BroadcastContext<'_>| black_box(self.backend.strain(self.limit, chains, STEPS));
            let all = || rayon::broadcast(strain).into_iter().sum::<usize>();
            self.pool.install(|| -> Result<f64> {
                warm_up(|| {
                    black_box(all());
                    Ok(())
                })?;
                let (elapsed, done) = nanoseconds(all);
                Ok(elapsed / done as f64)
            })
        };
        CHAINS.into_iter().map(with).try_fold(f64::INFINITY, |least, time| Ok(least.min(time?)))
    }
}

/// Operations of one sample, on average.
#[derive(Clone, Copy, Debug)]
pub(super) struct Need {
    multiply_adds: f64,
    additions: f64,
    divisions: f64,
}

impl Need {
    pub(super) fn of(sampler: &Sampler, rays: usize, workload: &mut Workload) -> Result<Self> {
        let mut call = workload.call(rays, 1, Wanted::Densities);
        let samples = &mut call.samples;
        let Operations { multiply_adds, additions, divisions } =
            sampler.operations(&call.rays, &call.emitters, &call.media, call.u, samples)?;
        let per_ray = |count: usize| count as f64 / rays as f64;
        Ok(Self { multiply_adds: per_ray(multiply_adds), additions: per_ray(additions), divisions: per_ray(divisions) })
    }

    /// The least time for its additions and multiplications, given that of one multiply-add \[ns\].
    pub(super) fn multiply_adds(&self, backend: Backend, one: f64) -> f64 {
        // Without FMA the one is a multiplication and an addition.
        let addition = if backend.is_fused() { one } else { 0.5 * one };
        one * self.multiply_adds + addition * self.additions
    }

    /// The least time for its divisions, given that of one \[ns\].
    pub(super) fn divisions(&self, one: f64) -> f64 {
        one * self.divisions
    }
}
