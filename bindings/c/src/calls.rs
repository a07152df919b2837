//! Calls for a batch.

use crate::abi::*;
use crate::arguments::{CountsPlace, Options, read};
use crate::batch::{Lights, RaysInMedia, check_unused, table_of_lights};
use crate::columns::{Columns, Open, Output};
use crate::span::Name;
use crate::status::{Failure, Result};
use airlight::{Counts, Emitters, Error, Media, Rays, Sampler, Samples};

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
    check_unused("samples.weight", samples.weight.map(|column| column.data.is_null()), rays.channels())?;
    let u = columns.floats("samples.u".into(), samples.u, per_ray)?;
    let t = columns.output("samples.t".into(), samples.t, per_ray)?;
    let pdf = columns.output("samples.pdf".into(), samples.pdf, per_ray)?;
    let weight = columns.if_wanted(Name("samples.weight", Some(0)), samples.weight[0], per_ray)?;
    let r = columns.if_wanted("samples.r".into(), samples.r, per_ray)?;

    let counts = columns.travel(per_ray, options.threads(), |block, rooms, threads| {
        let open = |column: Output<f32>, rooms: &mut _| column.open(block, rooms);
        let ((rays, media), emitters) = (rays.read(block, rooms), lights.read(block, rooms));
        let (u, t, pdf) = (u.read(block, rooms), open(t, rooms), open(pdf, rooms));
        let (mut weight, mut r) = (weight.map(|column| open(column, rooms)), r.map(|column| open(column, rooms)));
        let mut out = Samples::new(t.values, pdf.values);
        if let Some(weight) = &mut weight {
            out = out.weight(weight.values);
        }
        if let Some(r) = &mut r {
            out = out.r(r.values);
        }
        let counts = sampler.with_threads(threads).sample(&rays, &emitters, &media, u, &mut out)?;
        [t, pdf].into_iter().chain(weight).chain(r).for_each(Open::close);
        Ok(counts)
    })?;
    place.write(counts);
    Ok(())
}

/// What is known at given distances.
pub(crate) type AtDistance =
    fn(&Sampler, &Rays<'_>, &Emitters<'_>, &Media<'_>, &[f32], &mut [f32]) -> core::result::Result<Counts, Error>;

/// Writes what is known at given distances.
///
/// # Safety
/// As [`sample`].
pub(crate) unsafe fn at_distances(
    at_distance: AtDistance,
    options: *const airlight_options,
    batch: *const airlight_batch,
    values: *const airlight_values,
    counts: *mut airlight_counts,
) -> Result<()> {
    // SAFETY: as promised.
    let (call, values) = unsafe { (Call::new(options, batch, counts, Lights::new)?, read("values", values)?) };
    let Call { options, mut columns, rays, lights, counts: place } = call;
    let sampler = options.sampler()?;
    let per_ray = at_least_one("values.per_ray", values.per_ray)?;
    check_unused("values.value", values.value.map(|column| column.data.is_null()), 1)?;
    let t = columns.floats("values.t".into(), values.t, per_ray)?;
    let value = columns.output(Name("values.value", Some(0)), values.value[0], per_ray)?;

    let counts = columns.travel(per_ray, options.threads(), |block, rooms, threads| {
        let ((rays, media), emitters) = (rays.read(block, rooms), lights.read(block, rooms));
        let (t, value) = (t.read(block, rooms), value.open(block, rooms));
        let counts = at_distance(&sampler.with_threads(threads), &rays, &emitters, &media, t, value.values)?;
        value.close();
        Ok(counts)
    })?;
    place.write(counts);
    Ok(())
}

/// Writes the radiance of each ray.
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
    let Call { options, mut columns, rays, lights, counts: place } = call;
    let integral = options.integral();
    check_unused("values.value", values.value.map(|column| column.data.is_null()), rays.channels())?;
    let value = columns.output(Name("values.value", Some(0)), values.value[0], 1)?;

    let counts = columns.travel(1, options.threads(), |block, rooms, threads| {
        let ((rays, media), emitters) = (rays.read(block, rooms), lights.read(block, rooms));
        let value = value.open(block, rooms);
        let counts = integral.with_threads(threads).radiance(&rays, &emitters, &media, value.values)?;
        value.close();
        Ok(counts)
    })?;
    place.write(counts);
    Ok(())
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
