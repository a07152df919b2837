//! The road that every ray takes: columns -> geometry -> density -> inversion -> samples.
//!
//! A batch is cut into chunks that stay in a core's cache; a chunk goes through the kernel of one strategy, a lane
//! group at a time. No ray's arithmetic knows where in the batch it stands: chunks and threads change no bit.

use crate::Strategy;
use crate::batch::{Counts, Inputs, Outputs, Samples};
use crate::density::Density;
use crate::geometry::Geometry;
use crate::integrand::{MediumLanes, integrand_r2};
use crate::simd::{Backend, Isa, Kernel, Lanes};
use crate::strategy::Taylor;
use crate::strategy::equi_angular::EquiAngular;
use crate::strategy::point_normal::PointNormal;
use crate::strategy::taylor_phase::OfPhase;
use crate::strategy::taylor_transmittance::OfTransmittance;
use crate::strategy::transmittance::Transmittance;
use core::ops::Range;

/// Rays per chunk: some 17 columns of this many stay within 256 KiB.
const CHUNK: usize = 4096;

/// What a call does with every ray.
pub(crate) trait Task {
    /// The columns that it writes.
    type Out<'a>: Outputs;

    /// Takes one chunk the whole way, with the density `D`.
    fn chunk<I: Isa, D: Density<I>>(isa: I, inputs: &Inputs<'_>, out: Self::Out<'_>) -> Counts;
}

/// Takes a batch the whole way, its chunks spread over the threads.
pub(crate) fn travel<T: Task>(backend: Backend, strategy: Strategy, inputs: &Inputs<'_>, out: T::Out<'_>) -> Counts {
    if inputs.len() <= CHUNK {
        return backend.run(Chunk::<T> { strategy, inputs, out });
    }
    // Halves of whole chunks, so that a chunk is cut short at the end of the batch alone.
    let half = inputs.len().div_ceil(CHUNK).div_ceil(2) * CHUNK;
    let (out_low, out_high) = out.split_at(half);
    let low = || travel::<T>(backend, strategy, &inputs.slice(0..half), out_low);
    let high = || travel::<T>(backend, strategy, &inputs.slice(half..inputs.len()), out_high);
    #[cfg(feature = "rayon")]
    let (low, high) = rayon::join(low, high);
    #[cfg(not(feature = "rayon"))]
    let (low, high) = (low(), high());
    low + high
}

/// One chunk on its way to the kernel of its strategy.
struct Chunk<'i, 'o, T: Task> {
    strategy: Strategy,
    inputs: &'i Inputs<'i>,
    out: T::Out<'o>,
}

impl<T: Task> Kernel for Chunk<'_, '_, T> {
    type Output = Counts;

    #[inline(always)]
    fn run<I: Isa>(self, isa: I) -> Counts {
        let Self { strategy, inputs, out } = self;
        match strategy {
            Strategy::Transmittance => T::chunk::<I, Transmittance<I>>(isa, inputs, out),
            Strategy::EquiAngular
            | Strategy::Product3
            | Strategy::Product5
            | Strategy::Product9
            | Strategy::Product17 => T::chunk::<I, EquiAngular<I>>(isa, inputs, out),
            Strategy::PointNormal => T::chunk::<I, PointNormal<I>>(isa, inputs, out),
            Strategy::TaylorTransmittance => T::chunk::<I, Taylor<I, OfTransmittance>>(isa, inputs, out),
            Strategy::TaylorPhase => T::chunk::<I, Taylor<I, OfPhase>>(isa, inputs, out),
        }
    }
}

/// A lane group before its density is chosen.
struct Group<I: Isa> {
    geometry: Geometry<I>,
    medium: MediumLanes<I>,
    given: I::V,
    /// Valid rays, whatever `given` is.
    valid: I::Mask,
}

/// Walks the lane groups of a chunk. `visit` returns which lanes are valid and which bisected.
#[inline(always)]
fn for_each_group<I: Isa>(
    isa: I,
    inputs: &Inputs<'_>,
    mut visit: impl FnMut(Group<I>, Range<usize>) -> (I::Mask, I::Mask),
) -> Counts {
    let mut counts = Counts::default();
    let mut start = 0;
    while start < inputs.len() {
        let range = start..inputs.len().min(start + I::V::N);
        let ray = inputs.ray_lanes(isa, range.clone());
        let geometry = Geometry::new(isa, &ray, &inputs.emitters.lanes(isa, range.clone()));
        let medium = inputs.media.lanes(isa, range.clone());
        let given = isa.load_padded(&inputs.given[range.clone()]);
        let valid = geometry.valid & medium.valid;
        let lit = geometry.lit;
        let (valid, bisected) = visit(Group { geometry, medium, given, valid }, range.clone());

        let present = u32::MAX >> (u32::BITS as usize - range.len());
        let count = |mask: I::Mask| (I::V::bits(mask) & present).count_ones() as usize;
        let (valid_count, sampled) = (count(valid), count(valid & lit));
        counts = counts
            + Counts {
                sampled,
                empty: valid_count - sampled,
                invalid: range.len() - valid_count,
                bisected: count(bisected & valid & lit),
            };
        start = range.end;
    }
    counts
}

/// Draws a distance for every ray; `given` are the variates.
pub(crate) struct Sample;

impl Task for Sample {
    type Out<'a> = Samples<'a>;

    #[inline(always)]
    fn chunk<I: Isa, D: Density<I>>(isa: I, inputs: &Inputs<'_>, mut out: Samples<'_>) -> Counts {
        let zero = isa.splat(0.0);
        for_each_group(
            isa,
            inputs,
            #[inline(always)]
            |group, range| {
                let Group { geometry, medium, given: u, valid } = group;
                let valid = valid & zero.le(u) & u.le(isa.splat(1.0));
                let sampled = valid & geometry.lit;
                let drawn = D::new(isa, &geometry, &medium).invert(isa, &geometry, u);
                I::V::select(sampled, drawn.point.t, zero).store_prefix(&mut out.t[range.clone()]);
                I::V::select(sampled, drawn.pdf.over_t, zero).store_prefix(&mut out.pdf[range.clone()]);
                if let Some(weight) = &mut out.weight {
                    let value = integrand_r2(isa, &geometry, &medium, &drawn.point) / drawn.pdf.times_r2;
                    let possible = sampled & zero.lt(drawn.pdf.times_r2);
                    let value = I::V::select(possible, value.min(isa.splat(f32::MAX)), zero);
                    value.store_prefix(&mut weight[range.clone()]);
                }
                if let Some(r) = &mut out.r {
                    I::V::select(sampled, drawn.point.r, zero).store_prefix(&mut r[range]);
                }
                (valid, drawn.bisected)
            },
        )
    }
}

/// The density at given distances.
pub(crate) struct Pdf;

impl Task for Pdf {
    type Out<'a> = &'a mut [f32];

    #[inline(always)]
    fn chunk<I: Isa, D: Density<I>>(isa: I, inputs: &Inputs<'_>, out: &mut [f32]) -> Counts {
        let zero = isa.splat(0.0);
        for_each_group(
            isa,
            inputs,
            #[inline(always)]
            |group, range| {
                let Group { geometry, medium, given: t, valid } = group;
                let valid = valid & t.eq(t);
                let [low, high] = D::support(&geometry);
                let inside = valid & geometry.lit & low.le(t) & t.le(high);
                let pdf = D::new(isa, &geometry, &medium).pdf(isa, &geometry, &geometry.point_at_distance(isa, t));
                I::V::select(inside, pdf.over_t, zero).store_prefix(&mut out[range]);
                (valid, !(valid | !valid))
            },
        )
    }
}

/// The integrand at given distances, whatever the density.
pub(crate) struct Evaluate;

impl Task for Evaluate {
    type Out<'a> = &'a mut [f32];

    #[inline(always)]
    fn chunk<I: Isa, D: Density<I>>(isa: I, inputs: &Inputs<'_>, out: &mut [f32]) -> Counts {
        let zero = isa.splat(0.0);
        for_each_group(
            isa,
            inputs,
            #[inline(always)]
            |group, range| {
                let Group { geometry, medium, given: t, valid } = group;
                let valid = valid & t.eq(t);
                let inside = valid & geometry.lit & geometry.t_min.le(t) & t.le(geometry.t_max);
                let point = geometry.point_at_distance(isa, t);
                let f = integrand_r2(isa, &geometry, &medium, &point) / (point.r * point.r);
                I::V::select(inside, f.min(isa.splat(f32::MAX)), zero).store_prefix(&mut out[range]);
                (valid, !(valid | !valid))
            },
        )
    }
}
