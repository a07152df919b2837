//! airlight
mod batch;
mod density;
mod error;
mod geometry;
mod integrand;
mod inversion;
pub mod oracle;
mod road;
mod sampler;
mod scene;
mod simd;
mod strategy;

pub use batch::{Counts, Emitters, Media, Rays, Samples};
pub use error::Error;
pub use sampler::{Sample, Sampler};
pub use scene::{Emitter, FARTHEST, Medium, Ray, UNIT_TOLERANCE};
pub use strategy::{Strategy, UnknownStrategy};
