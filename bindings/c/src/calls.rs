//! Calls for a batch.

use crate::abi::*;
use crate::arguments::{CountsPlace, Options, read};
use crate::batch::{Lights, RaysInMedia, table_of_lights};
use crate::columns::{Columns, Open, Output};
use crate::status::{Failure, Result};
use airlight::{Counts, Emitters, Error, Media, Rays, Sampler, Samples};
use core::array;

/// What every call takes; `L` is what lights the rays.
struct Call<L> {
    options: Options,
    columns: Columns,
    rays: RaysInMedia,
    lights: L,
    counts: CountsPlace,
}

impl<L> Call<L> {
    /// A call with what `lights` reads of the batch.
    ///
    /// # Safety
    /// All pointers are NULL or what they are said to be.
    unsafe fn new(
        options: *const airlight_options,
        batch: *const airlight_batch,
        counts: *mut airlight_counts,
        lights: unsafe fn(&airlight_batch, &mut Columns) -> Result<L>,
    ) -> Result<Self> {
        // SAFETY: as promised.
        unsafe {
            let batch = read("batch", batch)?;
            let mut columns = Columns::new(batch.count);
            Ok(Self {
                options: Options::read(options)?,
                rays: RaysInMedia::new(&batch, &mut columns)?,
                lights: lights(&batch, &mut columns)?,
                counts: CountsPlace::new(counts)?,
                columns,
            })
        }
    }
}

/// Samples.
///
/// # Safety
/// All pointers are NULL or what they are said to be.
pub(crate) unsafe fn sample(
    options: *const airlight_options,
    batch: *const airlight_batch,
    samples: *const airlight_samples,
    counts: *mut airlight_counts,
) -> Result<()> {
    // SAFETY: as promised.
    let (call, samples) = unsafe { (Call::new(options, batch, counts, Lights::new)?, read("samples", samples)?) };
    let Call { options, mut columns, rays, lights, counts: place } = call;
    let sampler = options.sampler()?;
    let per_ray = at_least_one("samples.per_ray", samples.per_ray)?;
    let is_weighted = samples.weight.iter().any(|column| !column.data.is_null());
    let u = columns.floats("samples.u".into(), samples.u, per_ray)?;
    let t = columns.output("samples.t".into(), samples.t, per_ray)?;
    let pdf = columns.output("samples.pdf".into(), samples.pdf, per_ray)?;
    let channels = if is_weighted { rays.channels() } else { 0 };
    let weights = columns.channels("samples.weight", samples.weight, channels, per_ray)?;
    let r = columns.if_wanted("samples.r".into(), samples.r, per_ray)?;

    let counts = columns.travel(per_ray, options.threads(), |block, rooms, threads| {
        let open = |column: Output<f32>, rooms: &mut _| column.open(block, rooms);
        let ((rays, media), emitters) = (rays.read(block, rooms), lights.read(block, rooms));
        let (u, t, pdf) = (u.read(block, rooms), open(t, rooms), open(pdf, rooms));
        let mut weights: Vec<_> = weights.iter().map(|&column| open(column, rooms)).collect();
        let mut r = r.map(|column| open(column, rooms));
        let mut out = Samples::new(t.values, pdf.values);
        for (weight, open) in out.weights.iter_mut().zip(&mut weights) {
            *weight = Some(open.values);
        }
        if let Some(r) = &mut r {
            out = out.r(r.values);
        }
        let counts = sampler.with_threads(threads).sample(&rays, &emitters, &media, u, &mut out)?;
        [t, pdf].into_iter().chain(weights).chain(r).for_each(Open::close);
        Ok(counts)
    })?;
    place.write(counts);
    Ok(())
}

/// Writes the density at given distances.
///
/// # Safety
/// As [`sample`].
pub(crate) unsafe fn pdf(
    options: *const airlight_options,
    batch: *const airlight_batch,
    values: *const airlight_values,
    counts: *mut airlight_counts,
) -> Result<()> {
    // SAFETY: as promised.
    let (call, values) = unsafe { (Call::new(options, batch, counts, Lights::new)?, read("values", values)?) };
    call.at_distances(&values, |sampler, rays, emitters, media, t, [pdf]| sampler.pdf(rays, emitters, media, t, pdf))
}

/// Writes the distribution function at given distances.
///
/// # Safety
/// As [`sample`].
pub(crate) unsafe fn cdf(
    options: *const airlight_options,
    batch: *const airlight_batch,
    values: *const airlight_values,
    counts: *mut airlight_counts,
) -> Result<()> {
    // SAFETY: as promised.
    let (call, values) = unsafe { (Call::new(options, batch, counts, Lights::new)?, read("values", values)?) };
    call.at_distances(&values, |sampler, rays, emitters, media, t, [cdf]| sampler.cdf(rays, emitters, media, t, cdf))
}

/// Writes the integrand at given distances, for each channel.
///
/// # Safety
/// As [`sample`].
pub(crate) unsafe fn evaluate(
    options: *const airlight_options,
    batch: *const airlight_batch,
    values: *const airlight_values,
    counts: *mut airlight_counts,
) -> Result<()> {
    // SAFETY: as promised.
    let (call, values) = unsafe { (Call::new(options, batch, counts, Lights::new)?, read("values", values)?) };
    match call.rays.channels() {
        3 => call.at_distances::<3>(&values, Sampler::evaluate_coloured),
        4 => call.at_distances::<4>(&values, Sampler::evaluate_coloured),
        _ => call.at_distances::<1>(&values, Sampler::evaluate_coloured),
    }
}

/// Writes the radiance of each ray, for each channel.
///
/// # Safety
/// As [`sample`].
pub(crate) unsafe fn radiance(
    options: *const airlight_options,
    batch: *const airlight_batch,
    values: *const airlight_values,
    counts: *mut airlight_counts,
) -> Result<()> {
    // SAFETY: as promised.
    let (call, values) = unsafe { (Call::new(options, batch, counts, Lights::new)?, read("values", values)?) };
    match call.rays.channels() {
        3 => call.radiance::<3>(&values),
        4 => call.radiance::<4>(&values),
        _ => call.radiance::<1>(&values),
    }
}

/// What is known at given distances, in each of `C` channels.
type AtDistances<const C: usize> =
    fn(&Sampler, &Rays<'_>, &Emitters<'_>, &Media<'_>, &[f32], [&mut [f32]; C]) -> core::result::Result<Counts, Error>;

impl Call<Lights> {
    /// Writes what is known at given distances.
    fn at_distances<const C: usize>(self, values: &airlight_values, at_distances: AtDistances<C>) -> Result<()> {
        let Self { options, mut columns, rays, lights, counts: place } = self;
        let sampler = options.sampler()?;
        let per_ray = at_least_one("values.per_ray", values.per_ray)?;
        let t = columns.floats("values.t".into(), values.t, per_ray)?;
        let outputs = columns.channels("values.value", values.value, C, per_ray)?;

        let counts = columns.travel(per_ray, options.threads(), |block, rooms, threads| {
            let ((rays, media), emitters) = (rays.read(block, rooms), lights.read(block, rooms));
            let t = t.read(block, rooms);
            let mut open: [_; C] = array::from_fn(|c| outputs[c].open(block, rooms));
            let out = open.each_mut().map(|open| &mut *open.values);
            let counts = at_distances(&sampler.with_threads(threads), &rays, &emitters, &media, t, out)?;
            open.into_iter().for_each(Open::close);
            Ok(counts)
        })?;
        place.write(counts);
        Ok(())
    }

    /// Writes the radiance of each ray, in each of `C` channels.
    fn radiance<const C: usize>(self, values: &airlight_values) -> Result<()> {
        let Self { options, mut columns, rays, lights, counts: place } = self;
        let integral = options.integral();
        let outputs = columns.channels("values.value", values.value, C, 1)?;

        let counts = columns.travel(1, options.threads(), |block, rooms, threads| {
            let ((rays, media), emitters) = (rays.read(block, rooms), lights.read(block, rooms));
            let mut open: [_; C] = array::from_fn(|c| outputs[c].open(block, rooms));
            let out = open.each_mut().map(|open| &mut *open.values);
            let counts = integral.with_threads(threads).radiance_coloured(&rays, &emitters, &media, out)?;
            open.into_iter().for_each(Open::close);
            Ok(counts)
        })?;
        place.write(counts);
        Ok(())
    }
}

/// Chooses an emitter for each ray.
///
/// # Safety
/// As [`sample`].
pub(crate) unsafe fn choose(
    options: *const airlight_options,
    batch: *const airlight_batch,
    choices: *const airlight_choices,
    counts: *mut airlight_counts,
) -> Result<()> {
    // SAFETY: as promised.
    let (call, choices) = unsafe { (Call::new(options, batch, counts, table_of_lights)?, read("choices", choices)?) };
    let Call { options, mut columns, rays, lights: table, counts: place } = call;
    let integral = options.integral();
    let weights = columns.table("choices.weights".into(), choices.weights, table.len())?;
    let u = columns.floats("choices.u".into(), choices.u, 1)?;
    let index = columns.index_output("choices.index".into(), choices.index)?;
    let probability = columns.output("choices.probability".into(), choices.probability, 1)?;

    let counts = columns.travel(1, options.threads(), |block, rooms, threads| {
        let (rays, media) = rays.read(block, rooms);
        let u = u.read(block, rooms);
        let (index, probability) = (index.open(block, rooms), probability.open(block, rooms));
        let integral = integral.with_threads(threads);
        let counts = integral.choose(&rays, &table, &weights, &media, u, index.values, probability.values)?;
        index.close();
        probability.close();
        Ok(counts)
    })?;
    place.write(counts);
    Ok(())
}

fn at_least_one(field: &str, count: usize) -> Result<usize> {
    if count > 0 { Ok(count) } else { Err(Failure::value(field, count, "at least 1")) }
}
