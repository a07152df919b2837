//! Borrowed columns of a batch: rays, emitters, media in, samples out, and how they are split.

mod counts;
mod emitters;
mod inputs;
mod media;
mod outputs;
mod pads;
mod rays;
mod runs;
mod samples;
mod source;

pub use counts::Counts;
pub use emitters::Emitters;
pub(crate) use emitters::{ConeRows, EmitterRows};
pub(crate) use inputs::Inputs;
pub use media::Media;
pub(crate) use media::{ChannelGroups, MediaPlace, MediaRows, MediumGroups, MediumRows};
pub(crate) use outputs::{Choices, Column, Columns, OfRuns, Outputs, columns};
pub(crate) use pads::{Pad, Pads, first_values};
pub(crate) use rays::RayGroups;
pub use rays::Rays;
pub(crate) use runs::{Run, Turn};
pub(crate) use samples::OfSamples;
pub use samples::Samples;
pub(crate) use source::{Gathered, Rows};

use crate::simd::Isa;

/// The most rays of a block.
pub(crate) const MOST_RAYS: usize = 256;

/// The first `count` groups of a column.
#[cfg_attr(optimized, inline(always))]
fn cut<I: Isa>(column: &[f32], count: usize) -> &[I::Group] {
    &I::groups(column)[..count]
}
