//! What measures airlight: families of hard inputs, and the errors of the kernels on them.

pub mod bounds;
pub mod errors;
pub mod families;
