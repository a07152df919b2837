//! The road that every ray takes: columns -> geometry -> density -> inversion -> samples.
//!
//! A batch is cut into chunks that stay in a core's cache; a chunk goes through the kernel of one strategy, a lane
//! group at a time. No ray's arithmetic knows where in the batch it stands: chunks and threads change no bit.

#[cfg(feature = "measure")]
pub(crate) mod stages;

use crate::Strategy;
use crate::batch::{Column, Counts, Inputs, OfSamples, Outputs, Padded, Samples, Turn};
use crate::density::Density;
use crate::geometry::Geometry;
use crate::integrand::{MediumLanes, integrand_r2};
use crate::simd::{Backend, Isa, Kernel, Lanes, MOST_LANES, none};
use crate::strategy::Taylor;
use crate::strategy::equi_angular::EquiAngular;
use crate::strategy::point_normal::PointNormal;
use crate::strategy::product::Product;
use crate::strategy::taylor_phase::OfPhase;
use crate::strategy::taylor_transmittance::OfTransmittance;
use crate::strategy::transmittance::Transmittance;

/// Values per chunk: up to 22 columns of this many are 352 KiB, which stay in a core's cache.
const CHUNK: usize = 4096;

/// Where a task writes to.
pub(crate) type Out<'a, T> = <<T as Task>::Out as Outputs>::At<'a>;

/// What a call does with every ray.
pub(crate) trait Task {
    /// The columns that it writes.
    type Out: Outputs;

    /// How many values it writes for each ray.
    fn values_per_ray(inputs: &Inputs<'_>) -> usize {
        inputs.per_ray
    }

    /// Takes one chunk the whole way.
    fn run<I: Isa>(isa: I, strategy: Strategy, inputs: &Inputs<'_>, out: Out<'_, Self>) -> Counts;
}

/// A task for which every density has a kernel of its own.
trait OfDensity: Task {
    fn chunk<I: Isa, D: Density<I>>(isa: I, inputs: &Inputs<'_>, out: Out<'_, Self>) -> Counts;
}

/// Chooses the kernel.
#[inline(always)]
fn by_strategy<I: Isa, T: OfDensity>(isa: I, strategy: Strategy, inputs: &Inputs<'_>, out: Out<'_, T>) -> Counts {
    match strategy {
        Strategy::Transmittance => T::chunk::<I, Transmittance<I>>(isa, inputs, out),
        Strategy::EquiAngular => T::chunk::<I, EquiAngular<I>>(isa, inputs, out),
        Strategy::PointNormal => T::chunk::<I, PointNormal<I>>(isa, inputs, out),
        Strategy::TaylorTransmittance => T::chunk::<I, Taylor<I, OfTransmittance>>(isa, inputs, out),
        Strategy::TaylorPhase => T::chunk::<I, Taylor<I, OfPhase>>(isa, inputs, out),
        Strategy::Product3 => T::chunk::<I, Product<I, 3>>(isa, inputs, out),
        Strategy::Product5 => T::chunk::<I, Product<I, 5>>(isa, inputs, out),
        Strategy::Product9 => T::chunk::<I, Product<I, 9>>(isa, inputs, out),
        Strategy::Product17 => T::chunk::<I, Product<I, 17>>(isa, inputs, out),
    }
}

/// Takes a batch the whole way, its chunks spread over the threads.
pub(crate) fn travel<T: Task>(backend: Backend, strategy: Strategy, inputs: &Inputs<'_>, out: Out<'_, T>) -> Counts {
    // Whole lane groups, however many values a ray has.
    let chunk = (CHUNK / inputs.per_ray.max(1)).next_multiple_of(MOST_LANES).max(MOST_LANES);
    if inputs.len() <= chunk {
        return whole_groups::<T>(backend, strategy, inputs, out);
    }
    // Halves of whole chunks, so that a chunk is cut short at the end of the batch alone.
    let half = inputs.len().div_ceil(chunk).div_ceil(2) * chunk;
    let (out_low, out_high) = T::Out::split_at(out, half * T::values_per_ray(inputs));
    let low = || travel::<T>(backend, strategy, &inputs.slice(0..half), out_low);
    let high = || travel::<T>(backend, strategy, &inputs.slice(half..inputs.len()), out_high);
    #[cfg(feature = "rayon")]
    let (low, high) = rayon::join(low, high);
    #[cfg(not(feature = "rayon"))]
    let (low, high) = (low(), high());
    low + high
}

/// Takes a chunk the whole way. Kernels only know whole lane groups: the rays at the end that are too few go one value a
/// lane.
fn whole_groups<T: Task>(backend: Backend, strategy: Strategy, inputs: &Inputs<'_>, out: Out<'_, T>) -> Counts {
    let whole = inputs.len() / MOST_LANES * MOST_LANES;
    let (out_whole, mut out) = T::Out::split_at(out, whole * T::values_per_ray(inputs));
    let mut counts = Counts::default();
    if whole > 0 {
        counts = backend.run(Chunk::<T> { strategy, inputs: &inputs.slice(0..whole), out: out_whole });
    }
    let few = inputs.slice(whole..inputs.len());
    let values = few.len() * T::values_per_ray(&few);
    for start in (0..values).step_by(MOST_LANES) {
        let end = values.min(start + MOST_LANES);
        let (out_here, out_rest) = T::Out::split_at(out, end - start);
        out = out_rest;
        let mut padded = Padded::new();
        let inputs = &padded.fill(&few, start..end);
        counts = counts + T::Out::by_pads(out_here, |out| backend.run(Chunk::<T> { strategy, inputs, out }));
        // What fills up is invalid.
        counts.invalid -= MOST_LANES - (end - start);
    }
    counts
}

/// One chunk on its way to its kernel.
struct Chunk<'i, 'o, T: Task> {
    strategy: Strategy,
    inputs: &'i Inputs<'i>,
    out: Out<'o, T>,
}

impl<T: Task> Kernel for Chunk<'_, '_, T> {
    type Output = Counts;

    #[inline(always)]
    fn run<I: Isa>(self, isa: I) -> Counts {
        T::run(isa, self.strategy, self.inputs, self.out)
    }
}

/// A lane group before its density is chosen.
struct Group<I: Isa> {
    geometry: Geometry<I>,
    medium: MediumLanes<I>,
    /// Which one of the chunk it is.
    index: usize,
}

impl<I: Isa> Group<I> {
    /// Which lanes are rays with a medium.
    #[inline(always)]
    fn valid(&self) -> I::Mask {
        self.geometry.valid & self.medium.valid
    }
}

/// What became of the values: summed in the lanes, and settled over all of them now and then.
struct Tally<I: Isa> {
    valid: I::V,
    sampled: I::V,
    bisected: I::V,
    /// How many values there were.
    values: usize,
    settled: Counts,
}

impl<I: Isa> Tally<I> {
    #[inline(always)]
    fn new(isa: I) -> Self {
        let zero = isa.splat(0.0);
        Self { valid: zero, sampled: zero, bisected: zero, values: 0, settled: Counts::default() }
    }

    /// One more value for each lane: `valid` with what was given, `lit` for the density, and `bisected`.
    #[inline(always)]
    fn add(&mut self, isa: I, valid: I::Mask, lit: I::Mask, bisected: I::Mask) {
        let (one, zero) = (isa.splat(1.0), isa.splat(0.0));
        let sampled = valid & lit;
        self.valid = self.valid + I::V::select(valid, one, zero);
        self.sampled = self.sampled + I::V::select(sampled, one, zero);
        self.bisected = self.bisected + I::V::select(bisected & sampled, one, zero);
        self.values += I::V::N;
    }

    /// Keeps the sums small enough to be exact.
    #[inline(always)]
    fn settle(&mut self, isa: I) {
        let [valid, sampled, bisected] =
            [sum_of_lanes(isa, self.valid), sum_of_lanes(isa, self.sampled), sum_of_lanes(isa, self.bisected)];
        let settled = self.settled + Counts { sampled, empty: valid - sampled, invalid: 0, bisected };
        *self = Self { settled, values: self.values, ..Self::new(isa) };
    }

    #[inline(always)]
    fn counts(mut self, isa: I) -> Counts {
        self.settle(isa);
        let Counts { sampled, empty, bisected, .. } = self.settled;
        Counts { sampled, empty, invalid: self.values - sampled - empty, bisected }
    }
}

/// The sum of whole numbers.
#[inline(always)]
fn sum_of_lanes<I: Isa>(isa: I, lanes: I::V) -> usize {
    let mut values = [0.0; MOST_LANES];
    isa.store(lanes, &mut I::groups_mut(&mut values)[0]);
    let mut sum = 0;
    for value in values {
        sum += value as usize;
    }
    sum
}

/// The lane groups of a chunk, each visited once.
#[inline(always)]
fn for_each_group<I: Isa>(isa: I, inputs: &Inputs<'_>, mut visit: impl FnMut(Group<I>, &mut Tally<I>)) -> Counts {
    let mut tally = Tally::new(isa);
    let rays = inputs.ray_groups::<I>();
    let (mut emitter, mut medium) = (inputs.emitters.lanes(isa, 0), inputs.media.lanes(isa, 0));
    for index in 0..rays.count() {
        if index > 0 {
            inputs.emitters.renew(isa, index, &mut emitter);
            inputs.media.renew(isa, index, &mut medium);
        }
        let geometry = Geometry::new(isa, &rays.lanes(isa, index), &emitter);
        visit(Group { geometry, medium, index }, &mut tally);
    }
    tally.counts(isa)
}

/// What is given for a lane group, turn by turn.
#[inline(always)]
fn for_each_turn<I: Isa>(
    isa: I,
    inputs: &Inputs<'_>,
    group: usize,
    tally: &mut Tally<I>,
    mut visit: impl FnMut(Turn, I::V, &mut Tally<I>),
) {
    for index in 0..inputs.per_ray {
        if index > 0 && index % TURNS_TO_SETTLE == 0 {
            tally.settle(isa);
        }
        let turn = Turn { group, index, per_ray: inputs.per_ray };
        visit(turn, turn.load(isa, inputs.given), tally);
    }
}
/// Between two settlings a lane has one run of so many turns, and less than another one before it, or at most a chunk of
/// rays with fewer: all are whole numbers that f32 can count.
const TURNS_TO_SETTLE: usize = 1 << 16;
const _: () = assert!(TURNS_TO_SETTLE * (MOST_LANES + 1) < 1 << f32::MANTISSA_DIGITS);

/// Draws a distance for every variate that is given.
pub(crate) struct Sample;

impl Task for Sample {
    type Out = OfSamples;

    #[inline(always)]
    fn run<I: Isa>(isa: I, strategy: Strategy, inputs: &Inputs<'_>, out: Samples<'_>) -> Counts {
        by_strategy::<I, Self>(isa, strategy, inputs, out)
    }
}

impl OfDensity for Sample {
    #[inline(always)]
    fn chunk<I: Isa, D: Density<I>>(isa: I, inputs: &Inputs<'_>, out: Samples<'_>) -> Counts {
        // Apart, as what weights are made of would be computed, and kept in memory, where nobody asks for them.
        if out.weight.is_some() || out.r.is_some() {
            sample::<I, D, true>(isa, inputs, out)
        } else {
            sample::<I, D, false>(isa, inputs, out)
        }
    }
}

#[inline(always)]
fn sample<I: Isa, D: Density<I>, const WITH_WEIGHT_OR_R: bool>(
    isa: I,
    inputs: &Inputs<'_>,
    mut out: Samples<'_>,
) -> Counts {
    let zero = isa.splat(0.0);
    for_each_group(
        isa,
        inputs,
        #[inline(always)]
        |group, tally| {
            let Group { geometry, medium, index } = &group;
            let density = D::new(isa, geometry, medium);
            let lit = D::lit(isa, geometry);
            for_each_turn(
                isa,
                inputs,
                *index,
                tally,
                #[inline(always)]
                |turn, u, tally| {
                    let valid = group.valid() & zero.le(u) & u.le(isa.splat(1.0));
                    let sampled = valid & lit;
                    let drawn = density.invert(isa, geometry, u);
                    turn.store(isa, I::V::select(sampled, drawn.point.t, zero), out.t);
                    turn.store(isa, I::V::select(sampled, drawn.pdf.over_t, zero), out.pdf);
                    if WITH_WEIGHT_OR_R && let Some(weight) = &mut out.weight {
                        let value = integrand_r2(isa, geometry, medium, &drawn.point) / drawn.pdf.times_r2;
                        let possible = sampled & zero.lt(drawn.pdf.times_r2);
                        turn.store(isa, I::V::select(possible, value.min(isa.splat(f32::MAX)), zero), weight);
                    }
                    if WITH_WEIGHT_OR_R && let Some(r) = &mut out.r {
                        turn.store(isa, I::V::select(sampled, drawn.point.r, zero), r);
                    }
                    tally.add(isa, valid, lit, drawn.bisected);
                },
            );
        },
    )
}

/// The density at given distances.
pub(crate) struct Pdf;

impl Task for Pdf {
    type Out = Column;

    #[inline(always)]
    fn run<I: Isa>(isa: I, strategy: Strategy, inputs: &Inputs<'_>, out: &mut [f32]) -> Counts {
        by_strategy::<I, Self>(isa, strategy, inputs, out)
    }
}

impl OfDensity for Pdf {
    #[inline(always)]
    fn chunk<I: Isa, D: Density<I>>(isa: I, inputs: &Inputs<'_>, out: &mut [f32]) -> Counts {
        let zero = isa.splat(0.0);
        for_each_group(
            isa,
            inputs,
            #[inline(always)]
            |group, tally| {
                let Group { geometry, medium, index } = &group;
                let density = D::new(isa, geometry, medium);
                let (lit, [low, high]) = (D::lit(isa, geometry), D::support(geometry));
                for_each_turn(
                    isa,
                    inputs,
                    *index,
                    tally,
                    #[inline(always)]
                    |turn, t, tally| {
                        let valid = group.valid() & t.eq(t);
                        let inside = valid & lit & low.le(t) & t.le(high);
                        let pdf = density.pdf(isa, geometry, &geometry.point_at_distance(isa, t));
                        turn.store(isa, I::V::select(inside, pdf.over_t, zero), out);
                        tally.add(isa, valid, lit, none(isa));
                    },
                );
            },
        )
    }
}

/// The integrand at given distances, whatever the density.
pub(crate) struct Evaluate;

impl Task for Evaluate {
    type Out = Column;

    #[inline(always)]
    fn run<I: Isa>(isa: I, _: Strategy, inputs: &Inputs<'_>, out: &mut [f32]) -> Counts {
        let zero = isa.splat(0.0);
        for_each_group(
            isa,
            inputs,
            #[inline(always)]
            |group, tally| {
                let Group { geometry, medium, index } = &group;
                for_each_turn(
                    isa,
                    inputs,
                    *index,
                    tally,
                    #[inline(always)]
                    |turn, t, tally| {
                        let valid = group.valid() & t.eq(t);
                        let inside = valid & geometry.faced & geometry.t_min.le(t) & t.le(geometry.t_max);
                        let point = geometry.point_at_distance(isa, t);
                        let f = integrand_r2(isa, geometry, medium, &point) / (point.r * point.r);
                        turn.store(isa, I::V::select(inside, f.min(isa.splat(f32::MAX)), zero), out);
                        tally.add(isa, valid, geometry.faced, none(isa));
                    },
                );
            },
        )
    }
}

/// What the density's own normalisation says of the integral; 0 for a density that has none.
pub(crate) struct Radiance;

impl Task for Radiance {
    type Out = Column;

    fn values_per_ray(_: &Inputs<'_>) -> usize {
        1
    }

    #[inline(always)]
    fn run<I: Isa>(isa: I, strategy: Strategy, inputs: &Inputs<'_>, out: &mut [f32]) -> Counts {
        match strategy {
            Strategy::Product3 => radiance::<I, 3>(isa, inputs, out),
            Strategy::Product5 => radiance::<I, 5>(isa, inputs, out),
            Strategy::Product9 => radiance::<I, 9>(isa, inputs, out),
            Strategy::Product17 => radiance::<I, 17>(isa, inputs, out),
            _ => Counts::default(),
        }
    }
}

#[inline(always)]
fn radiance<I: Isa, const K: usize>(isa: I, inputs: &Inputs<'_>, out: &mut [f32]) -> Counts {
    let zero = isa.splat(0.0);
    for_each_group(
        isa,
        inputs,
        #[inline(always)]
        |group, tally| {
            let Group { geometry, medium, index } = &group;
            let lit = Product::<I, K>::lit(isa, geometry);
            let sampled = group.valid() & lit;
            let radiance = Product::<I, K>::new(isa, geometry, medium).radiance(isa, geometry, medium);
            let value = I::V::select(sampled, radiance.min(isa.splat(f32::MAX)), zero);
            Turn { group: *index, index: 0, per_ray: 1 }.store(isa, value, out);
            tally.add(isa, group.valid(), lit, none(isa));
        },
    )
}
