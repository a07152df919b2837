//! Functions that are linear along the ray, at a place `v` of the product densities or of the rule of the integral.
//!
//! With `P = h s`, `Q = X s`, `s = e + 1 - v` of section 6.2 of `docs/mathematics.md`, and `L` with the least value `L_e` and the
//! slope `|beta|`:
//!
//! ```text
//! L X s^2 = L_a s Q + (|beta|/2) Y_c v (Q + P h/X_a)                 rising: from a                  (6.9)
//!         = L_b s Q + (|beta|/2) (Y_c + Y_b) (1 - v) (Q + P h/X_b)   falling: from b
//! ```
//!
//! `L` is `m` of (2.5), or `D_1` and `D_2` of (8.8), (8.9). Each caller has a unit of length of its own, given as [`Units`].

use crate::geometry::{Cone, Geometry, Ramp};
use crate::simd::{Isa, Lanes, Number};

/// `X` at an end by (5.7), and `h/X`, with one division.
#[cfg_attr(optimized, inline(always))]
pub(crate) fn x_and_h_over_it<I: Isa>(isa: I, h: I::V, inv_h: I::V, t_prime: I::V, r: I::V) -> (I::V, I::V) {
    let forward = isa.splat(0.0).lt(t_prime);
    let long = r + t_prime.abs();
    let short = h / long;
    (I::V::select(forward, long, h * short), I::V::select(forward, short, long * inv_h))
}

/// The place: `v` and `1 - v`, with `P` and `Q` in the caller's unit.
#[derive(Clone, Copy)]
pub(crate) struct At<I: Isa> {
    pub(crate) v: I::V,
    pub(crate) to_1: I::V,
    /// `s`, or `s/(1 + e)`: `P` and `Q` are proportional to it.
    pub(crate) scale: I::V,
    pub(crate) p: I::V,
    pub(crate) q: I::V,
}

/// The units of length of a caller.
#[derive(Clone, Copy)]
pub(crate) struct Units<I: Isa> {
    /// `Y_c` and `Y_c + Y_b` in these units: the factors of `v` and of `1 - v`.
    pub(crate) of_v: I::V,
    pub(crate) of_to_1: I::V,
    /// `h/X` at the ends.
    pub(crate) h_x_a: I::V,
    pub(crate) h_x_b: I::V,
}

/// `L X s^2`, which is `L (P^2 + Q^2)/(2 r)`, of a linear function `L`, from the end where it is smaller: all terms are positive.
#[derive(Clone, Copy)]
pub(crate) struct AlongV<I: Isa> {
    least: I::V,
    half_slope: I::V,
    h_x: I::V,
    rising: I::Mask,
}

impl<I: Isa> AlongV<I> {
    /// From a ramp, with its least value in the unit of length.
    #[cfg_attr(optimized, inline(always))]
    pub(crate) fn new(isa: I, ramp: &Ramp<I>, least: I::V, units: &Units<I>) -> Self {
        let Ramp { slope, rising, .. } = *ramp;
        let half_slope = isa.splat(0.5) * slope * I::V::select(rising, units.of_v, units.of_to_1);
        Self { least, half_slope, h_x: I::V::select(rising, units.h_x_a, units.h_x_b), rising }
    }

    /// (6.9)
    #[cfg_attr(optimized, inline(always))]
    pub(crate) fn at(&self, at: &At<I>) -> I::V {
        let At { v, to_1, scale, p, q } = *at;
        let way = I::V::select(self.rising, v, to_1);
        self.least.mul_add(scale * q, self.half_slope * way * p.mul_add(self.h_x, q))
    }
}

/// The falloff of spots at `v`.
#[derive(Clone, Copy)]
pub(crate) struct ConeAlongV<'g, I: Isa> {
    cone: &'g Cone<I>,
    before: AlongV<I>,
    after: AlongV<I>,
    /// The factor that makes values of [`AlongV`] over `P^2 + Q^2` values over `r`.
    unit: I::V,
}

impl<'g, I: Isa> ConeAlongV<'g, I> {
    /// From the spots of a lane group, if there are any. `length` is the reciprocal of the unit of length, in which `P` and `Q`
    /// also have the factor `scale`.
    #[cfg_attr(optimized, inline(always))]
    pub(crate) fn new(isa: I, g: Geometry<'g, I>, length: I::V, scale: I::V, units: &Units<I>) -> Option<Self> {
        let cone = g.cone?;
        let before = AlongV::new(isa, &cone.before, cone.before.least * length, units);
        let after = AlongV::new(isa, &cone.after, cone.after.least * length, units);
        Some(Self { cone, before, after, unit: scale + scale })
    }

    /// `S` (8.10), (8.1), given `m` as of [`AlongV`], and `P^2 + Q^2`.
    #[cfg_attr(optimized, inline(always))]
    pub(crate) fn at(&self, isa: I, at: &At<I>, m: I::V, squares: I::V) -> I::V {
        let unit = self.unit / squares;
        self.cone.falloff(isa, self.before.at(at) * unit, self.after.at(at) * unit, m * unit)
    }
}
