//! What measures airlight: families of hard inputs and the errors of the kernels on them, sets of scenes and the
//! variances of the densities on them, and the batch on which speed is measured. And what embeds it: a small wavefront
//! renderer.

pub mod adversary;
pub mod backends;
pub mod batch;
pub mod bounds;
pub mod column;
pub mod contender;
mod draw;
pub mod errors;
pub mod families;
pub mod hard;
pub mod promises;
pub mod renderer;
pub mod room;
pub mod samplers;
pub mod scenes;
pub mod threads;
pub mod variates;
pub mod workload;
