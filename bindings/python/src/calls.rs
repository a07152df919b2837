//! The calls behind the functions of the package: arguments by position, results as tuples.

use crate::batch::{Batch, Given, Scene};
use crate::columns::Column;
use crate::error::{bad, refused};
use crate::output::Output;
use crate::scene::Emitter;
use airlight::{Counts, Emitters, Error, Integral, Media, Nodes, Precision, Rays, Sampler, Samples, Strategy, Threads};
use pyo3::prelude::*;
use std::sync::atomic::{AtomicBool, Ordering};

/// What is returned of the counts: sampled, empty, invalid, bisected.
type CountsTuple = (usize, usize, usize, usize);

/// `airlight.sample`: t, pdf, weight and r, if these are wanted, and the counts.
#[pyfunction]
#[expect(clippy::too_many_arguments, clippy::type_complexity, reason = "what `airlight.sample` takes and returns")]
pub(crate) fn sample<'py>(
    py: Python<'py>,
    scene: Scene<'py>,
    u: &Bound<'py, PyAny>,
    strategy: &str,
    precision: &str,
    threads: Option<i64>,
    weight: bool,
    r: bool,
) -> PyResult<(Bound<'py, PyAny>, Bound<'py, PyAny>, Option<Bound<'py, PyAny>>, Option<Bound<'py, PyAny>>, CountsTuple)>
{
    let sampler = sampler(strategy, precision, threads)?;
    let batch = Batch::new(&scene)?;
    let u = Given::new("u", u)?;
    let layout = batch.layout(py, Some(&u))?;

    // t, pdf, r, and a weight for each channel; of what is not wanted the memory is never touched.
    let channels = batch.channels();
    let mut block = Output::new(py, 3 + channels, &layout.shape)?;
    let [t, pdf, distances, mut weights @ ..]: [_; 7] = block.slices()?;
    let counts = batch.run(py, &layout, Some(&u), |rays, emitters, media, u, at| {
        let mut samples = Samples::new(&mut t[at.clone()], &mut pdf[at.clone()]);
        if weight {
            let written = weights.each_mut().into_iter().take(channels);
            samples.weights.iter_mut().zip(written).for_each(|(to, column)| *to = Some(&mut column[at.clone()]));
        }
        samples.r = if r { Some(&mut distances[at]) } else { None };
        sampler.sample(rays, emitters, media, u, &mut samples)
    })?;

    let weights = weight.then(|| block.channels(3, channels)).transpose()?;
    let distances = r.then(|| block.array(2)).transpose()?;
    Ok((block.array(0)?, block.array(1)?, weights, distances, tuple(counts)))
}

/// `airlight.pdf`.
#[pyfunction]
pub(crate) fn pdf<'py>(
    py: Python<'py>,
    scene: Scene<'py>,
    t: &Bound<'py, PyAny>,
    strategy: &str,
    precision: &str,
    threads: Option<i64>,
) -> PyResult<Bound<'py, PyAny>> {
    at_distance(py, &scene, t, sampler(strategy, precision, threads)?, Sampler::pdf)
}

/// `airlight.cdf`.
#[pyfunction]
pub(crate) fn cdf<'py>(
    py: Python<'py>,
    scene: Scene<'py>,
    t: &Bound<'py, PyAny>,
    strategy: &str,
    precision: &str,
    threads: Option<i64>,
) -> PyResult<Bound<'py, PyAny>> {
    at_distance(py, &scene, t, sampler(strategy, precision, threads)?, Sampler::cdf)
}

/// `airlight.evaluate`.
#[pyfunction]
pub(crate) fn evaluate<'py>(
    py: Python<'py>,
    scene: Scene<'py>,
    t: &Bound<'py, PyAny>,
    precision: &str,
    threads: Option<i64>,
) -> PyResult<Bound<'py, PyAny>> {
    // The integrand is the same for every strategy of a precision; this one has both.
    let sampler = sampler("equi-angular", precision, threads)?;
    let batch = Batch::new(&scene)?;
    let t = Given::new("t", t)?;
    let (layout, channels) = (batch.layout(py, Some(&t))?, batch.channels());
    let mut block = Output::new(py, 4, &layout.shape)?;
    let mut out: [_; 4] = block.slices()?;
    batch.run(py, &layout, Some(&t), |rays, emitters, media, t, at| {
        let [a, b, c, d] = out.each_mut().map(|column| &mut column[at.clone()]);
        match channels {
            3 => sampler.evaluate_coloured(rays, emitters, media, t, [a, b, c]),
            4 => sampler.evaluate_coloured(rays, emitters, media, t, [a, b, c, d]),
            _ => sampler.evaluate(rays, emitters, media, t, a),
        }
    })?;
    block.channels(0, channels)
}

/// `Sampler::pdf` and its like.
type AtDistance = fn(&Sampler, &Rays<'_>, &Emitters<'_>, &Media<'_>, &[f32], &mut [f32]) -> Result<Counts, Error>;

/// A value for each distance.
fn at_distance<'py>(
    py: Python<'py>,
    scene: &Scene<'py>,
    t: &Bound<'py, PyAny>,
    sampler: Sampler,
    call: AtDistance,
) -> PyResult<Bound<'py, PyAny>> {
    let batch = Batch::new(scene)?;
    let t = Given::new("t", t)?;
    let layout = batch.layout(py, Some(&t))?;
    let mut block = Output::new(py, 1, &layout.shape)?;
    let [out] = block.slices()?;
    batch.run(py, &layout, Some(&t), |rays, emitters, media, t, at| {
        call(&sampler, rays, emitters, media, t, &mut out[at])
    })?;
    block.array(0)
}

/// `airlight.radiance`.
#[pyfunction]
pub(crate) fn radiance<'py>(
    py: Python<'py>,
    scene: Scene<'py>,
    nodes: i64,
    precision: &str,
    threads: Option<i64>,
) -> PyResult<Bound<'py, PyAny>> {
    let integral = integral(nodes, precision, threads)?;
    let batch = Batch::new(&scene)?;
    let (layout, channels) = (batch.layout(py, None)?, batch.channels());
    let mut block = Output::new(py, 4, &layout.shape)?;
    let mut out: [_; 4] = block.slices()?;
    batch.run(py, &layout, None, |rays, emitters, media, _, at| {
        let [a, b, c, d] = out.each_mut().map(|column| &mut column[at.clone()]);
        match channels {
            3 => integral.radiance_coloured(rays, emitters, media, [a, b, c]),
            4 => integral.radiance_coloured(rays, emitters, media, [a, b, c, d]),
            _ => integral.radiance(rays, emitters, media, a),
        }
    })?;
    block.channels(0, channels)
}

/// `airlight.choose`: index, probability and counts. The emitter of the scene is any one of the table.
#[pyfunction]
#[expect(clippy::too_many_arguments, reason = "what `airlight.choose` takes")]
pub(crate) fn choose<'py>(
    py: Python<'py>,
    scene: Scene<'py>,
    table: Vec<PyRef<'py, Emitter>>,
    weights: &Bound<'py, PyAny>,
    u: &Bound<'py, PyAny>,
    nodes: i64,
    precision: &str,
    threads: Option<i64>,
) -> PyResult<(Bound<'py, PyAny>, Bound<'py, PyAny>, CountsTuple)> {
    let integral = integral(nodes, precision, threads)?;
    let table: Vec<_> = table.iter().map(|emitter| emitter.0).collect();
    let weights = weights_of(&table, weights)?;
    let batch = Batch::new(&scene)?;
    let u = Given::one_each("u", u)?;
    let layout = batch.layout(py, Some(&u))?;
    let (mut index, mut probability) = (Output::new(py, 1, &layout.shape)?, Output::new(py, 1, &layout.shape)?);
    let ([index_out], [probability_out]) = (index.slices()?, probability.slices()?);
    let counts = batch.run(py, &layout, Some(&u), |rays, _, media, u, at| {
        let (index, probability) = (&mut index_out[at.clone()], &mut probability_out[at]);
        integral.choose(rays, &table, &weights, media, u, index, probability)
    })?;
    Ok((index.array(0)?, probability.array(0)?, tuple(counts)))
}

/// The weights of the emitters of a table; one number is that of all.
fn weights_of(table: &[airlight::Emitter], weights: &Bound<'_, PyAny>) -> PyResult<Vec<f32>> {
    let (py, column) = (weights.py(), Column::new("weights", weights)?);
    match column.length(py) {
        Some(length) if length != table.len() => {
            Err(bad("weights", format_args!("{length} for {} emitters", table.len())))
        }
        _ => column.to_vec(py, table.len()),
    }
}

/// The sampler of a call's options.
fn sampler(strategy: &str, precision: &str, threads: Option<i64>) -> PyResult<Sampler> {
    let strategy: Strategy = strategy.parse().map_err(|error| bad("strategy", error))?;
    let sampler = Sampler::new(strategy).with_threads(of(threads)?);
    sampler.with_precision(named(precision)?).map_err(refused)
}

/// The integral of a call's options.
fn integral(nodes: i64, precision: &str, threads: Option<i64>) -> PyResult<Integral> {
    let nodes: Nodes = nodes.to_string().parse().map_err(|error| bad("nodes", error))?;
    Ok(Integral::new(nodes).with_precision(named(precision)?).with_threads(of(threads)?))
}

fn named(precision: &str) -> PyResult<Precision> {
    precision.parse().map_err(|error| bad("precision", error))
}

/// Whether this process is a fork: then the pool's threads are not in it, and a call that waits for them never returns.
static FORKED: AtomicBool = AtomicBool::new(false);

/// What a forked process does first.
#[pyfunction]
pub(crate) fn forked() {
    FORKED.store(true, Ordering::Relaxed);
}

/// Where a call runs: on at most so many threads, or on all.
fn of(threads: Option<i64>) -> PyResult<Threads> {
    match threads.map(usize::try_from) {
        Some(Ok(0) | Err(_)) => Err(bad("threads", "expected 1 or more, or None")),
        _ if FORKED.load(Ordering::Relaxed) => Ok(Threads::Caller),
        Some(Ok(most)) => Ok(Threads::at_most(most)),
        None => Ok(Threads::Pool),
    }
}

fn tuple(counts: Counts) -> CountsTuple {
    (counts.sampled, counts.empty, counts.invalid, counts.bisected)
}
