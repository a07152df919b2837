//! The expansion of the phase function, which is the medium's: [`Expanded::of_phase`].

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
