//! The integrand at given distances, whatever the density.

use super::Task;
use super::groups::{Group, for_each_group, for_each_turn};
use crate::Strategy;
use crate::batch::{Column, Counts, Inputs};
use crate::integrand::integrand_r2;
use crate::simd::{Isa, Kernel, Lanes, Machine, none};

pub(crate) struct Evaluate;

impl Task for Evaluate {
    type Out = Column;

    fn run(machine: impl Machine, _: Strategy, inputs: &Inputs<'_>, out: &mut [f32]) -> Counts {
        machine.run(OnGroups { inputs, out })
    }
}

/// Its kernel.
struct OnGroups<'a> {
    inputs: &'a Inputs<'a>,
    out: &'a mut [f32],
}

impl Kernel for OnGroups<'_> {
    type Output = Counts;
    type Home = Evaluate;

    #[cfg_attr(optimized, inline(always))]
    fn run<I: Isa>(self, isa: I) -> Counts {
        let Self { inputs, out } = self;
        let zero = isa.splat(0.0);
        for_each_group(
            isa,
            inputs,
            #[cfg_attr(optimized, inline(always))]
            |group, tally| {
                let Group { geometry, medium, index } = &group;
                for_each_turn(
                    isa,
                    inputs,
                    *index,
                    tally,
                    #[cfg_attr(optimized, inline(always))]
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
