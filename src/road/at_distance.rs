//! The pdf or the CDF of a density at given distances.

use super::blocks::{Block, SetUps, Wanted, for_each_block, for_each_run, set_up};
use super::tally::Tally;
use super::{Method, OfDensity, Task, by_strategy};
use crate::Precision;
use crate::batch::{Column, Counts, Inputs, OfRuns, Turn};
use crate::density::{Density, Kind, SetUp};
use crate::geometry::{Geometry, Point};
use crate::simd::{Isa, Lanes, Machine, Room, none};

/// A quantity of a density at a distance.
pub(crate) trait Question {
    fn answer<I: Isa, D: Density<I>>(isa: I, density: &D, geometry: Geometry<'_, I>, point: &Point<I>) -> I::V;
}

/// The density.
pub(crate) struct Pdf;

impl Question for Pdf {
    #[cfg_attr(optimized, inline(always))]
    fn answer<I: Isa, D: Density<I>>(isa: I, density: &D, geometry: Geometry<'_, I>, point: &Point<I>) -> I::V {
        let [low, high] = density.support(geometry);
        let inside = low.le(point.t) & point.t.le(high);
        I::V::only(inside, density.pdf(isa, geometry, point).over_t)
    }
}

/// The distribution function.
pub(crate) struct Cdf;

impl Question for Cdf {
    #[cfg_attr(optimized, inline(always))]
    fn answer<I: Isa, D: Density<I>>(isa: I, density: &D, geometry: Geometry<'_, I>, point: &Point<I>) -> I::V {
        let [before, beyond] = density.outside(isa, geometry, point.t);
        let cdf = density.cdf(isa, geometry, point).max(isa.splat(0.0)).min(isa.splat(1.0));
        I::V::only(!before, I::V::select(beyond, isa.splat(1.0), cdf))
    }
}

impl<Q: Question> Task for Q {
    type Method = Method;
    type Out = Column;

    fn run(machine: impl Machine, method: Method, inputs: &Inputs<'_>, out: &mut [f32]) -> Counts {
        by_strategy::<Self>(machine, method, inputs, out)
    }
}

impl<Q: Question> OfDensity for Q {
    fn groups<I: Isa, D: Kind>(isa: I, precision: Precision, inputs: &Inputs<'_>, mut out: &mut [f32]) -> Counts {
        let mut tally = Tally::new::<I>(inputs);
        let (mut set_ups, mut pad) = (SetUps::<I, D>::new(), None);
        let wanted = Wanted { precision, extent: D::On::<I>::EXTENT_AT_DISTANCE, records: SetUps::<I, D>::SIZE };
        for_each_block(isa, inputs, wanted, |block| {
            let set_ups = set_up::<I, D, D::On<I>>(isa, block, &mut set_ups);
            for_each_run(block, |run| {
                let t = run.values(inputs.given, &mut pad);
                Column::of_run(&mut out, run, |out| {
                    answers::<I, D, Q>(isa, block, set_ups, run.turns, t, out, &mut tally);
                });
            });
        });
        tally.counts::<I>(inputs)
    }
}

/// Computes the quantity for some turns at the distances `t`.
fn answers<I: Isa, D: Kind, Q: Question>(
    isa: I,
    block: &Block<'_, I>,
    set_ups: &[SetUp<I, D::On<I>>],
    turns: &[Turn],
    t: &[f32],
    out: &mut [f32],
    tally: &mut Tally,
) {
    isa.vectorize::<D, _>(
        #[cfg_attr(optimized, inline(always))]
        || {
            let geometries = block.geometries();
            for ((turn, t), out) in turns.iter().zip(I::groups(t)).zip(I::groups_mut(out)) {
                let Turn { record, .. } = *turn;
                let (SetUp { density, valid, lit }, geometry) = (&set_ups[record], geometries.get(record));
                let t = isa.load(t);
                let valid = *valid & t.eq(t);
                let sampled = valid & *lit;
                let answer = Q::answer(isa, density, geometry, &geometry.point_at_distance(isa, t));
                isa.store(I::V::only(sampled, answer), out);
                tally.add::<I>(valid, sampled, none(isa));
            }
        },
    );
}
