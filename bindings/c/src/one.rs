//! Calls for one ray.

use crate::abi::*;
use crate::arguments::{Options, Place, read};
use crate::batch::{emitter, medium};
use crate::status::{Failure, Result};
use airlight::{Emitter, Emitters, Media, Medium, Ray, Rays, Sample, Sampler, Strategy, Threads};

/// One ray, one emitter, one medium, which have kernels.
struct Scene {
    ray: Ray,
    emitter: Emitter,
    medium: Medium,
}

impl Scene {
    /// That of a struct.
    ///
    /// # Safety
    /// `scene` is NULL or one to a scene.
    unsafe fn read(scene: *const airlight_scene) -> Result<Self> {
        // SAFETY: as promised.
        let scene = unsafe { read("scene", scene)? };
        let airlight_ray { origin, direction, t_min, t_max } = scene.ray;
        let of = |part| move |failure: Failure| failure.of(part);
        let ray = Ray::new(origin, direction, t_min, t_max).map_err(|error| Failure::from(error).of("scene.ray"))?;
        let emitter = emitter(&scene.emitter).map_err(of("scene.emitter"))?;
        let medium = medium(&scene.medium).map_err(of("scene.medium"))?;
        // What has no kernel has none for no rays either.
        let (none, emitters, media) = (&[][..], Emitters::one(emitter), Media::one(medium));
        let sampler = Sampler::new(Strategy::default()).with_threads(Threads::Caller);
        sampler.evaluate(&Rays::new([none; 3], [none; 3], none, none), &emitters, &media, none, &mut [])?;
        Ok(Self { ray, emitter, medium })
    }
}

/// Samples one ray.
///
/// # Safety
/// All pointers are NULL or what they are said to be.
pub(crate) unsafe fn sample_one(
    options: *const airlight_options,
    scene: *const airlight_scene,
    u: f32,
    sample: *mut airlight_one_sample,
) -> Result<()> {
    // SAFETY: as promised.
    let (sampler, scene, place) =
        unsafe { (Options::read(options)?.sampler()?, Scene::read(scene)?, Place::new("sample", sample)?) };
    let mut result = airlight_one_sample::default();
    if let Some(Sample { t, pdf, weight, r, .. }) = sampler.sample_one(&scene.ray, &scene.emitter, &scene.medium, u) {
        result = airlight_one_sample { t, pdf, weight: [weight, 0.0, 0.0, 0.0], r, ..result };
    }
    place.write(result);
    Ok(())
}

/// What is known of a ray at a given distance.
pub(crate) type AtDistance = fn(&Sampler, &Ray, &Emitter, &Medium, f32) -> f32;

/// Writes what is known of one ray at a given distance.
///
/// # Safety
/// As [`sample_one`].
pub(crate) unsafe fn at_distance(
    at_distance: AtDistance,
    options: *const airlight_options,
    scene: *const airlight_scene,
    t: f32,
    value: *mut f32,
) -> Result<()> {
    // SAFETY: as promised.
    let (sampler, scene) = unsafe { (Options::read(options)?.sampler()?, Scene::read(scene)?) };
    // SAFETY: as promised.
    unsafe { write(value, || at_distance(&sampler, &scene.ray, &scene.emitter, &scene.medium, t)) }
}

/// Writes the radiance of one ray.
///
/// # Safety
/// As [`sample_one`].
pub(crate) unsafe fn radiance_one(
    options: *const airlight_options,
    scene: *const airlight_scene,
    radiance: *mut f32,
) -> Result<()> {
    // SAFETY: as promised.
    let (integral, scene) = unsafe { (Options::read(options)?.integral(), Scene::read(scene)?) };
    // SAFETY: as promised.
    unsafe { write(radiance, || integral.radiance_one(&scene.ray, &scene.emitter, &scene.medium)) }
}

/// Writes one float.
///
/// # Safety
/// `value` is NULL or one to a float.
unsafe fn write(value: *mut f32, result: impl FnOnce() -> f32) -> Result<()> {
    if value.is_null() {
        return Err(Failure::null("value"));
    }
    // SAFETY: as promised, and there is no reference to it.
    unsafe { value.write_unaligned(result()) };
    Ok(())
}
