//! What the entries of the ABI call, in the default floating-point environment: nothing unwinds out of it.

use crate::abi::*;
use crate::status::report;
use crate::{calls, one};
use airlight::Sampler;

/// [`airlight_sample`](crate::airlight_sample).
pub(crate) unsafe extern "C" fn sample(
    options: *const airlight_options,
    batch: *const airlight_batch,
    samples: *const airlight_samples,
    counts: *mut airlight_counts,
) -> airlight_status {
    // SAFETY: as the caller of the ABI promises.
    report(|| unsafe { calls::sample(options, batch, samples, counts) })
}

/// [`airlight_pdf`](crate::airlight_pdf).
pub(crate) unsafe extern "C" fn pdf(
    options: *const airlight_options,
    batch: *const airlight_batch,
    values: *const airlight_values,
    counts: *mut airlight_counts,
) -> airlight_status {
    // SAFETY: as the caller of the ABI promises.
    report(|| unsafe { calls::pdf(options, batch, values, counts) })
}

/// [`airlight_cdf`](crate::airlight_cdf).
pub(crate) unsafe extern "C" fn cdf(
    options: *const airlight_options,
    batch: *const airlight_batch,
    values: *const airlight_values,
    counts: *mut airlight_counts,
) -> airlight_status {
    // SAFETY: as the caller of the ABI promises.
    report(|| unsafe { calls::cdf(options, batch, values, counts) })
}

/// [`airlight_evaluate`](crate::airlight_evaluate).
pub(crate) unsafe extern "C" fn evaluate(
    options: *const airlight_options,
    batch: *const airlight_batch,
    values: *const airlight_values,
    counts: *mut airlight_counts,
) -> airlight_status {
    // SAFETY: as the caller of the ABI promises.
    report(|| unsafe { calls::evaluate(options, batch, values, counts) })
}

/// [`airlight_radiance`](crate::airlight_radiance).
pub(crate) unsafe extern "C" fn radiance(
    options: *const airlight_options,
    batch: *const airlight_batch,
    values: *const airlight_values,
    counts: *mut airlight_counts,
) -> airlight_status {
    // SAFETY: as the caller of the ABI promises.
    report(|| unsafe { calls::radiance(options, batch, values, counts) })
}

/// [`airlight_choose`](crate::airlight_choose).
pub(crate) unsafe extern "C" fn choose(
    options: *const airlight_options,
    batch: *const airlight_batch,
    choices: *const airlight_choices,
    counts: *mut airlight_counts,
) -> airlight_status {
    // SAFETY: as the caller of the ABI promises.
    report(|| unsafe { calls::choose(options, batch, choices, counts) })
}

/// [`airlight_sample_one`](crate::airlight_sample_one).
pub(crate) unsafe extern "C" fn sample_one(
    options: *const airlight_options,
    scene: *const airlight_scene,
    u: f32,
    sample: *mut airlight_one_sample,
) -> airlight_status {
    // SAFETY: as the caller of the ABI promises.
    report(|| unsafe { one::sample_one(options, scene, u, sample) })
}

/// [`airlight_pdf_one`](crate::airlight_pdf_one).
pub(crate) unsafe extern "C" fn pdf_one(
    options: *const airlight_options,
    scene: *const airlight_scene,
    t: f32,
    pdf: *mut f32,
) -> airlight_status {
    // SAFETY: as the caller of the ABI promises.
    report(|| unsafe { one::at_distance(Sampler::pdf_one, options, scene, t, pdf) })
}

/// [`airlight_cdf_one`](crate::airlight_cdf_one).
pub(crate) unsafe extern "C" fn cdf_one(
    options: *const airlight_options,
    scene: *const airlight_scene,
    t: f32,
    cdf: *mut f32,
) -> airlight_status {
    // SAFETY: as the caller of the ABI promises.
    report(|| unsafe { one::at_distance(Sampler::cdf_one, options, scene, t, cdf) })
}

/// [`airlight_evaluate_one`](crate::airlight_evaluate_one).
pub(crate) unsafe extern "C" fn evaluate_one(
    options: *const airlight_options,
    scene: *const airlight_scene,
    t: f32,
    integrand: *mut f32,
) -> airlight_status {
    // SAFETY: as the caller of the ABI promises.
    report(|| unsafe { one::evaluate_one(options, scene, t, integrand) })
}

/// [`airlight_radiance_one`](crate::airlight_radiance_one).
pub(crate) unsafe extern "C" fn radiance_one(
    options: *const airlight_options,
    scene: *const airlight_scene,
    radiance: *mut f32,
) -> airlight_status {
    // SAFETY: as the caller of the ABI promises.
    report(|| unsafe { one::radiance_one(options, scene, radiance) })
}
