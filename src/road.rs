//! From a call to its kernels: columns -> geometry -> density -> inversion -> samples.
//!
//! A batch is cut into chunks, each of them a task of one thread, and a chunk into blocks of a few lane groups. The passes of a task
//! and a density run over a block, one after the other. The arithmetic of a ray does not depend on its place in the batch:
//! chunks, blocks and threads change no bit.

mod at_distance;
mod blocks;
mod choose;
mod evaluate;
mod locate;
mod radiance;
mod sample;
#[cfg(feature = "measure")]
pub(crate) mod stages;
mod tally;

pub(crate) use at_distance::{Cdf, Pdf};
pub(crate) use choose::{Choose, Lights};
pub(crate) use evaluate::Evaluate;
pub(crate) use radiance::{Quadrature, Radiance};
pub(crate) use sample::Sample;

use crate::batch::{Counts, Inputs, Outputs, Pads, Rays, first_values};
use crate::density::Kind;
use crate::scene::{Emitter, Medium, Ray};
use crate::simd::{Backend, GROUPS, Isa, Kernel, MOST_LANES, Machine};
use crate::strategy::product::knots;
use crate::strategy::{equi_angular, point_normal, taylor_phase, taylor_transmittance, transmittance};
use crate::threads::{Split, Threads};
use crate::{Precision, Strategy};
use core::marker::PhantomData;
use core::ops::Range;
use core::slice::from_ref;

/// The number of values of a chunk where threads share a batch: less takes about as long as to hand it to another thread.
const CHUNK: usize = 4096;
/// The number of values of a chunk where one thread has the batch.
const LONG_CHUNK: usize = 1 << 16;
/// A ray with at least this number of values is a chunk of its own. Its values fill the lanes, and it costs the set-up of a whole
/// lane group: with 32 lanes, one set-up for 32 samples.
const MANY: usize = 1024;
/// The number of lane groups by which rays, variates, `t` and `pdf` are prefetched before they are read or written.
const AHEAD: usize = 2 * GROUPS;

/// The output columns of a task.
pub(crate) type Out<'a, T> = <<T as Task>::Out as Outputs>::At<'a>;

/// The density and the precision.
#[derive(Clone, Copy)]
pub(crate) struct Method {
    pub(crate) strategy: Strategy,
    pub(crate) precision: Precision,
}

/// What a call computes for every ray.
pub(crate) trait Task {
    /// The parameters of the call.
    type Method: Copy + Send + Sync;
    /// The output columns.
    type Out: Outputs;

    /// Runs the passes of the method over whole lane groups.
    fn run(machine: impl Machine, method: Self::Method, inputs: &Inputs<'_>, out: Out<'_, Self>) -> Counts;
}

/// A task for which every density has a kernel of its own.
trait OfDensity: Task {
    fn groups<I: Isa, D: Kind>(isa: I, precision: Precision, inputs: &Inputs<'_>, out: Out<'_, Self>) -> Counts;
}

/// The kernel of a task and a density.
struct OnGroups<'i, 'o, T: Task, D> {
    precision: Precision,
    inputs: &'i Inputs<'i>,
    out: Out<'o, T>,
    density: PhantomData<D>,
}

impl<T: OfDensity, D: Kind> Kernel for OnGroups<'_, '_, T, D> {
    type Output = Counts;

    fn run<I: Isa>(self, isa: I) -> Counts {
        T::groups::<I, D>(isa, self.precision, self.inputs, self.out)
    }
}

/// Runs the kernel of a task for a strategy.
fn by_strategy<T: OfDensity>(machine: impl Machine, method: Method, inputs: &Inputs<'_>, out: Out<'_, T>) -> Counts {
    let Method { strategy, precision } = method;
    fn with<T: OfDensity, D: Kind>(
        machine: impl Machine,
        precision: Precision,
        inputs: &Inputs<'_>,
        out: Out<'_, T>,
    ) -> Counts {
        machine.run(OnGroups::<T, D> { precision, inputs, out, density: PhantomData })
    }
    match strategy {
        Strategy::Transmittance => with::<T, transmittance::Kind>(machine, precision, inputs, out),
        Strategy::EquiAngular => match precision {
            Precision::Exact => with::<T, equi_angular::Kind<true>>(machine, precision, inputs, out),
            Precision::Fast => with::<T, equi_angular::Kind<false>>(machine, precision, inputs, out),
        },
        Strategy::PointNormal => match precision {
            Precision::Exact => with::<T, point_normal::Kind<true>>(machine, precision, inputs, out),
            Precision::Fast => with::<T, point_normal::Kind<false>>(machine, precision, inputs, out),
        },
        Strategy::TaylorTransmittance => {
            with::<T, taylor_transmittance::OfTransmittance>(machine, precision, inputs, out)
        }
        Strategy::TaylorPhase => with::<T, taylor_phase::OfPhase>(machine, precision, inputs, out),
        Strategy::Product3 => with::<T, knots::three::Kind>(machine, precision, inputs, out),
        Strategy::Product5 => with::<T, knots::five::Kind>(machine, precision, inputs, out),
        Strategy::Product9 => with::<T, knots::nine::Kind>(machine, precision, inputs, out),
        Strategy::Product17 => with::<T, knots::seventeen::Kind>(machine, precision, inputs, out),
    }
}

/// Runs a task on a batch, its chunks spread over the threads.
pub(crate) fn travel<T: Task>(
    threads: Threads,
    backend: Backend,
    method: T::Method,
    inputs: &Inputs<'_>,
    out: Out<'_, T>,
) -> Counts {
    // A single chunk does not start the pool.
    let split = if is_one_chunk(inputs, CHUNK) { None } else { threads.split() };
    let (share, chunk) = split.map_or(([1, 2], LONG_CHUNK), |split| (split.share, CHUNK));
    let Some((low, high)) = parts(inputs, share, chunk) else {
        return by_groups::<T>(backend, method, inputs, out);
    };
    let (out_low, out_high) = T::Out::split_at(out, low.values());
    let on = |threads, inputs: Inputs<'_>, out| travel::<T>(threads, backend, method, &inputs, out);
    match split {
        Some(Split { threads: [of_low, of_high], .. }) => {
            let (low, high) = join(|| on(of_low, low, out_low), || on(of_high, high, out_high));
            low + high
        }
        _ => on(threads, low, out_low) + on(threads, high, out_high),
    }
}

#[cfg(feature = "rayon")]
use rayon::join;

/// One after the other.
#[cfg(not(feature = "rayon"))]
fn join<A, B>(a: impl FnOnce() -> A, b: impl FnOnce() -> B) -> (A, B) {
    (a(), b())
}

/// Runs a task on one ray with the numbers `given`.
pub(crate) fn travel_one<T: Task>(
    backend: Backend,
    method: T::Method,
    (ray, emitter, medium): (&Ray, &Emitter, &Medium),
    given: &[f32],
    out: Out<'_, T>,
) -> Counts {
    let (origin, direction, t_min, t_max) = (ray.origin(), ray.direction(), ray.t_min(), ray.t_max());
    let rays = Rays::new(
        [0, 1, 2].map(|k| from_ref(&origin[k])),
        [0, 1, 2].map(|k| from_ref(&direction[k])),
        from_ref(&t_min),
        from_ref(&t_max),
    );
    by_groups::<T>(backend, method, &Inputs::one(rays, *emitter, *medium, given), out)
}

/// Two parts of whole chunks of about `values` values (only the last chunk may be short), the first with about `low/all` of them;
/// `None` for a single chunk.
fn parts<'a>(inputs: &Inputs<'a>, [low, all]: [usize; 2], values: usize) -> Option<(Inputs<'a>, Inputs<'a>)> {
    // Both parts have at least one chunk.
    let first = |length: usize, chunk: usize| {
        let chunks = length.div_ceil(chunk) as u128 * low as u128 / all as u128;
        (chunks as usize).max(1) * chunk
    };
    let (rays, per_ray) = (inputs.len(), inputs.per_ray);
    if is_one_chunk(inputs, values) {
        None
    } else if rays > 1 {
        let first = first(rays, rays_of_chunk(per_ray, values));
        Some((inputs.slice(0..first), inputs.slice(first..rays)))
    } else {
        let first = first(per_ray, values);
        Some((inputs.of_one_ray(0..first), inputs.of_one_ray(first..per_ray)))
    }
}

/// Whether a batch is not cut into chunks of about `values` values.
fn is_one_chunk(inputs: &Inputs<'_>, values: usize) -> bool {
    let (rays, per_ray) = (inputs.len(), inputs.per_ray);
    if rays == 1 { per_ray <= values } else { rays <= rays_of_chunk(per_ray, values) }
}

/// The number of rays of a chunk of about `values` values.
fn rays_of_chunk(per_ray: usize, values: usize) -> usize {
    if per_ray >= MANY { 1 } else { (values / per_ray).next_multiple_of(MOST_LANES) }
}

/// Runs a task on a chunk. Passes run over whole lane groups. The rays that do not fill a group run one by one, or in a group with
/// the rays before them, or in a group with pads.
fn by_groups<T: Task>(backend: Backend, method: T::Method, inputs: &Inputs<'_>, mut out: Out<'_, T>) -> Counts {
    let (lanes, rays, per_ray) = (backend.lanes(), inputs.len(), inputs.per_ray);
    match rays {
        0 => return Counts::default(),
        1 => return one_ray::<T>(backend, method, inputs, out),
        _ => {}
    }
    let few = rays % lanes;
    if few == 0 {
        return T::run(backend, method, inputs, out);
    }
    let whole = rays - few;
    let mut counts = Counts::default();
    if whole > 0 {
        let out = T::Out::part(&mut out, 0..rays * per_ray);
        counts = T::run(backend, method, inputs, out);
    }
    // The number of set-ups and samples of lane groups, which take about equal times: one by one, and together.
    let by_themselves = few * (1 + per_ray.div_ceil(lanes)) < 1 + per_ray;
    let rest = if by_themselves {
        let of_ray = |i| {
            let out = T::Out::part(&mut out, i * per_ray..(i + 1) * per_ray);
            one_ray::<T>(backend, method, &inputs.slice(i..i + 1), out)
        };
        (whole..rays).map(of_ray).fold(Counts::default(), |sum, counts| sum + counts)
    } else if whole > 0 {
        // A group that ends with the last ray: some values are written again, with the same bits.
        let last = inputs.slice(rays - lanes..rays).counting(lanes - few..lanes);
        let out = T::Out::part(&mut out, (rays - lanes) * per_ray..rays * per_ray);
        T::run(backend, method, &last, out)
    } else {
        let mut pads = Pads::new();
        let padded = pads.of_rays(inputs, lanes).counting(0..few);
        if per_ray == 1 {
            let given = first_values(inputs.given);
            T::Out::by_pads(out, |out| T::run(backend, method, &padded.by_turn(&given, 1), out))
        } else {
            // Lanes beyond the rays have no values.
            T::run(backend, method, &padded, out)
        }
    };
    counts + rest
}

/// Runs a task on one ray: every lane has this ray, and a value of its own.
fn one_ray<T: Task>(backend: Backend, method: T::Method, inputs: &Inputs<'_>, mut out: Out<'_, T>) -> Counts {
    let (lanes, values) = (backend.lanes(), inputs.per_ray);
    let mut pads = Pads::new();
    let everywhere = pads.of_rays(inputs, lanes);
    if values < lanes {
        let given = first_values(inputs.given);
        let turn = everywhere.by_turn(&given, 1).counting(0..values);
        return T::Out::by_pads(out, |out| T::run(backend, method, &turn, out));
    }
    let mut run = |range: Range<usize>, counted| {
        let given = inputs.of_one_ray(range.clone()).given;
        let turns = everywhere.by_turn(given, range.len() / lanes).counting(counted);
        T::run(backend, method, &turns, T::Out::part(&mut out, range))
    };
    let few = values % lanes;
    let whole = run(0..values - few, 0..lanes);
    // A turn that ends with the last value.
    if few == 0 { whole } else { whole + run(values - lanes..values, lanes - few..lanes) }
}
