//! The functions of the ABI. Those that compute do it in the default floating-point environment.

#![expect(clippy::missing_safety_doc, reason = "the page of the crate says what all of them ask for")]

use crate::abi::*;
use crate::arguments::{BACKENDS, STRATEGIES, backend, strategy};
use crate::environment::in_default_environment;
use crate::inside::*;
use crate::status::{describe, last_message};
use airlight::Backend;
use core::ffi::{CStr, c_char};
use core::ptr::null;

/// Draws distances along rays: for each variate one, with its density and its weight.
///
/// An empty or invalid ray has zeros. `counts` may be NULL.
#[cfg_attr(any(target_arch = "x86_64", target_arch = "aarch64"), unsafe(naked))]
#[unsafe(no_mangle)]
pub unsafe extern "C" fn airlight_sample(
    options: *const airlight_options,
    batch: *const airlight_batch,
    samples: *const airlight_samples,
    counts: *mut airlight_counts,
) -> airlight_status {
    in_default_environment!(sample(options, batch, samples, counts))
}

/// Writes the density of `airlight_sample` at given distances (1/m); 0 outside the sampled interval.
#[cfg_attr(any(target_arch = "x86_64", target_arch = "aarch64"), unsafe(naked))]
#[unsafe(no_mangle)]
pub unsafe extern "C" fn airlight_pdf(
    options: *const airlight_options,
    batch: *const airlight_batch,
    values: *const airlight_values,
    counts: *mut airlight_counts,
) -> airlight_status {
    in_default_environment!(pdf(options, batch, values, counts))
}

/// Writes the distribution function of `airlight_sample` at given distances: from `t` back to `u`.
#[cfg_attr(any(target_arch = "x86_64", target_arch = "aarch64"), unsafe(naked))]
#[unsafe(no_mangle)]
pub unsafe extern "C" fn airlight_cdf(
    options: *const airlight_options,
    batch: *const airlight_batch,
    values: *const airlight_values,
    counts: *mut airlight_counts,
) -> airlight_status {
    in_default_environment!(cdf(options, batch, values, counts))
}

/// Writes the integrand `mu_s T rho N / r^2` at given distances (1/m^3), for each channel of the media.
#[cfg_attr(any(target_arch = "x86_64", target_arch = "aarch64"), unsafe(naked))]
#[unsafe(no_mangle)]
pub unsafe extern "C" fn airlight_evaluate(
    options: *const airlight_options,
    batch: *const airlight_batch,
    values: *const airlight_values,
    counts: *mut airlight_counts,
) -> airlight_status {
    in_default_environment!(evaluate(options, batch, values, counts))
}

/// Writes the radiance of each ray per unit of the emitter's intensity (1/m^2), without a sample and so without noise, for
/// each channel of the media.
#[cfg_attr(any(target_arch = "x86_64", target_arch = "aarch64"), unsafe(naked))]
#[unsafe(no_mangle)]
pub unsafe extern "C" fn airlight_radiance(
    options: *const airlight_options,
    batch: *const airlight_batch,
    values: *const airlight_values,
    counts: *mut airlight_counts,
) -> airlight_status {
    in_default_environment!(radiance(options, batch, values, counts))
}

/// Chooses one emitter of a table for each ray, in proportion to its weight times what it adds to the ray's radiance.
#[cfg_attr(any(target_arch = "x86_64", target_arch = "aarch64"), unsafe(naked))]
#[unsafe(no_mangle)]
pub unsafe extern "C" fn airlight_choose(
    options: *const airlight_options,
    batch: *const airlight_batch,
    choices: *const airlight_choices,
    counts: *mut airlight_counts,
) -> airlight_status {
    in_default_environment!(choose(options, batch, choices, counts))
}

/// `airlight_sample` for one ray; `sample->pdf` is 0 if it has no sample, or `u` is not in [0, 1].
#[cfg_attr(any(target_arch = "x86_64", target_arch = "aarch64"), unsafe(naked))]
#[unsafe(no_mangle)]
pub unsafe extern "C" fn airlight_sample_one(
    options: *const airlight_options,
    scene: *const airlight_scene,
    u: f32,
    sample: *mut airlight_one_sample,
) -> airlight_status {
    in_default_environment!(sample_one(options, scene, u, sample))
}

/// `airlight_pdf` for one ray.
#[cfg_attr(any(target_arch = "x86_64", target_arch = "aarch64"), unsafe(naked))]
#[unsafe(no_mangle)]
pub unsafe extern "C" fn airlight_pdf_one(
    options: *const airlight_options,
    scene: *const airlight_scene,
    t: f32,
    pdf: *mut f32,
) -> airlight_status {
    in_default_environment!(pdf_one(options, scene, t, pdf))
}

/// `airlight_cdf` for one ray.
#[cfg_attr(any(target_arch = "x86_64", target_arch = "aarch64"), unsafe(naked))]
#[unsafe(no_mangle)]
pub unsafe extern "C" fn airlight_cdf_one(
    options: *const airlight_options,
    scene: *const airlight_scene,
    t: f32,
    cdf: *mut f32,
) -> airlight_status {
    in_default_environment!(cdf_one(options, scene, t, cdf))
}

/// `airlight_evaluate` for one ray: as many floats as the medium has channels.
#[cfg_attr(any(target_arch = "x86_64", target_arch = "aarch64"), unsafe(naked))]
#[unsafe(no_mangle)]
pub unsafe extern "C" fn airlight_evaluate_one(
    options: *const airlight_options,
    scene: *const airlight_scene,
    t: f32,
    integrand: *mut f32,
) -> airlight_status {
    in_default_environment!(evaluate_one(options, scene, t, integrand))
}

/// `airlight_radiance` for one ray: as many floats as the medium has channels.
#[cfg_attr(any(target_arch = "x86_64", target_arch = "aarch64"), unsafe(naked))]
#[unsafe(no_mangle)]
pub unsafe extern "C" fn airlight_radiance_one(
    options: *const airlight_options,
    scene: *const airlight_scene,
    radiance: *mut f32,
) -> airlight_status {
    in_default_environment!(radiance_one(options, scene, radiance))
}

/// The version of airlight, such as "0.2.0".
#[unsafe(no_mangle)]
pub extern "C" fn airlight_version() -> *const c_char {
    const VERSION: &CStr = match CStr::from_bytes_with_nul(concat!(env!("CARGO_PKG_VERSION"), "\0").as_bytes()) {
        Ok(version) => version,
        Err(_) => panic!("a version is text"),
    };
    VERSION.as_ptr()
}

/// A status in words.
#[unsafe(no_mangle)]
pub extern "C" fn airlight_status_string(status: u32) -> *const c_char {
    describe(status).as_ptr()
}

/// Why the last call of this thread that failed did so, such as "batch.t_max.data is NULL"; empty if none did. Valid until
/// the next one fails.
#[unsafe(no_mangle)]
pub extern "C" fn airlight_last_message() -> *const c_char {
    last_message()
}

/// The name of an `airlight_strategy`, such as "product-5"; NULL if there is none.
#[unsafe(no_mangle)]
pub extern "C" fn airlight_strategy_name(number: u32) -> *const c_char {
    strategy(number).map_or(null(), |strategy| text(STRATEGIES, strategy.name()))
}

/// The name of an `airlight_backend`, such as "avx2", of 0 that of the fastest one; NULL if this CPU does not have it.
#[unsafe(no_mangle)]
pub extern "C" fn airlight_backend_name(number: u32) -> *const c_char {
    backend(number).map_or(null(), |backend| text(BACKENDS, backend.name()))
}

/// Whether this CPU has an `airlight_backend` whose multiply-adds round once: all such give the same bits.
#[unsafe(no_mangle)]
pub extern "C" fn airlight_backend_is_fused(number: u32) -> bool {
    backend(number).is_some_and(Backend::is_fused)
}

/// A name as C text; NULL if it is none of those.
fn text(names: &[&'static CStr], name: &str) -> *const c_char {
    let found = names.iter().find(|text| text.to_bytes() == name.as_bytes());
    found.map_or(null(), |text| text.as_ptr())
}
