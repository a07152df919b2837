//! The density at given distances.

use super::blocks::{Block, SetUps, Tally, Wanted, for_each_block, for_each_run, set_up};
use super::{Method, OfDensity, Task, by_strategy};
use crate::Precision;
use crate::batch::{Column, Counts, Inputs, Outputs, Turn};
use crate::density::{Density, Kind, SetUp};
use crate::simd::{Isa, Lanes, Machine, Room, none};

pub(crate) struct Pdf;

impl Task for Pdf {
    type Method = Method;
    type Out = Column;

    fn run(machine: impl Machine, method: Method, inputs: &Inputs<'_>, out: &mut [f32]) -> Counts {
        by_strategy::<Self>(machine, method, inputs, out)
    }
}

impl OfDensity for Pdf {
    fn groups<I: Isa, D: Kind>(isa: I, precision: Precision, inputs: &Inputs<'_>, mut out: &mut [f32]) -> Counts {
        let mut tally = Tally::new(isa, inputs);
        let (mut set_ups, mut pad) = (SetUps::<I, D>::new(), None);
        let wanted = Wanted { precision, cosine: D::On::<I>::COSINE, records: SetUps::<I, D>::SIZE };
        for_each_block(isa, inputs, wanted, |block| {
            let set_ups = set_up::<I, D, D::On<I>>(isa, block, &mut set_ups);
            for_each_run(block, |run| {
                let t = run.values(inputs.given, &mut pad);
                Column::of_run(&mut out, run, |out| pdfs::<I, D>(isa, block, set_ups, run.turns, t, out, &mut tally));
            });
        });
        tally.counts(isa, inputs)
    }
}

/// The densities of some turns at the distances `t`.
fn pdfs<I: Isa, D: Kind>(
    isa: I,
    block: &Block<'_, I>,
    set_ups: &[SetUp<I, D::On<I>>],
    turns: &[Turn],
    t: &[f32],
    out: &mut [f32],
    tally: &mut Tally<I>,
) {
    isa.vectorize::<D, _>(
        #[cfg_attr(optimized, inline(always))]
        || {
            let geometries = block.geometries();
            for ((turn, t), out) in turns.iter().zip(I::groups(t)).zip(I::groups_mut(out)) {
                let Turn { record, .. } = *turn;
                let (SetUp { density, valid, lit }, geometry) = (&set_ups[record], geometries.get(record));
                let t = isa.load(t);
                let [low, high] = density.support(geometry);
                let valid = *valid & t.eq(t);
                let inside = valid & *lit & low.le(t) & t.le(high);
                let pdf = density.pdf(isa, geometry, &geometry.point_at_distance(isa, t));
                isa.store(I::V::only(inside, pdf.over_t), out);
                tally.add(valid, valid & *lit, none(isa));
            }
        },
    );
}
