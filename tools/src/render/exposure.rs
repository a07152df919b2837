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
    /// After this many passes.
    Passes(u64),
    /// After the pass during which the time is over.
    Time(Duration),
}

/// A film that is being exposed, and how that goes.
#[derive(Debug)]
pub(super) struct Exposure<'a> {
    renderer: Renderer<'a>,
    budget: Budget,
    pub(super) film: Film,
    pub(super) elapsed: Duration,
}

impl<'a> Exposure<'a> {
    pub(super) fn new(scene: &'a Scene, size: Size, settings: &Settings, budget: Budget) -> Self {
        let renderer = Renderer::new(scene, size, settings);
        Self { renderer, budget, film: Film::new(size), elapsed: Duration::ZERO }
    }

    /// Exposes them all, in turns of a pass: what else the machine does falls on all alike.
    pub(super) fn complete(exposures: &mut [Self], progress: &ProgressBar) -> Result<(), Error> {
        let start = progress.position();
        while exposures.iter().any(|exposure| exposure.spent() < 1.0) {
            for exposure in exposures.iter_mut().filter(|exposure| exposure.spent() < 1.0) {
                let clock = Instant::now();
                exposure.renderer.pass(&mut exposure.film)?;
                exposure.elapsed += clock.elapsed();
            }
            let spent: f64 = exposures.iter().map(|exposure| exposure.spent().min(1.0)).sum();
            progress.set_position(start + (STEPS as f64 * spent) as u64);
        }
        Ok(())
    }

    /// The part of the budget that is spent.
    fn spent(&self) -> f64 {
        match self.budget {
            Budget::Passes(passes) => self.film.passes() as f64 / passes as f64,
            Budget::Time(time) => self.elapsed.as_secs_f64() / time.as_secs_f64(),
        }
    }

    /// Distances that were sampled.
    pub(super) fn samples(&self) -> u64 {
        self.film.passes() * (self.film.size().pixels() * self.renderer.samples_per_pixel()) as u64
    }

    /// The part of the time that was spent in calls of airlight.
    pub(super) fn inside_airlight(&self) -> Duration {
        self.renderer.inside_airlight()
    }
}
