//! Samples a distance for every variate.

use super::blocks::{Block, ForSetUp, SetUps, Wanted, for_each_block, for_each_run, set_up};
use super::tally::Tally;
use super::{AHEAD, Method, OfDensity, Out, Task, by_strategy};
use crate::Precision;
use crate::batch::{Counts, Inputs, OfRuns, OfSamples, Samples, Turn};
use crate::density::{Density, Kind, SetUp};
use crate::geometry::{Extent, Geometry, Point};
use crate::integrand::{Factors, MediumLanes};
use crate::simd::{GROUPS, Isa, Lanes, Machine, Records, Room};

pub(crate) struct Sample;

impl Task for Sample {
    type Method = Method;
    type Out = OfSamples;

    fn run(machine: impl Machine, method: Method, inputs: &Inputs<'_>, out: Samples<'_>) -> Counts {
        // Two kernels: only the one with weights or `r` keeps points.
        if out.weights.iter().any(Option::is_some) || out.r.is_some() {
            by_strategy::<Drawing<true>>(machine, method, inputs, out)
        } else {
            by_strategy::<Drawing<false>>(machine, method, inputs, out)
        }
    }
}

/// The same, with or without weights and `r`.
struct Drawing<const WITH_WEIGHT_OR_R: bool>;

impl<const WITH_WEIGHT_OR_R: bool> Task for Drawing<WITH_WEIGHT_OR_R> {
    type Method = Method;
    type Out = OfSamples;

    fn run(machine: impl Machine, method: Method, inputs: &Inputs<'_>, out: Samples<'_>) -> Counts {
        by_strategy::<Self>(machine, method, inputs, out)
    }
}

impl<const WITH_WEIGHT_OR_R: bool> OfDensity for Drawing<WITH_WEIGHT_OR_R> {
    fn groups<I: Isa, D: Kind>(isa: I, precision: Precision, inputs: &Inputs<'_>, mut out: Out<'_, Self>) -> Counts {
        let mut tally = Tally::new::<I>(inputs);
        // Apart: an unoptimised build has a tuple of them on the stack twice.
        let mut set_ups = SetUps::<I, D>::new();
        let mut places = Records::new();
        let mut points = Records::new();
        let mut pad = None;
        // Set-ups that do not fit the nearest cache, and are used once.
        let once = SetUps::<I, D>::SIZE < GROUPS && inputs.per_ray == 1;
        let wanted = Wanted {
            precision,
            extent: if WITH_WEIGHT_OR_R { Extent::Path } else { D::On::<I>::EXTENT },
            records: if once { GROUPS } else { SetUps::<I, D>::SIZE },
        };
        for_each_block(isa, inputs, wanted, |block| {
            // The constant stands here too: without it the compiler would build the pass for every density.
            if SetUps::<I, D>::SIZE < GROUPS && once {
                let run = block.one_turn();
                let u = run.values(inputs.given, &mut pad);
                return OfSamples::of_run(&mut out, run, |mut out| {
                    let points = at_once::<I, D, WITH_WEIGHT_OR_R>(isa, block, u, &mut points, &mut out, &mut tally);
                    if WITH_WEIGHT_OR_R {
                        weigh(isa, block, run.turns, points, &mut out);
                    }
                });
            }
            let set_ups = set_up::<I, D, D::On<I>>(isa, block, &mut set_ups);
            for_each_run(block, |run| {
                let u = run.values(inputs.given, &mut pad);
                let places = draw::<I, D>(isa, block, set_ups, run.turns, u, &mut places);
                OfSamples::of_run(&mut out, run, |mut out| {
                    let pass = Points::<I, D> { block, set_ups, turns: run.turns, places };
                    let points = pass.write::<WITH_WEIGHT_OR_R>(isa, &mut points, &mut out, &mut tally);
                    if WITH_WEIGHT_OR_R {
                        weigh(isa, block, run.turns, points, &mut out);
                    }
                });
            });
        });
        tally.counts::<I>(inputs)
    }
}

/// Set-up, inversion and output in one pass, for one variate per ray; writes `t` and `pdf`, and keeps the points for weights and
/// `r`.
fn at_once<'r, I: Isa, D: Kind, const KEEP: bool>(
    isa: I,
    block: &Block<'_, I>,
    u: &[f32],
    points: &'r mut Records<Sampled<I>>,
    out: &mut Samples<'_>,
    tally: &mut Tally,
) -> &'r [Sampled<I>] {
    isa.vectorize::<D, _>(
        #[cfg_attr(optimized, inline(always))]
        || {
            let (mut for_set_up, geometries) = (ForSetUp::new(isa, block), block.geometries());
            let (mut kept, mut counted) = (points.start(), *tally);
            let columns = I::groups(u).iter().zip(I::groups_mut(out.t)).zip(I::groups_mut(out.pdf));
            for (record, ((u, t), pdf)) in (0..block.groups.len()).zip(columns) {
                if block.inputs.prefetch {
                    isa.prefetch(u, AHEAD);
                    isa.prefetch(t, AHEAD);
                    isa.prefetch(pdf, AHEAD);
                }
                let (geometry, set_up) =
                    (geometries.get(record), for_set_up.set_up::<D::On<I>>(isa, block.precision, record));
                let placed = Placed::new(isa, geometry, &set_up, u);
                let sampled = point_one::<I, D>(isa, geometry, &set_up, &placed, t, pdf, &mut counted);
                if KEEP {
                    kept.push(sampled);
                }
            }
            *tally = counted;
            kept.done();
        },
    );
    points.written()
}

/// The place of a variate.
#[derive(Clone, Copy)]
pub(super) struct Placed<I: Isa, P> {
    place: P,
    /// Which lanes have a valid ray, medium and variate.
    valid: I::Mask,
}

impl<I: Isa, P> Placed<I, P> {
    #[cfg_attr(optimized, inline(always))]
    fn new<D: Density<I, Place = P>>(isa: I, geometry: Geometry<'_, I>, set_up: &SetUp<I, D>, u: &I::Group) -> Self {
        let u = isa.load(u);
        let place = set_up.density.draw(isa, geometry, u);
        Self { place, valid: set_up.valid & isa.splat(0.0).le(u) & u.le(isa.splat(1.0)) }
    }
}

/// The same for the density `D`.
pub(super) type PlacedBy<I, D> = Placed<I, <<D as Kind>::On<I> as Density<I>>::Place>;

/// Applies the inverse of the CDF to the variates of some turns.
pub(super) fn draw<'r, I: Isa, D: Kind>(
    isa: I,
    block: &Block<'_, I>,
    set_ups: &[SetUp<I, D::On<I>>],
    turns: &[Turn],
    u: &[f32],
    records: &'r mut Records<PlacedBy<I, D>>,
) -> &'r [PlacedBy<I, D>] {
    isa.vectorize::<D, _>(
        #[cfg_attr(optimized, inline(always))]
        || {
            let (u, geometries) = (&I::groups(u)[..turns.len()], block.geometries());
            let set_ups = &set_ups[..block.groups.len()];
            records.fill(
                turns.len(),
                #[cfg_attr(optimized, inline(always))]
                |index| {
                    let record = turns[index].record;
                    if block.inputs.prefetch {
                        isa.prefetch(&u[index], AHEAD);
                    }
                    Placed::new(isa, geometries.get(record), &set_ups[record], &u[index])
                },
            )
        },
    )
}

/// A sampled point, and the lanes that have one.
#[derive(Clone, Copy)]
struct Sampled<I: Isa> {
    point: Point<I>,
    /// The pdf times `r^2` \[m\].
    times_r2: I::V,
    sampled: I::Mask,
}

/// The pass from places to points of the ray, `t` and `pdf`.
struct Points<'p, I: Isa, D: Kind> {
    block: &'p Block<'p, I>,
    set_ups: &'p [SetUp<I, D::On<I>>],
    turns: &'p [Turn],
    places: &'p [PlacedBy<I, D>],
}

impl<I: Isa, D: Kind> Points<'_, I, D> {
    /// Writes `t` and `pdf`; keeps the points for weights and `r`.
    fn write<'r, const KEEP: bool>(
        &self,
        isa: I,
        points: &'r mut Records<Sampled<I>>,
        out: &mut Samples<'_>,
        tally: &mut Tally,
    ) -> &'r [Sampled<I>] {
        isa.vectorize::<D, _>(
            #[cfg_attr(optimized, inline(always))]
            || {
                let ((t, pdf), geometries) = (self.groups(out), self.block.geometries());
                let (places, set_ups) = (&self.places[..t.len()], &self.set_ups[..self.block.groups.len()]);
                let mut kept = points.start();
                // A copy, which stays in registers.
                let mut counted = *tally;
                for (((turn, place), t), pdf) in self.turns.iter().zip(places).zip(t).zip(pdf) {
                    if self.block.inputs.prefetch {
                        isa.prefetch(t, AHEAD);
                        isa.prefetch(pdf, AHEAD);
                    }
                    let (geometry, set_up) = (geometries.get(turn.record), &set_ups[turn.record]);
                    let sampled = point_one::<I, D>(isa, geometry, set_up, place, t, pdf, &mut counted);
                    if KEEP {
                        kept.push(sampled);
                    }
                }
                *tally = counted;
                kept.done();
            },
        );
        points.written()
    }

    /// `t` and `pdf` of the turns.
    #[cfg_attr(optimized, inline(always))]
    fn groups<'o>(&self, out: &'o mut Samples<'_>) -> (&'o mut [I::Group], &'o mut [I::Group]) {
        let count = self.turns.len();
        (&mut I::groups_mut(out.t)[..count], &mut I::groups_mut(out.pdf)[..count])
    }
}

#[cfg_attr(optimized, inline(always))]
fn point_one<I: Isa, D: Kind>(
    isa: I,
    geometry: Geometry<'_, I>,
    set_up: &SetUp<I, D::On<I>>,
    placed: &PlacedBy<I, D>,
    t: &mut I::Group,
    pdf: &mut I::Group,
    tally: &mut Tally,
) -> Sampled<I> {
    let (SetUp { density, lit, .. }, Placed { place, valid }) = (set_up, placed);
    let sampled = *valid & *lit;
    let drawn = density.point(isa, geometry, place);
    isa.store(I::V::only(sampled, drawn.point.t), t);
    isa.store(I::V::only(sampled, drawn.pdf.over_t), pdf);
    tally.add::<I>(*valid, sampled, drawn.bisected);
    Sampled { point: drawn.point, times_r2: drawn.pdf.times_r2, sampled }
}

/// Writes the weights of the points (1.9), and their distances to the emitter.
fn weigh<I: Isa>(isa: I, block: &Block<'_, I>, turns: &[Turn], points: &[Sampled<I>], out: &mut Samples<'_>) {
    if block.precision.is_exact::<I>() {
        weigh_in::<I, true>(isa, block, turns, points, out);
    } else {
        weigh_in::<I, false>(isa, block, turns, points, out);
    }
}

fn weigh_in<I: Isa, const EXACT: bool>(
    isa: I,
    block: &Block<'_, I>,
    turns: &[Turn],
    points: &[Sampled<I>],
    out: &mut Samples<'_>,
) {
    isa.vectorize::<MediumLanes<I>, _>(
        #[cfg_attr(optimized, inline(always))]
        || {
            if let Some(r) = &mut out.r {
                for (Sampled { point, sampled, .. }, r) in points.iter().zip(I::groups_mut(r)) {
                    isa.store(I::V::only(*sampled, point.r), r);
                }
            }
            let (rays, geometries) = (block.inputs.ray_groups::<I>(), block.geometries());
            let columns = out.weights.iter().flatten().count();
            for (column, weight) in out.weights.iter_mut().flatten().enumerate() {
                let media = block.media.of_output(column, columns).groups(isa);
                let mut medium = media.media(isa, 0);
                let pdfs = I::groups(out.pdf);
                for (((turn, Sampled { point, times_r2, sampled }), pdf), weight) in
                    turns.iter().zip(points).zip(pdfs).zip(I::groups_mut(weight))
                {
                    let group = block.groups.start + turn.record;
                    media.renew(isa, turn.record, &mut medium);
                    let (ray, geometry) = (rays.lanes(isa, group), geometries.get(turn.record));
                    let factors = Factors::new::<EXACT>(isa, &ray, geometry, &medium, point);
                    let (value, imprecise) = factors.over(isa, *times_r2);
                    let mut value = I::V::only(isa.splat(0.0).lt(*times_r2), value);
                    let hard = imprecise & *sampled;
                    if EXACT && I::V::bits(hard) != 0 {
                        let pdf = isa.load(pdf);
                        let [inv_r, inv_pdf] = [point.r, pdf].map(|x| isa.splat(1.0) / x);
                        let has_inverse = isa.splat(f32::MIN_POSITIVE).le(pdf);
                        value = I::V::select(hard & has_inverse, factors.in_f64(inv_r, inv_pdf), value);
                    }
                    isa.store(I::V::only(*sampled, value.min(isa.splat(f32::MAX))), weight);
                }
            }
        },
    );
}
