//! airlight
mod batch;
mod error;
pub mod oracle;
mod sampler;
mod scene;
mod strategy;

pub use batch::{Counts, Emitters, Media, Rays, Samples};
pub use error::Error;
pub use sampler::{Sample, Sampler};
pub use scene::{Emitter, FARTHEST, Medium, Ray, UNIT_TOLERANCE};
pub use strategy::{Strategy, UnknownStrategy};
