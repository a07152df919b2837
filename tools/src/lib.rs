//! What measures airlight: families of hard inputs and the errors of the kernels on them, sets of scenes and the
//! variances of the densities on them. And what embeds it: a small wavefront renderer.

pub mod adversary;
pub mod bounds;
pub mod contender;
mod draw;
pub mod errors;
pub mod families;
pub mod renderer;
pub mod scenes;
pub mod variates;
