//! Sampling up to a stage, to time the stages.
//!
//! Each stage is a pass that writes records, so that its time is the difference between two runs. With one variate per ray the
//! Taylor densities have set-up, inversion and output in one pass without records, which takes less than their sum.

use super::blocks::{SetUps, Wanted, for_each_block, for_each_run, set_up};
use super::sample::draw;
use super::{Method, OfDensity, Task, by_strategy};
use crate::Precision;
use crate::batch::{Counts, Inputs, Outputs};
use crate::density::{Density, Kind};
use crate::simd::{Isa, Machine, Records, Room};
use core::hint::black_box;
use core::ops::Range;

/// The last stage of a run.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Stage {
    /// Columns are loaded, and the geometry is computed.
    Geometry,
    /// The density is set up as well.
    SetUp,
    /// The inverse of the CDF is applied to variates as well; only the point of the ray and output are left.
    Inversion,
}

/// Samples up to the stage that stands in place of outputs.
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
    type Method = Method;
    type Out = Stage;

    fn run(machine: impl Machine, method: Method, inputs: &Inputs<'_>, stage: Stage) -> Counts {
        by_strategy::<Self>(machine, method, inputs, stage)
    }
}

impl OfDensity for UpTo {
    fn groups<I: Isa, D: Kind>(isa: I, precision: Precision, inputs: &Inputs<'_>, stage: Stage) -> Counts {
        let (mut set_ups, mut places, mut pad) = (SetUps::<I, D>::new(), Records::new(), None);
        let wanted = Wanted { precision, extent: D::On::<I>::EXTENT, records: SetUps::<I, D>::SIZE };
        for_each_block(isa, inputs, wanted, |block| {
            black_box(block.geometries().get(0));
            if stage != Stage::Geometry {
                let set_ups = black_box(set_up::<I, D, D::On<I>>(isa, block, &mut set_ups));
                if stage == Stage::Inversion {
                    for_each_run(block, |run| {
                        let u = run.values(inputs.given, &mut pad);
                        black_box(draw::<I, D>(isa, block, set_ups, run.turns, u, &mut places));
                    });
                }
            }
        });
        Counts::default()
    }
}
