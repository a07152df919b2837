//! Calls for one ray: in a grey medium those of airlight, in a coloured one batches of one, which have the channels.

use crate::abi::*;
use crate::arguments::{Options, Place, read};
use crate::batch::{emitter, medium};
use crate::status::{Failure, Result};
use airlight::{Emitter, Emitters, Integral, Media, Medium, Ray, Rays, Sample, Sampler, Samples};
use core::slice::{from_mut, from_ref};

/// One ray, one emitter, one medium.
struct Scene {
    given: airlight_ray,
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
        Ok(Self { given: scene.ray, ray, emitter, medium })
    }

    /// The same as a batch.
    fn batch(&self) -> (Rays<'_>, Emitters<'_>, Media<'_>) {
        let airlight_ray { origin, direction, t_min, t_max } = &self.given;
        let [origin, direction] = [origin, direction].map(|vector| vector.each_ref().map(from_ref));
        let rays = Rays::new(origin, direction, from_ref(t_min), from_ref(t_max));
        (rays, Emitters::one(self.emitter), Media::one(self.medium))
    }

    /// A sample of it.
    fn sample(&self, sampler: &Sampler, u: f32) -> Result<airlight_one_sample> {
        let mut result = airlight_one_sample::default();
        let airlight_one_sample { t, pdf, weight, r, .. } = &mut result;
        let channels = self.medium.channels();
        if channels == 1 {
            if let Some(sample) = sampler.sample_one(&self.ray, &self.emitter, &self.medium, u) {
                Sample { t: *t, pdf: *pdf, weight: weight[0], r: *r, .. } = sample;
            }
            return Ok(result);
        }
        let mut out = Samples::new(from_mut(t), from_mut(pdf)).r(from_mut(r));
        for (out, weight) in out.weights.iter_mut().zip(weight).take(channels) {
            *out = Some(from_mut(weight));
        }
        let (rays, emitters, media) = self.batch();
        sampler.sample(&rays, &emitters, &media, &[u], &mut out)?;
        Ok(result)
    }

    /// Its integrand at a distance, in each of `C` channels.
    fn evaluate<const C: usize>(&self, sampler: &Sampler, t: f32) -> Result<[f32; C]> {
        let mut integrand = [0.0; C];
        let (rays, emitters, media) = self.batch();
        sampler.evaluate_coloured(&rays, &emitters, &media, &[t], integrand.each_mut().map(from_mut))?;
        Ok(integrand)
    }

    /// Its radiance, in each of `C` channels.
    fn radiance<const C: usize>(&self, integral: &Integral) -> Result<[f32; C]> {
        let mut radiance = [0.0; C];
        let (rays, emitters, media) = self.batch();
        integral.radiance_coloured(&rays, &emitters, &media, radiance.each_mut().map(from_mut))?;
        Ok(radiance)
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
    place.write(scene.sample(&sampler, u)?);
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
    unsafe { write(value, || Ok([at_distance(&sampler, &scene.ray, &scene.emitter, &scene.medium, t)])) }
}

/// Writes the integrand of one ray at a given distance, for each channel.
///
/// # Safety
/// As [`sample_one`]; `integrand` is NULL or one to as many floats as the medium has channels.
pub(crate) unsafe fn evaluate_one(
    options: *const airlight_options,
    scene: *const airlight_scene,
    t: f32,
    integrand: *mut f32,
) -> Result<()> {
    // SAFETY: as promised.
    unsafe {
        let (sampler, scene) = (Options::read(options)?.sampler()?, Scene::read(scene)?);
        match scene.medium.channels() {
            3 => write(integrand, || scene.evaluate::<3>(&sampler, t)),
            4 => write(integrand, || scene.evaluate::<4>(&sampler, t)),
            _ => write(integrand, || Ok([sampler.evaluate_one(&scene.ray, &scene.emitter, &scene.medium, t)])),
        }
    }
}

/// Writes the radiance of one ray, for each channel.
///
/// # Safety
/// As [`sample_one`]; `radiance` is NULL or one to as many floats as the medium has channels.
pub(crate) unsafe fn radiance_one(
    options: *const airlight_options,
    scene: *const airlight_scene,
    radiance: *mut f32,
) -> Result<()> {
    // SAFETY: as promised.
    unsafe {
        let (integral, scene) = (Options::read(options)?.integral(), Scene::read(scene)?);
        match scene.medium.channels() {
            3 => write(radiance, || scene.radiance::<3>(&integral)),
            4 => write(radiance, || scene.radiance::<4>(&integral)),
            _ => write(radiance, || Ok([integral.radiance_one(&scene.ray, &scene.emitter, &scene.medium)])),
        }
    }
}

/// Writes so many floats.
///
/// # Safety
/// `value` is NULL or one to as many.
unsafe fn write<const C: usize>(value: *mut f32, results: impl FnOnce() -> Result<[f32; C]>) -> Result<()> {
    if value.is_null() {
        return Err(Failure::null("value"));
    }
    // SAFETY: as promised, and there is no reference to them.
    unsafe { value.cast::<[f32; C]>().write_unaligned(results()?) };
    Ok(())
}
