//! The cone of a spot.

use super::check_unit;
use crate::Error;

/// The directions that a spot shines into, and the falloff of its intensity between the inner and the outer cone.
///
/// With `phi` the angle between the axis and the direction to the lit point, the intensity is multiplied by
/// `S(x) = s^2 (3 - 2 s)`, `s = (x - cos_outer)/(cos_inner - cos_outer)` clamped to `[0, 1]`, at `x = cos phi`. If the two
/// cosines are equal the edge is hard: `S = 1` for `x >= cos_outer`, the edge included, and 0 otherwise. A ray that only touches
/// the outer cone, or runs along its side, is dark. [mathematics](crate::guide::mathematics#8-spots) has the equations.
///
/// # Conversion of other parameters
///
/// | | `cos_outer` | `cos_inner` | between the cones |
/// |---|---|---|---|
/// | Blender: `spot_size` (the whole angle), `spot_blend` | `cos(spot_size/2)` | `cos_outer + spot_blend (1 - cos_outer)` | the same |
/// | glTF, `KHR_lights_punctual`: `innerConeAngle`, `outerConeAngle` (from the axis) | `cos(outerConeAngle)` | `cos(innerConeAngle)` | recommended there: `s^2` |
/// | pbrt-v4: `coneangle`, `conedeltaangle` (from the axis, in degrees) | `cos(coneangle)` | `cos(coneangle - conedeltaangle)` | the same |
///
/// Cycles (for a light of size 0) and pbrt-v4 have exactly this falloff; pbrt-v3 had `s^4`. glTF allows any smooth falloff.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Cone {
    axis: [f32; 3],
    cos_outer: f32,
    cos_inner: f32,
}

impl Cone {
    /// The cone of [`Emitter::spot`](super::Emitter::spot).
    pub(super) fn new(axis: [f32; 3], cos_outer: f32, cos_inner: f32) -> Result<Self, Error> {
        check_unit("axis", axis)?;
        Error::unless((0.0..=1.0).contains(&cos_outer), "cos_outer", cos_outer, "0 <= cos_outer <= 1")?;
        let expected = "cos_outer <= cos_inner <= 1";
        Error::unless((cos_outer..=1.0).contains(&cos_inner), "cos_inner", cos_inner, expected)?;
        Ok(Self { axis, cos_outer, cos_inner })
    }

    /// The direction of the axis. Its length does not matter.
    #[must_use]
    pub fn axis(&self) -> [f32; 3] {
        self.axis
    }
    /// The cosine of the angle from the axis beyond which the spot is dark.
    #[must_use]
    pub fn cos_outer(&self) -> f32 {
        self.cos_outer
    }
    /// The cosine of the angle from the axis up to which the intensity is full.
    #[must_use]
    pub fn cos_inner(&self) -> f32 {
        self.cos_inner
    }
}
