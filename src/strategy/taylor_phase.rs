//! The Taylor density of the phase function: (4.5) of `docs/mathematics.md` with the polynomial (4.3) up to `theta_c` of (4.4).
//!
//! The polynomial depends on the medium alone, and is made with it: [`Expanded::of_phase`].

use super::taylor::{Expansion, Taylor};
use crate::density::Kind;
use crate::expansion::Expanded;
use crate::geometry::Geometry;
use crate::integrand::MediumLanes;
use crate::simd::Isa;

#[derive(Clone, Copy)]
pub(crate) struct OfPhase;

impl Kind for OfPhase {
    type On<I: Isa> = Taylor<I, Self>;
}

impl<I: Isa> Expansion<I> for OfPhase {
    #[cfg_attr(optimized, inline(always))]
    fn expand(_: I, _: Geometry<'_, I>, medium: &MediumLanes<I>) -> Expanded<I> {
        medium.phase
    }
}
