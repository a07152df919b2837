//! What is seen of the integrand at the places `z_k`: `q_k` of (6.8), without constant factors, in each precision.
//!
//! Exact precision has lengths times `s = e + 1 - z`, as (6.9) and (6.10). Fast precision has the lengths themselves, with one
//! division for the place and one for the result:
//!
//! ```text
//! turn = (1 + e)/s,   w = z turn,   X = X_a + Y_c w/(1 + e)
//! m X = X (b_0 + b_1 way) + c_1 way       way = w rising, (1 - z) turn falling    (6.20)
//! q = exp(-mu_t Y) (m X turn^2) (X^2 + h^2)^(-1/2) (A^2 X^2 + B^2 h^2)^(-3/2)     (6.21)
//! ```
//!
//! `b_0` is the least `m`, `b_1 way` is `(|beta|/2) Y` from the start or `(|beta|/2) (Y_b - Y)` from the end, whichever has the
//! least `m`, and `c_1 = b_1 h (h/X)` with the `X` of that end; this is (2.5) with (5.9) or (5.10). Without a normal, `X^2 + h^2`
//! stands in place of `m X`. Lengths are in units of the largest of `h`, `X_a`, `Y_c` in both precisions.

use super::Map;
use super::along_v::{AlongV, At, ConeAlongV, Units};
use crate::geometry::Geometry;
use crate::integrand::Lobe;
use crate::simd::math::{exp2_neg, one_minus_exp};
use crate::simd::{Isa, Lanes, Number};
use core::f32::consts::LOG2_E;

/// `h`, `X_a` and `Y_c` in units of the largest of them.
pub(super) struct Lengths<I: Isa> {
    pub(super) h: I::V,
    pub(super) x_a: I::V,
    pub(super) y_c: I::V,
    /// 1 over the largest \[1/m\].
    pub(super) inv_largest: I::V,
}

/// An upper bound of `mu_t Y_c` in powers of 2. (6.1) keeps it below 1/0.45, unless `Y_c` is at its floor.
const MOST_DEPTH: f32 = 2.25 * LOG2_E;
/// An upper bound of `e`, with which `turn` is not infinity over infinity.
const MOST_E: f32 = 1e30;

/// (6.10), in exact precision.
pub(super) struct Scaled<'g, I: Isa> {
    e: I::V,
    a2: I::V,
    b2: I::V,
    /// The lengths times `1/(1 + e)`.
    h_unit: I::V,
    x_unit: I::V,
    y_c_unit: I::V,
    has_normal: I::Mask,
    m_along: AlongV<I>,
    cone: Option<ConeAlongV<'g, I>>,
}

impl<'g, I: Isa> Scaled<'g, I> {
    #[cfg_attr(optimized, inline(always))]
    pub(super) fn new(isa: I, g: Geometry<'g, I>, lobe: &Lobe<I>, map: &Map<I>, lengths: &Lengths<I>) -> Self {
        let Map { h_x_a, h_x_b, inv_y_c, e, inv_e, w_0, .. } = *map;
        let units = Units { of_v: w_0, of_to_1: inv_e, h_x_a, h_x_b };
        Self {
            e,
            a2: lobe.a2,
            b2: lobe.b2,
            h_unit: w_0 * lengths.h,
            x_unit: w_0 * lengths.x_a,
            y_c_unit: w_0 * lengths.y_c,
            has_normal: g.cosine.has_normal,
            m_along: AlongV::new(isa, &g.cosine.ramp(isa), w_0 * g.cosine.m_least * inv_y_c, &units),
            cone: ConeAlongV::new(isa, g, w_0 * inv_y_c, lengths.y_c, &units),
        }
    }

    /// `q` at the place `z`, given `z` and `1 - z`. `depth` is `mu_t Y_c`; without it the transmittance is left out.
    #[cfg_attr(optimized, inline(always))]
    pub(super) fn at(&self, isa: I, depth: Option<I::V>, [z, to_1]: [f32; 2]) -> I::V {
        let c = |x| isa.splat(x);
        let (v, to_1) = (c(z), c(to_1));
        let s = self.e + to_1;
        let transmittance = match depth {
            Some(depth) => one_minus_exp(isa, depth * (v / s)).1,
            None => c(1.0),
        };
        // P, Q and m X s^2 (6.9), P^2 + Q^2 and A^2 Q^2 + B^2 P^2.
        let p = self.h_unit * s;
        let q = self.x_unit.mul_add(s, self.y_c_unit * v);
        let at = At { v, to_1, scale: s, p, q };
        let m = self.m_along.at(&at);
        let p2 = p * p;
        let squares = q.mul_add(q, p2).max(c(1e-18));
        let lobe = (self.a2 * q).mul_add(q, self.b2 * p2).max(c(1e-18));
        let mut numerator = I::V::select(self.has_normal, m.max(c(0.0)), squares);
        if let Some(cone) = &self.cone {
            numerator = numerator * cone.at(isa, &at, m, squares);
        }
        transmittance * numerator / (lobe * (squares * lobe).sqrt())
    }
}

/// (6.21), in fast precision.
pub(super) struct Unscaled<I: Isa> {
    /// `e` and `1 + e`.
    e: I::V,
    turned: I::V,
    a2: I::V,
    b2_h2: I::V,
    h2: I::V,
    x_a: I::V,
    /// `Y_c/(1 + e)`.
    y_w: I::V,
    /// `mu_t Y_c/(1 + e)` in powers of 2.
    depth: I::V,
    /// The numbers of (6.20); without a normal those of `X^2 + h^2`.
    rising: I::Mask,
    b_0: I::V,
    b_1: I::V,
    c_0: I::V,
    c_1: I::V,
}

impl<I: Isa> Unscaled<I> {
    /// `depth` is `mu_t Y_c`, or 0 to leave the transmittance out.
    #[cfg_attr(optimized, inline(always))]
    pub(super) fn new(
        isa: I,
        g: Geometry<'_, I>,
        lobe: &Lobe<I>,
        depth: I::V,
        map: &Map<I>,
        lengths: &Lengths<I>,
    ) -> Self {
        let c = |x| isa.splat(x);
        let Map { h_x_a, h_x_b, e, inv_e, w_0, .. } = *map;
        let Lengths { h, x_a, y_c, inv_largest } = *lengths;
        let e = e.min(c(MOST_E));
        let h2 = h * h;
        let y_w = y_c * w_0;
        let depth = (depth * c(LOG2_E)).min(c(MOST_DEPTH)) * w_0;
        let rising = g.cosine.rising(isa);
        let half_slope = c(0.5) * g.cosine.beta.abs();
        let b_0 = g.cosine.m_least * inv_largest;
        let b_1 = half_slope * I::V::select(rising, y_w, y_c * inv_e);
        let c_1 = b_1 * (h * I::V::select(rising, h_x_a, h_x_b));
        let has_normal = g.cosine.has_normal;
        Self {
            e,
            turned: c(1.0) + e,
            a2: lobe.a2,
            b2_h2: lobe.b2 * h2,
            h2,
            x_a,
            y_w,
            depth,
            rising: rising | !has_normal,
            b_0: I::V::select(has_normal, b_0, x_a),
            b_1: I::V::select(has_normal, b_1, y_w),
            c_0: I::V::only(!has_normal, h2),
            c_1: I::V::only(has_normal, c_1),
        }
    }

    /// `turn`, `w` and `X` at the place `z`.
    #[cfg_attr(optimized, inline(always))]
    fn place(&self, isa: I, [z, to_1]: [f32; 2]) -> [I::V; 3] {
        let turn = self.turned / (self.e + isa.splat(to_1));
        let w = isa.splat(z) * turn;
        [turn, w, self.y_w.mul_add(w, self.x_a)]
    }

    /// `q` at the place `z`, given `z` and `1 - z`.
    #[cfg_attr(optimized, inline(always))]
    pub(super) fn at(&self, isa: I, z: [f32; 2]) -> I::V {
        let c = |x| isa.splat(x);
        let [turn, w, x] = self.place(isa, z);
        let way = I::V::select(self.rising, c(z[0]), c(z[1])) * turn;
        let m_x = x.mul_add(self.b_1.mul_add(way, self.b_0), self.c_1.mul_add(way, self.c_0));
        let x2 = x * x;
        let squares = x2 + self.h2;
        let lobe = self.a2.mul_add(x2, self.b2_h2);
        let transmittance = exp2_neg(isa, self.depth * w, MOST_DEPTH * (z[0] / z[1]));
        (transmittance * m_x) * (turn * turn) / (lobe * (squares * lobe).sqrt()).max(c(1e-30))
    }

    /// The falloff of spots, if there are any.
    #[cfg_attr(optimized, inline(always))]
    pub(super) fn falloff<'g>(
        &self,
        isa: I,
        g: Geometry<'g, I>,
        map: &Map<I>,
        lengths: &Lengths<I>,
    ) -> Option<Falloff<'g, I>> {
        let &Map { h_x_a, h_x_b, inv_e, .. } = map;
        let units = Units { of_v: self.y_w, of_to_1: lengths.y_c * inv_e, h_x_a, h_x_b };
        let cone = ConeAlongV::new(isa, g, lengths.inv_largest, isa.splat(1.0), &units)?;
        let m_along = AlongV::new(isa, &g.cosine.ramp(isa), lengths.inv_largest * g.cosine.m_least, &units);
        Some(Falloff { cone, m_along, h: lengths.h })
    }
}

/// The falloff of spots in fast precision, a factor of (6.21).
pub(super) struct Falloff<'g, I: Isa> {
    cone: ConeAlongV<'g, I>,
    m_along: AlongV<I>,
    h: I::V,
}

impl<I: Isa> Falloff<'_, I> {
    /// `S` at the place `z`, given `z` and `1 - z`.
    #[cfg_attr(optimized, inline(always))]
    pub(super) fn at(&self, isa: I, integrand: &Unscaled<I>, z: [f32; 2]) -> I::V {
        let [turn, w, x] = integrand.place(isa, z);
        let at = At { v: w, to_1: isa.splat(z[1]) * turn, scale: isa.splat(1.0), p: self.h, q: x };
        let squares = x.mul_add(x, integrand.h2).max(isa.splat(1e-18));
        self.cone.at(isa, &at, self.m_along.at(&at), squares)
    }
}
