//! What `airlight render` found, as JSON and as text. The names of the fields are the keys of the JSON, which others
//! read.

use super::exposure::Exposure;
use airlight_tools::renderer::Settings;
use serde::Serialize;
use std::fmt;

/// What was asked for.
#[derive(Debug, Serialize)]
pub(super) struct Job {
    pub(super) version: &'static str,
    pub(super) scene: &'static str,
    pub(super) width: usize,
    pub(super) height: usize,
    pub(super) mis: bool,
    pub(super) lights: &'static str,
    pub(super) variates: &'static str,
    pub(super) seed: u64,
    pub(super) threads: usize,
}

/// How rendering with one strategy went.
#[derive(Debug, Serialize)]
pub(super) struct Run {
    pub(super) strategy: &'static str,
    pub(super) precision: &'static str,
    pub(super) shadows: &'static str,
    pub(super) passes: u64,
    pub(super) samples: u64,
    pub(super) seconds: f64,
    pub(super) msamples_per_s: f64,
    /// Part of the time spent in calls of airlight.
    pub(super) airlight_share: f64,
}

/// One picture.
#[derive(Debug, Serialize)]
pub(super) struct Figures {
    #[serde(flatten)]
    pub(super) job: Job,
    #[serde(flatten)]
    pub(super) run: Run,
    /// Mean of the picture, red, green and blue \[W/(m^2 sr)\].
    pub(super) radiance: [f64; 3],
}

impl Run {
    pub(super) fn new(settings: &Settings, exposure: &Exposure<'_>) -> Self {
        let seconds = exposure.elapsed.as_secs_f64();
        Self {
            strategy: settings.sampler.strategy().name(),
            precision: settings.sampler.precision().name(),
            shadows: settings.shadows.name(),
            passes: exposure.film.passes(),
            samples: exposure.samples(),
            seconds,
            msamples_per_s: exposure.samples() as f64 / (1e6 * seconds),
            airlight_share: exposure.inside_airlight().as_secs_f64() / seconds,
        }
    }
}

impl fmt::Display for Job {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { scene, width, height, lights, variates, seed, threads, .. } = self;
        let mis = if self.mis { ", combined with transmittance" } else { "" };
        let lights = format_args!("lights chosen by {lights}");
        write!(
            f,
            "{scene}: {width}x{height} pixels{mis}; {lights}; {variates} variates, seed {seed}, threads {threads}"
        )
    }
}

impl fmt::Display for Figures {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Run { strategy, precision, shadows, passes, samples, seconds, msamples_per_s, airlight_share } = &self.run;
        let [red, green, blue] = self.radiance;
        writeln!(f, "{}", self.job)?;
        writeln!(
            f,
            "{strategy}, {precision}, shadows {shadows}: {samples} samples in {passes} passes and {seconds:.2} s"
        )?;
        writeln!(f, "{msamples_per_s:.2} Msamples/s, {:.0} % of the time in airlight", 100.0 * airlight_share)?;
        writeln!(f, "mean radiance {red:.5e} {green:.5e} {blue:.5e}")
    }
}
