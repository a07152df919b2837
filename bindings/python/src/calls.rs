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
    let (rays, shape) = batch.shape_with(py, &u)?;

    // Of what is not wanted the memory is never touched.
    let (mut block, values) = (Output::new(py, 4, &shape)?, u.values(py, &shape)?);
    let (u, [t, pdf, weights, distances]) = (&*values, block.slices()?);
    let mut samples = Samples::new(t, pdf);
    samples.weight = weight.then_some(weights);
    samples.r = r.then_some(distances);
    let counts = batch.run(py, rays, |rays, emitters, media| sampler.sample(rays, emitters, media, u, &mut samples))?;

    let array = |k, wanted: bool| wanted.then(|| block.array(k)).transpose();
    Ok((block.array(0)?, block.array(1)?, array(2, weight)?, array(3, r)?, tuple(counts)))
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
    at_distance(py, &scene, t, sampler("equi-angular", precision, threads)?, Sampler::evaluate)
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
    let (rays, shape) = batch.shape_with(py, &t)?;
    let (mut block, values) = (Output::new(py, 1, &shape)?, t.values(py, &shape)?);
    let (t, [out]) = (&*values, block.slices()?);
    batch.run(py, rays, |rays, emitters, media| call(&sampler, rays, emitters, media, t, out))?;
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
    let length = batch.length(py)?;
    let mut block = Output::new(py, 1, &length.shape())?;
    let [out] = block.slices()?;
    batch.run(py, length.rays(), |rays, emitters, media| integral.radiance(rays, emitters, media, out))?;
    block.array(0)
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
    let weights = Column::new("weights", weights)?;
    if let Some(length) = weights.length(py).filter(|length| *length != table.len()) {
        return Err(bad("weights", format_args!("{length} for {} emitters", table.len())));
    }
    let batch = Batch::new(&scene)?;
    let u = Given::one_each("u", u)?;
    let (rays, shape) = batch.shape_with(py, &u)?;

    let (mut index, mut probability) = (Output::new(py, 1, &shape)?, Output::new(py, 1, &shape)?);
    let (weights, values) = (weights.values(py, table.len())?, u.values(py, &shape)?);
    let (weights, u) = (&*weights, &*values);
    let ([index_out], [probability_out]) = (index.slices()?, probability.slices()?);
    let counts = batch
        .run(py, rays, |rays, _, media| integral.choose(rays, &table, weights, media, u, index_out, probability_out))?;
    Ok((index.array(0)?, probability.array(0)?, tuple(counts)))
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
