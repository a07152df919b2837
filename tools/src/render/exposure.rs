//! Passes until the budget is spent.

use airlight::Error;
use airlight_tools::renderer::film::Film;
use airlight_tools::renderer::picture::Size;
use airlight_tools::renderer::scene::Scene;
use airlight_tools::renderer::{Renderer, Settings};
use indicatif::ProgressBar;
use std::time::{Duration, Instant};

/// How far an exposure takes a progress bar.
pub(super) const STEPS: usize = 1000;

/// When a picture is done.
#[derive(Clone, Copy, Debug)]
pub(super) enum Budget {
    /// After so many passes.
    Passes(u64),
    /// After the pass during which the time is over.
    Time(Duration),
}

/// An exposed film, and how that went.
#[derive(Debug)]
pub(super) struct Exposure {
    pub(super) film: Film,
    /// Distances that were sampled.
    pub(super) samples: u64,
    pub(super) elapsed: Duration,
    /// The part of it spent in calls of airlight.
    pub(super) inside: Duration,
}

impl Exposure {
    /// Renders `scene`, and takes `progress` on by [`STEPS`].
    pub(super) fn new(
        scene: &Scene,
        size: Size,
        settings: &Settings,
        budget: Budget,
        progress: &ProgressBar,
    ) -> Result<Self, Error> {
        let mut film = Film::new(size);
        let mut renderer = Renderer::new(scene, size, settings);
        let start = progress.position();
        let clock = Instant::now();
        loop {
            renderer.pass(&mut film)?;
            let spent = match budget {
                Budget::Passes(passes) => film.passes() as f64 / passes as f64,
                Budget::Time(time) => clock.elapsed().as_secs_f64() / time.as_secs_f64(),
            };
            progress.set_position(start + (STEPS as f64 * spent.min(1.0)) as u64);
            if spent >= 1.0 {
                break;
            }
        }
        let samples = film.passes() * (size.pixels() * renderer.samples_per_pixel()) as u64;
        Ok(Self { film, samples, elapsed: clock.elapsed(), inside: renderer.inside_airlight() })
    }
}
