//! What a user of the library writes in twenty lines: one of a few equi-angular candidates, chosen in proportion to `f/p`.

use super::Args;
use crate::progress::Part;
use crate::strata::Strata;
use airlight::{Emitters, Error, Media, Rays, Sampler, Samples, Strategy};
use airlight_tools::variates;
use anyhow::Result;
use rayon::prelude::*;
use serde::Serialize;
use std::time::{Duration, Instant};

/// Candidates of a ray.
const CANDIDATES: usize = 8;
/// Rays that a thread takes at least.
const STRIDE: usize = 1024;

/// How it went on a wavefront. The names of the fields are the keys of the JSON.
#[derive(Debug, Serialize)]
pub(crate) struct Resampled {
    strategy: &'static str,
    precision: &'static str,
    candidates: usize,
    rays: usize,
    threads: usize,
    msamples_per_s: f64,
    radiance: Option<f64>,
    radiance_stderr: Option<f64>,
}

impl Resampled {
    /// What it is called in a figure.
    pub(crate) fn name(&self) -> String {
        format!("resampling of {} {} candidates", self.candidates, self.strategy)
    }

    /// The relative error that is left after one second.
    pub(crate) fn error_after_one_second(&self) -> Option<f64> {
        let seconds = self.rays as f64 / (1e6 * self.msamples_per_s);
        Some(self.radiance_stderr? / self.radiance? * seconds.sqrt()).filter(|error| *error > 0.0)
    }
}

/// Samples the wavefront of `args` over and over, a distance on each ray.
pub(crate) fn resample(args: &Args, progress: Part<'_>) -> Result<Resampled> {
    let wavefront = args.wavefront()?;
    let sampler = Sampler::new(Strategy::EquiAngular).with_precision(args.precision)?;
    progress.tell("resampling");
    let media = Media::one(args.medium);
    let reached = args.rays.min(wavefront.len());
    let mut resampling = Resampling::new(sampler);
    let [mut choice, mut t, mut weight] = [(); 3].map(|()| vec![0.0; reached]);
    let mut u = vec![0.0; CANDIDATES * reached];
    let (mut strata, mut sampling) = (Strata::new(reached), Duration::ZERO);
    for start in (0..args.rays).step_by(reached) {
        let count = reached.min(args.rays - start);
        variates::fill(args.seed, (CANDIDATES * start) as u64, &mut u[..CANDIDATES * count]);
        variates::fill(!args.seed, start as u64, &mut choice[..count]);
        let scene = (&wavefront.rays(count), &wavefront.emitters(count), &media);
        let variates = (&u[..CANDIDATES * count], &choice[..count]);
        let clock = Instant::now();
        resampling.sample(scene, variates, &mut t[..count], &mut weight[..count])?;
        sampling += clock.elapsed();
        strata.add(&weight[..count]);
        progress.inc(count);
    }
    let whole = strata.all();
    Ok(Resampled {
        strategy: Strategy::EquiAngular.name(),
        precision: sampler.precision().name(),
        candidates: CANDIDATES,
        rays: args.rays,
        threads: rayon::current_num_threads(),
        msamples_per_s: args.rays as f64 / (1e6 * sampling.as_secs_f64()),
        radiance: whole.mean,
        radiance_stderr: whole.stderr,
    })
}

/// The candidates of a batch.
#[derive(Debug)]
struct Resampling {
    sampler: Sampler,
    t: Vec<f32>,
    pdf: Vec<f32>,
    weight: Vec<f32>,
}

impl Resampling {
    fn new(sampler: Sampler) -> Self {
        Self { sampler, t: Vec::new(), pdf: Vec::new(), weight: Vec::new() }
    }

    /// Writes a distance for each ray, and its weight: the mean of those of all candidates. There is a variate for each
    /// candidate, those of a ray next to each other, and one more for each ray.
    fn sample(
        &mut self,
        (rays, emitters, media): (&Rays<'_>, &Emitters<'_>, &Media<'_>),
        (u, choice): (&[f32], &[f32]),
        chosen: &mut [f32],
        weights: &mut [f32],
    ) -> Result<(), Error> {
        let Self { sampler, t, pdf, weight } = self;
        for column in [&mut *t, pdf, weight] {
            column.resize(u.len(), 0.0);
        }
        sampler.sample(rays, emitters, media, u, &mut Samples::new(t, pdf).weight(weight))?;
        let candidates = t.par_chunks(CANDIDATES).zip(weight.par_chunks(CANDIDATES)).with_min_len(STRIDE);
        let places = chosen.par_iter_mut().zip(weights);
        candidates.zip(choice).zip(places).for_each(|(((t, weight), choice), (chosen, mean))| {
            let sum: f32 = weight.iter().sum();
            let mut left = choice * sum;
            let taken = weight.iter().position(|weight| {
                left -= weight;
                left < 0.0
            });
            *chosen = t[taken.unwrap_or(CANDIDATES - 1)];
            *mean = sum / CANDIDATES as f32;
        });
        Ok(())
    }
}
