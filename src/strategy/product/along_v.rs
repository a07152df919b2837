//! Functions that are linear along the ray, in the variable `v` in which product densities and the integral have theirs.

use crate::geometry::{Cone, Geometry, Ramp};
use crate::simd::{Isa, Lanes, Number};

/// `X` at an end without cancellation, and `h/X`, of one division.
#[cfg_attr(optimized, inline(always))]
pub(crate) fn x_and_h_over_it<I: Isa>(isa: I, h: I::V, inv_h: I::V, t_prime: I::V, r: I::V) -> (I::V, I::V) {
    let forward = isa.splat(0.0).lt(t_prime);
    let long = r + t_prime.abs();
    let short = h / long;
    (I::V::select(forward, long, h * short), I::V::select(forward, short, long * inv_h))
}

/// Where a function is asked: `v` and `1 - v`, with `P` and `Q`, which stand for `h` and `X` in a scale of their own.
#[derive(Clone, Copy)]
pub(crate) struct At<I: Isa> {
    pub(crate) v: I::V,
    pub(crate) to_1: I::V,
    /// The scale at this place: `P` and `Q` are proportional to it.
    pub(crate) scale: I::V,
    pub(crate) p: I::V,
    pub(crate) q: I::V,
}

/// Units of length in which functions are given at `v`.
#[derive(Clone, Copy)]
pub(crate) struct Units<I: Isa> {
    /// What `v`, and what `1 - v`, is multiplied by.
    pub(crate) of_v: I::V,
    pub(crate) of_to_1: I::V,
    /// `h/X` at the ends.
    pub(crate) h_x_a: I::V,
    pub(crate) h_x_b: I::V,
}

/// `L(t') (P^2 + Q^2)/(2 r)` of a linear function `L`, from the end where it is smaller: sums of positive terms alone.
#[derive(Clone, Copy)]
pub(crate) struct AlongV<I: Isa> {
    least: I::V,
    half_slope: I::V,
    h_x: I::V,
    rising: I::Mask,
}

impl<I: Isa> AlongV<I> {
    /// That of a ramp, whose least value is given in the unit of lengths.
    #[cfg_attr(optimized, inline(always))]
    pub(crate) fn new(isa: I, ramp: &Ramp<I>, least: I::V, units: &Units<I>) -> Self {
        let Ramp { slope, rising, .. } = *ramp;
        let half_slope = isa.splat(0.5) * slope * I::V::select(rising, units.of_v, units.of_to_1);
        Self { least, half_slope, h_x: I::V::select(rising, units.h_x_a, units.h_x_b), rising }
    }

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
    /// What functions are multiplied by to be in units of `r/(P^2 + Q^2)`.
    unit: I::V,
}

impl<'g, I: Isa> ConeAlongV<'g, I> {
    /// That of the spots of a lane group, if there are any. `length` is the unit of lengths, with which `P` and `Q` have the
    /// factor `scale`.
    #[cfg_attr(optimized, inline(always))]
    pub(crate) fn new(isa: I, g: Geometry<'g, I>, length: I::V, scale: I::V, units: &Units<I>) -> Option<Self> {
        let cone = g.cone?;
        let before = AlongV::new(isa, &cone.before, cone.before.least * length, units);
        let after = AlongV::new(isa, &cone.after, cone.after.least * length, units);
        Some(Self { cone, before, after, unit: scale + scale })
    }

    /// `S`, given `m` as [`AlongV`] has it, and `P^2 + Q^2`.
    #[cfg_attr(optimized, inline(always))]
    pub(crate) fn at(&self, isa: I, at: &At<I>, m: I::V, squares: I::V) -> I::V {
        let unit = self.unit / squares;
        self.cone.falloff(isa, self.before.at(at) * unit, self.after.at(at) * unit, m * unit)
    }
}
