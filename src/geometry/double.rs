//! The geometry in f64, rounded once to f32: for every ray, and every emitter that is no spot.
//!
//! Equations of `docs/mathematics.md`, sections 2.1 and 2.3:
//!
//! ```text
//! e = y - o,   q = |d|^2 - 1,   1/|d| = 1 - q/2 + 3/8 q^2 - 5/16 q^3 + 35/128 q^4
//! t_h = e.d/|d|,   foot = t_h d/|d| - e,   h^2 = foot.foot                 (2.1), (2.2)
//! t' = t - t_h                                                             (2.3)
//! beta = n.d/|d|,   alpha h = n.foot,   m = alpha h + beta t'              (2.4)
//! t'_n = -alpha h/beta, where m = 0
//! ```
//!
//! Departures from this, and why:
//!
//! 1. `h` is at least 1e-9 of `max(|t_h|, |t_min - t_h|)` and at least 1e-18 m: f64 cannot tell less from 0. An emitter on the line
//!    of the ray is treated as one that is so far beside it.
//! 2. `t'_n` has a Newton step after the f32 division: a lit interval may be as short as the division's error.
//! 3. The length of a clipped interval is `max(m_a, m_b)/|beta|`, not a difference of distances.
//! 4. A ray within 1e-30 rad of the emitter's plane is not clipped: if one end is dark, all of it is.

use super::{Cosine, EmitterLanes, Foot, Lit, Located, RayLanes, Refined, Rests, TOLERANCE, dot, largest, widen};
use crate::scene::FARTHEST;
use crate::simd::math::reciprocal_near;
use crate::simd::{Double, Isa, Lanes, Number};

/// The sine of the least angle between a ray and the emitter's plane at which the ray is clipped there.
const FLATTEST: f32 = 1e-30;

/// The line of a ray as seen from an emitter.
pub(super) struct Line<I: Isa> {
    /// The direction, and `1/|d|`.
    pub(super) d: [I::Double; 3],
    pub(super) unit: I::Double,
    /// `e = y - o`
    pub(super) e: [I::Double; 3],
    pub(super) t_h: I::Double,
    /// The vector from the emitter to the foot of the perpendicular.
    foot: [I::Double; 3],
    /// `h^2`, larger than `foot.foot` where the emitter is on the line (departure 1).
    h_squared: I::Double,
    /// The end of the ray, and `t'` at its start and end.
    pub(super) t_max: I::V,
    pub(super) t_prime: [I::Double; 2],
    /// Which lanes hold a valid ray.
    pub(super) valid: I::Mask,
    size_squared: I::V,
    least_h: I::V,
}

impl<I: Isa> Line<I> {
    #[cfg_attr(optimized, inline(always))]
    pub(super) fn new(isa: I, ray: &RayLanes<I>, position: [I::V; 3]) -> Self {
        let c = |x| isa.splat(x);
        let (d, o, y) = (widen::<I>(ray.direction), widen::<I>(ray.origin), widen::<I>(position));
        let e = [y[0] - o[0], y[1] - o[1], y[2] - o[2]];

        // (2.1), (2.2)
        let q = excess_of_square(isa, d);
        let unit = one_over_length(isa, q);
        let t_h = dot(e, d) * unit;
        let along = t_h * unit;
        let foot = [along.mul_add(d[0], -e[0]), along.mul_add(d[1], -e[1]), along.mul_add(d[2], -e[2])];

        let t_max = ray.end(isa);
        // (2.3)
        let t_prime = [ray.t_min.widen() - t_h, t_max.widen() - t_h];
        let t_prime_a = I::V::narrow(t_prime[0]);
        // The least h that f64 can tell from 0 at this distance.
        let least_h = (t_prime_a.abs().max((ray.t_min - t_prime_a).abs()) * c(1e-9)).max(c(1e-18));
        let least = least_h.widen();
        let foot_squared = dot(foot, foot);
        let size_squared = I::V::narrow(foot_squared);
        let valid = I::V::narrow(q).abs().le(c(TOLERANCE))
            & largest::<I>(ray.origin).le(c(FARTHEST))
            & c(0.0).le(ray.t_min)
            & ray.t_min.le(c(FARTHEST))
            & ray.t_min.le(ray.t_max)
            // It is NaN if a coordinate is NaN.
            & size_squared.le(c(16.0 * FARTHEST * FARTHEST));
        let h_squared = foot_squared.max(least * least);
        Self { d, unit, e, t_h, foot, h_squared, t_max, t_prime, valid, size_squared, least_h }
    }

    /// The foot of the perpendicular, with the given `t'` at the ends of the lit interval.
    #[cfg_attr(optimized, inline(always))]
    pub(super) fn foot(&self, [a, b]: [I::V; 2]) -> Foot<I> {
        let h_squared = (self.least_h * self.least_h).max(self.size_squared);
        let t_h = I::V::narrow(self.t_h);
        let t_h_low = I::V::narrow(self.t_h - t_h.widen());
        Foot { h: h_squared.sqrt(), h_squared, t_h, t_h_low, a, b }
    }

    /// The distance of the point at `t'`, clamped to the ray, and the remainder of its rounding.
    #[cfg_attr(optimized, inline(always))]
    pub(super) fn end_at(&self, ray: &RayLanes<I>, t_prime: I::Double) -> [I::V; 2] {
        let exact = self.t_h + t_prime;
        let t = I::V::narrow(exact).max(ray.t_min).min(self.t_max);
        [t, I::V::narrow(exact - t.widen())]
    }
}

/// `|v|^2 - 1`.
#[cfg_attr(optimized, inline(always))]
pub(super) fn excess_of_square<I: Isa>(isa: I, v: [I::Double; 3]) -> I::Double {
    v[2].mul_add(v[2], v[1].mul_add(v[1], v[0].mul_add(v[0], isa.splat_double(-1.0))))
}

/// `1/|v|` of a vector of nearly unit length, by the series in `q = |v|^2 - 1`.
#[cfg_attr(optimized, inline(always))]
pub(super) fn one_over_length<I: Isa>(isa: I, q: I::Double) -> I::Double {
    q.mul_add(isa.splat_double(0.273_437_5), isa.splat_double(-0.3125))
        .mul_add(q, isa.splat_double(0.375))
        .mul_add(q * q, q.mul_add(isa.splat_double(-0.5), isa.splat_double(1.0)))
}

/// The difference between the foot of the perpendicular in f64 and the given one.
#[cfg_attr(optimized, inline(always))]
pub(crate) fn refine<I: Isa>(isa: I, ray: &RayLanes<I>, emitter: &EmitterLanes<I>, foot: &Foot<I>) -> Refined<I> {
    let line = Line::new(isa, ray, emitter.position);
    Refined {
        t_h: I::V::narrow((line.t_h - foot.t_h.widen()) - foot.t_h_low.widen()),
        h_squared: I::V::narrow(line.h_squared - foot.h_squared.widen()),
    }
}

/// The part of the ray on the side of the emitter's normal.
#[cfg_attr(optimized, inline(always))]
pub(super) fn locate<I: Isa>(isa: I, ray: &RayLanes<I>, emitter: &EmitterLanes<I>) -> Located<I> {
    let c = |x| isa.splat(x);
    let line = Line::new(isa, ray, emitter.position);
    let n = widen::<I>(emitter.normal);
    // (2.4)
    let beta_exact = dot(n, line.d) * line.unit;
    let alpha_h = dot(n, line.foot);
    let (t_max, [t_prime_min, t_prime_max]) = (line.t_max, line.t_prime);
    let (ta, tb) = (I::V::narrow(t_prime_min), I::V::narrow(t_prime_max));
    let length = t_max - ray.t_min;

    // The signs of m at the ends decide what is lit.
    let has_normal = emitter.has_normal;
    let m_a = I::V::narrow(beta_exact.mul_add(t_prime_min, alpha_h));
    let m_b = I::V::narrow(beta_exact.mul_add(t_prime_max, alpha_h));
    let dark_a = has_normal & m_a.le(c(0.0));
    let dark_b = has_normal & m_b.le(c(0.0));
    let beta = I::V::narrow(beta_exact);
    // Departure 4.
    let flat = beta.abs().lt(c(FLATTEST));
    let both = (dark_a & dark_b) | (flat & (dark_a | dark_b));
    let (clip_a, clip_b) = (dark_a & !dark_b, dark_b & !dark_a);

    // m = 0, with the Newton step of departure 2.
    let inv_beta = c(1.0) / beta;
    let near = inv_beta.widen();
    let once = -(alpha_h * reciprocal_near(isa, beta_exact, near));
    let t_prime_n = once - beta_exact.mul_add(once, alpha_h) * near;
    let tn = I::V::narrow(t_prime_n).max(ta).min(tb);
    let lit_length = (m_a.max(m_b) * inv_beta.abs()).min(length);
    let length = I::V::select(both, c(0.0), I::V::select(clip_a | clip_b, lit_length, length));
    let [t_n, rest_n] = line.end_at(ray, t_prime_n);

    let lit = Lit { a: I::V::select(clip_a, t_n, ray.t_min), b: I::V::select(clip_b, t_n, t_max), length };
    let cosine = Cosine { m_least: m_a.min(m_b).max(c(0.0)), beta, has_normal };
    let ends = [I::V::select(clip_a, tn, ta), I::V::select(clip_b, tn, tb)];
    Located {
        lit,
        rests: Rests { a: I::V::only(clip_a, rest_n), b: I::V::only(clip_b, rest_n) },
        cosine,
        foot: line.foot(ends),
        alpha_h: I::V::narrow(alpha_h),
        valid: emitter.valid & line.valid,
    }
}
