//! The road cut short, to time its stages.
//!
//! What a stage has computed is kept from being optimised away by `black_box`, for which it is written to memory: a few
//! ns per lane group that the whole road does not pay, as it keeps such values in registers where it can.

use super::groups::{Group, for_each_group, for_each_turn};
use super::{OfDensity, Task, by_strategy};
use crate::Strategy;
use crate::batch::{Counts, Inputs, Outputs};
use crate::density::{Density, Kind};
use crate::simd::{Isa, Lanes, Machine, none};
use core::hint::black_box;
use core::ops::Range;

/// How far a ray goes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Stage {
    /// Columns are loaded, and the geometry is computed.
    Geometry,
    /// The density is set up as well.
    SetUp,
    /// The points are drawn as well, and not written.
    Inversion,
}

/// Goes as far as its output, the stage, says.
pub(crate) struct UpTo;

/// Nothing is written.
impl Outputs for Stage {
    type At<'a> = Self;

    fn split_at<'a>(out: Self::At<'a>, _: usize) -> (Self::At<'a>, Self::At<'a>) {
        (out, out)
    }

    fn part(out: &mut Self, _: Range<usize>) -> Self {
        *out
    }

    fn by_pads<R>(out: Self, write: impl FnOnce(Self) -> R) -> R {
        write(out)
    }
}

impl Task for UpTo {
    type Out = Stage;

    fn run(machine: impl Machine, strategy: Strategy, inputs: &Inputs<'_>, stage: Stage) -> Counts {
        by_strategy::<Self>(machine, strategy, inputs, stage)
    }
}

impl OfDensity for UpTo {
    #[cfg_attr(optimized, inline(always))]
    fn groups<I: Isa, D: Kind>(isa: I, inputs: &Inputs<'_>, stage: Stage) -> Counts {
        let zero = isa.splat(0.0);
        for_each_group(
            isa,
            inputs,
            #[cfg_attr(optimized, inline(always))]
            |group, tally| {
                // Values, not references, go into the black box: the stages beyond keep theirs in registers.
                if stage == Stage::Geometry {
                    let (valid, lit) = (group.valid(), group.geometry.lit);
                    black_box((group.geometry, group.medium.mu_t));
                    return tally.add(isa, valid, lit, none(isa));
                }
                let density = D::On::<I>::new(isa, &group.geometry, &group.medium);
                if stage == Stage::SetUp {
                    let (valid, lit) = (group.valid(), D::On::<I>::lit(isa, &group.geometry));
                    black_box((group.geometry, density));
                    return tally.add(isa, valid, lit, none(isa));
                }
                let lit = D::On::<I>::lit(isa, &group.geometry);
                let Group { geometry, index, .. } = &group;
                for_each_turn(
                    isa,
                    inputs,
                    *index,
                    tally,
                    #[cfg_attr(optimized, inline(always))]
                    |_, u, tally| {
                        let valid = group.valid() & zero.le(u) & u.le(isa.splat(1.0));
                        let drawn = density.invert(isa, geometry, u);
                        let bisected = drawn.bisected;
                        black_box(drawn);
                        tally.add(isa, valid, lit, bisected);
                    },
                );
            },
        )
    }
}
