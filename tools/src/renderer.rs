//! A small wavefront renderer: airlight embedded, worked out as an example.
//!
//! A pass takes one sample of every pixel, in waves of some ten thousand pixels. A wave goes through the stages one after
//! the other. Each is a file, reads queues and writes queues; a queue is a structure of arrays in which every pixel of
//! the wave has its place, so nothing is sorted and nothing depends on the threads:
//!
//! `camera -> intersection -> surface -> shadow -> film`
//!
//! `camera -> intersection -> emitter_choice -> scattering -> shadow -> film`
//!
//! `camera -> intersection -> unshadowed -> film`, for the ratio estimator of shadows alone
//!
//! The picture is what [`scenes`] hold: surfaces lit by point-normal lights and spots, in fog that scatters once.

pub mod camera;
pub mod columns;
pub mod emitter_choice;
pub mod film;
pub mod intersection;
pub mod picture;
pub mod scattering;
pub mod scene;
pub mod scenes;
pub mod shadow;
pub mod surface;
pub mod tone;
pub mod unshadowed;
pub mod variate;

use self::camera::{RayQueue, View};
use self::emitter_choice::{Choice, EmitterChoice};
use self::film::{Film, Layer};
use self::picture::Size;
use self::scattering::Scattering;
use self::scene::Scene;
use self::shadow::{ShadowQueue, Shadows};
use self::unshadowed::Unshadowed;
use self::variate::{Dimension, Sequence, Variates};
use airlight::{Error, Sampler};
use std::time::{Duration, Instant};

/// Pixels of a wave: enough to keep the threads busy, few enough for the queues to stay in the cache.
const WAVE: usize = 1 << 15;

/// How a scene is rendered.
#[derive(Clone, Copy, Debug)]
pub struct Settings {
    /// What the distances are sampled with.
    pub sampler: Sampler,
    /// Whether a second distance is sampled from the transmittance and the two are combined.
    pub mis: bool,
    /// How the emitter that lights a ray is chosen.
    pub choice: EmitterChoice,
    /// How the airlight is estimated where there may be shadows.
    pub shadows: Shadows,
    /// How the random numbers of the passes belong together.
    pub variates: Sequence,
    /// Which ones.
    pub seed: u64,
}

/// Renders a scene pass by pass.
#[derive(Debug)]
pub struct Renderer<'a> {
    scene: &'a Scene,
    view: View,
    variates: Sequence,
    seed: u64,
    choice: Choice,
    scattering: Scattering,
    rays: RayQueue,
    hits: Vec<u32>,
    /// A shadow ray for the surface, and one for each sampled distance.
    shadows: ShadowQueue,
    /// For the ratio estimator.
    unshadowed: Option<Unshadowed>,
    emitted: columns::Vectors,
    u: Vec<f32>,
    inside: Duration,
}

impl<'a> Renderer<'a> {
    /// A renderer of pictures of `size` pixels.
    #[must_use]
    pub fn new(scene: &'a Scene, size: Size, settings: &Settings) -> Self {
        let precision = settings.sampler.precision();
        Self {
            scene,
            view: View::new(&scene.camera, size),
            variates: settings.variates,
            seed: settings.seed,
            choice: Choice::new(settings.choice, scene, precision),
            scattering: Scattering::new(settings.sampler, settings.mis),
            rays: RayQueue::default(),
            hits: Vec::new(),
            shadows: ShadowQueue::default(),
            unshadowed: (settings.shadows == Shadows::Ratio).then(|| Unshadowed::new(precision)),
            emitted: columns::Vectors::default(),
            u: Vec::new(),
            inside: Duration::ZERO,
        }
    }

    /// Time spent in calls of airlight so far.
    #[must_use]
    pub fn inside_airlight(&self) -> Duration {
        self.inside
    }

    /// Distances that a pass samples for each pixel.
    #[must_use]
    pub fn samples_per_pixel(&self) -> usize {
        self.scattering.densities()
    }

    /// Adds a sample to every pixel of `film`.
    ///
    /// # Errors
    /// None but those of malformed calls of airlight.
    pub fn pass(&mut self, film: &mut Film) -> Result<(), Error> {
        let pixels = film.size().pixels();
        let variates = Variates { sequence: self.variates, seed: self.seed, pass: film.passes(), pixels };
        for first in (0..pixels).step_by(WAVE) {
            self.wave(first, WAVE.min(pixels - first), &variates, film)?;
        }
        film.end_pass();
        Ok(())
    }

    /// Takes `count` pixels from `first` on through the stages.
    fn wave(&mut self, first: usize, count: usize, variates: &Variates, film: &mut Film) -> Result<(), Error> {
        self.view.shoot(first, count, variates, &mut self.rays);
        intersection::intersect(self.scene, &mut self.rays, &mut self.hits);

        variates.fill(Dimension::SurfaceEmitter, first, count, &mut self.u);
        surface::emit(self.scene, &self.rays, &self.hits, &mut self.emitted);
        surface::reflect(self.scene, &self.rays, &self.hits, &self.u, &mut self.shadows);
        self.shadows.trace(self.scene);
        film.add(Layer::Surface, first, &self.emitted);
        film.add(Layer::Surface, first, &self.shadows.radiance);

        if let Some(unshadowed) = &mut self.unshadowed {
            let clock = Instant::now();
            unshadowed.integrate(self.scene, &self.rays)?;
            self.inside += clock.elapsed();
            film.add(Layer::Integral, first, &unshadowed.radiance);
        }
        variates.fill(Dimension::Emitter, first, count, &mut self.u);
        let clock = Instant::now();
        self.choice.choose(self.scene, &self.rays, &self.u)?;
        self.inside += clock.elapsed();
        for density in 0..self.scattering.densities() {
            variates.fill(Dimension::distance(density), first, count, &mut self.u);
            let clock = Instant::now();
            self.scattering.sample(density, self.scene, &self.rays, &self.choice, &self.u)?;
            self.inside += clock.elapsed();
            self.scattering.light(self.scene, &self.rays, &self.choice, &mut self.shadows);
            if self.unshadowed.is_some() {
                film.add(Layer::Unshadowed, first, &self.shadows.radiance);
            }
            self.shadows.trace(self.scene);
            film.add(Layer::Airlight, first, &self.shadows.radiance);
        }
        Ok(())
    }
}
