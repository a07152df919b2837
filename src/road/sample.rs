//! Draws a distance for every variate that is given.

use super::groups::{Group, for_each_group, for_each_turn};
use super::{OfDensity, Out, Task, by_strategy};
use crate::Strategy;
use crate::batch::{Counts, Inputs, OfSamples, Samples};
use crate::density::{Density, Kind};
use crate::integrand::integrand_r2;
use crate::simd::{Isa, Lanes, Machine};

pub(crate) struct Sample;

impl Task for Sample {
    type Out = OfSamples;

    fn run(machine: impl Machine, strategy: Strategy, inputs: &Inputs<'_>, out: Samples<'_>) -> Counts {
        // Apart, as what weights are made of would be computed, and kept in memory, where nobody asks for them.
        if out.weight.is_some() || out.r.is_some() {
            by_strategy::<Drawing<true>>(machine, strategy, inputs, out)
        } else {
            by_strategy::<Drawing<false>>(machine, strategy, inputs, out)
        }
    }
}

/// The same, with or without weights and `r`.
struct Drawing<const WITH_WEIGHT_OR_R: bool>;

impl<const WITH_WEIGHT_OR_R: bool> Task for Drawing<WITH_WEIGHT_OR_R> {
    type Out = OfSamples;

    fn run(machine: impl Machine, strategy: Strategy, inputs: &Inputs<'_>, out: Samples<'_>) -> Counts {
        by_strategy::<Self>(machine, strategy, inputs, out)
    }
}

impl<const WITH_WEIGHT_OR_R: bool> OfDensity for Drawing<WITH_WEIGHT_OR_R> {
    #[cfg_attr(optimized, inline(always))]
    fn groups<I: Isa, D: Kind>(isa: I, inputs: &Inputs<'_>, mut out: Out<'_, Self>) -> Counts {
        let zero = isa.splat(0.0);
        for_each_group(
            isa,
            inputs,
            #[cfg_attr(optimized, inline(always))]
            |group, tally| {
                let Group { geometry, medium, index } = &group;
                let density = D::On::<I>::new(isa, geometry, medium);
                let lit = D::On::<I>::lit(isa, geometry);
                for_each_turn(
                    isa,
                    inputs,
                    *index,
                    tally,
                    #[cfg_attr(optimized, inline(always))]
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
}
