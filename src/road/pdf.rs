//! The density at given distances.

use super::groups::{Group, for_each_group, for_each_turn};
use super::{OfDensity, Task, by_strategy};
use crate::Strategy;
use crate::batch::{Column, Counts, Inputs};
use crate::density::{Density, Kind};
use crate::simd::{Isa, Lanes, Machine, none};

pub(crate) struct Pdf;

impl Task for Pdf {
    type Out = Column;

    fn run(machine: impl Machine, strategy: Strategy, inputs: &Inputs<'_>, out: &mut [f32]) -> Counts {
        by_strategy::<Self>(machine, strategy, inputs, out)
    }
}

impl OfDensity for Pdf {
    #[cfg_attr(optimized, inline(always))]
    fn groups<I: Isa, D: Kind>(isa: I, inputs: &Inputs<'_>, out: &mut [f32]) -> Counts {
        let zero = isa.splat(0.0);
        for_each_group(
            isa,
            inputs,
            #[cfg_attr(optimized, inline(always))]
            |group, tally| {
                let Group { geometry, medium, index } = &group;
                let density = D::On::<I>::new(isa, geometry, medium);
                let (lit, [low, high]) = (D::On::<I>::lit(isa, geometry), D::On::<I>::support(geometry));
                for_each_turn(
                    isa,
                    inputs,
                    *index,
                    tally,
                    #[cfg_attr(optimized, inline(always))]
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
