//! The definitions of the oracle once more, in the most obvious way: what cancels has digits to spare.

mod density;
mod number;
mod polynomial;
mod product;
mod quadrature;
mod scene;

pub(crate) use density::Densities;
pub(crate) use number::{Big, big};
pub(crate) use scene::Scene;
