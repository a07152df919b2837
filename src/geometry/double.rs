//! The geometry in double precision, rounded once: for every ray and emitter.

use super::{Cosine, EmitterLanes, End, Foot, Lit, Located, RayLanes, TOLERANCE, dot, largest, widen};
use crate::scene::FARTHEST;
use crate::simd::math::reciprocal_near;
use crate::simd::{Double, Isa, Lanes, Number};

/// Sine of the least angle between a ray and the emitter's plane of which it is known where they meet.
const FLATTEST: f32 = 1e-30;

/// A ray as an emitter sees it.
pub(super) struct Line<I: Isa> {
    /// The direction, and `1/|d|`.
    pub(super) d: [I::Double; 3],
    pub(super) unit: I::Double,
    /// The way from the ray's origin to the emitter.
    pub(super) e: [I::Double; 3],
    pub(super) t_h: I::Double,
    /// From the emitter to the foot of the perpendicular.
    foot: [I::Double; 3],
    /// It is larger than the square of that where the emitter is on the line.
    h_squared: I::Double,
    /// Where the ray ends, as a distance, and `t'` there.
    pub(super) t_max: I::V,
    pub(super) t_prime: [I::Double; 2],
    /// Which lanes hold a ray whose place is known.
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

        // Distances are in metres also where d is not quite a unit vector.
        let q = excess_of_square(isa, d);
        let unit = one_over_length(isa, q);
        let t_h = dot(e, d) * unit;
        let along = t_h * unit;
        let foot = [along.mul_add(d[0], -e[0]), along.mul_add(d[1], -e[1]), along.mul_add(d[2], -e[2])];

        let t_max = ray.end(isa);
        let t_prime = [ray.t_min.widen() - t_h, t_max.widen() - t_h];
        let t_prime_a = I::V::narrow(t_prime[0]);
        // The least h that f64 tells from none at this distance.
        let least_h = (t_prime_a.abs().max((ray.t_min - t_prime_a).abs()) * c(1e-9)).max(c(1e-18));
        let least = least_h.widen();
        let foot_squared = dot(foot, foot);
        let size_squared = I::V::narrow(foot_squared);
        let valid = I::V::narrow(q).abs().le(c(TOLERANCE))
            & largest::<I>(ray.origin).le(c(FARTHEST))
            & c(0.0).le(ray.t_min)
            & ray.t_min.le(c(FARTHEST))
            & ray.t_min.le(ray.t_max)
            // No number where one of the coordinates is none.
            & size_squared.le(c(16.0 * FARTHEST * FARTHEST));
        let h_squared = foot_squared.max(least * least);
        Self { d, unit, e, t_h, foot, h_squared, t_max, t_prime, valid, size_squared, least_h }
    }

    /// The foot of the perpendicular, with `t'` at the ends of the lit interval and `alpha_h` as they are given.
    #[cfg_attr(optimized, inline(always))]
    pub(super) fn foot(&self, [a, b]: [I::V; 2], alpha_h: I::V) -> Foot<I> {
        let h_squared = (self.least_h * self.least_h).max(self.size_squared);
        let t_h = I::V::narrow(self.t_h);
        Foot {
            h: h_squared.sqrt(),
            h_squared,
            h_squared_low: I::V::narrow(self.h_squared - h_squared.widen()),
            t_h,
            t_h_low: I::V::narrow(self.t_h - t_h.widen()),
            a,
            b,
            alpha_h,
        }
    }

    /// The end of a lit interval within the ray at `t'`.
    #[cfg_attr(optimized, inline(always))]
    pub(super) fn end_at(&self, ray: &RayLanes<I>, t_prime: I::Double) -> End<I> {
        let exact = self.t_h + t_prime;
        let t = I::V::narrow(exact).max(ray.t_min).min(self.t_max);
        End { t, t_low: I::V::narrow(exact - t.widen()) }
    }
}

/// `|v|^2 - 1`.
#[cfg_attr(optimized, inline(always))]
pub(super) fn excess_of_square<I: Isa>(isa: I, v: [I::Double; 3]) -> I::Double {
    v[2].mul_add(v[2], v[1].mul_add(v[1], v[0].mul_add(v[0], isa.splat_double(-1.0))))
}

/// `1/|v|` of nearly unit length, by its series about `|v|^2 - 1 = q = 0`.
#[cfg_attr(optimized, inline(always))]
pub(super) fn one_over_length<I: Isa>(isa: I, q: I::Double) -> I::Double {
    q.mul_add(isa.splat_double(0.273_437_5), isa.splat_double(-0.3125))
        .mul_add(q, isa.splat_double(0.375))
        .mul_add(q * q, q.mul_add(isa.splat_double(-0.5), isa.splat_double(1.0)))
}

/// The part of the ray on the side of the emitter's normal.
#[cfg_attr(optimized, inline(always))]
pub(super) fn locate<I: Isa>(isa: I, ray: &RayLanes<I>, emitter: &EmitterLanes<I>) -> Located<I> {
    let c = |x| isa.splat(x);
    let line = Line::new(isa, ray, emitter.position);
    let n = widen::<I>(emitter.normal);
    let beta_exact = dot(n, line.d) * line.unit;
    let alpha_h = dot(n, line.foot);
    let (t_max, [t_prime_min, t_prime_max]) = (line.t_max, line.t_prime);
    let (ta, tb) = (I::V::narrow(t_prime_min), I::V::narrow(t_prime_max));
    let length = t_max - ray.t_min;

    // The sign of m = n.(x - y) at the ends decides what is lit.
    let has_normal = emitter.has_normal;
    let m_a = I::V::narrow(beta_exact.mul_add(t_prime_min, alpha_h));
    let m_b = I::V::narrow(beta_exact.mul_add(t_prime_max, alpha_h));
    let dark_a = has_normal & m_a.le(c(0.0));
    let dark_b = has_normal & m_b.le(c(0.0));
    let beta = I::V::narrow(beta_exact);
    // A ray so flat against the emitter's plane is not cut there: with one end it is dark as a whole.
    let flat = beta.abs().lt(c(FLATTEST));
    let both = (dark_a & dark_b) | (flat & (dark_a | dark_b));
    let (clip_a, clip_b) = (dark_a & !dark_b, dark_b & !dark_a);

    // Where N = 0: a Newton step after the division, as what is lit may be as short as what it leaves.
    let inv_beta = c(1.0) / beta;
    let near = inv_beta.widen();
    let once = -(alpha_h * reciprocal_near(isa, beta_exact, near));
    let t_prime_n = once - beta_exact.mul_add(once, alpha_h) * near;
    let tn = I::V::narrow(t_prime_n).max(ta).min(tb);
    let lit_length = (m_a.max(m_b) * inv_beta.abs()).min(length);
    let length = I::V::select(both, c(0.0), I::V::select(clip_a | clip_b, lit_length, length));
    let End { t: t_n, t_low: t_n_low } = line.end_at(ray, t_prime_n);

    let lit = Lit {
        a: End { t: I::V::select(clip_a, t_n, ray.t_min), t_low: I::V::only(clip_a, t_n_low) },
        b: End { t: I::V::select(clip_b, t_n, t_max), t_low: I::V::only(clip_b, t_n_low) },
        length,
        valid: emitter.valid & line.valid,
    };
    let cosine = Cosine { m_least: m_a.min(m_b).max(c(0.0)), beta, has_normal };
    let ends = [I::V::select(clip_a, tn, ta), I::V::select(clip_b, tn, tb)];
    (lit, cosine, line.foot(ends, I::V::narrow(alpha_h)))
}
