//! The borrowed columns of a batch: rays, emitters and media as input, samples as output, and their division into parts.

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
pub(crate) use emitters::{ConePlace, ConeRows, EmitterPlace, EmitterRows};
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
pub(crate) use source::Rows;

use crate::simd::{Isa, MOST_LANES};

/// The largest number of rays of a block.
pub(crate) const MOST_RAYS: usize = if cfg!(optimized) { 512 } else { 2 * MOST_LANES };

/// The first `count` groups of a column.
#[cfg_attr(optimized, inline(always))]
fn cut<I: Isa>(column: &[f32], count: usize) -> &[I::Group] {
    &I::groups(column)[..count]
}
