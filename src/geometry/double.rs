//! The geometry in double precision, rounded once: for every ray and emitter.

use super::{Cosine, EmitterLanes, End, Foot, Lit, Located, RayLanes, TOLERANCE, dot, largest, widen};
use crate::scene::FARTHEST;
use crate::simd::math::reciprocal_near;
use crate::simd::{Double, Isa, Lanes, Number};

/// Sine of the least angle between a ray and the emitter's plane of which it is known where they meet.
const FLATTEST: f32 = 1e-30;

#[cfg_attr(optimized, inline(always))]
pub(super) fn locate<I: Isa>(isa: I, ray: &RayLanes<I>, emitter: &EmitterLanes<I>) -> Located<I> {
    let c = |x| isa.splat(x);
    let (d, o) = (widen::<I>(ray.direction), widen::<I>(ray.origin));
    let (y, n) = (widen::<I>(emitter.position), widen::<I>(emitter.normal));
    let e = [y[0] - o[0], y[1] - o[1], y[2] - o[2]];

    // 1/|d| by its series about |d| = 1: distances are in metres also where d is not quite a unit vector.
    let q = d[2].mul_add(d[2], d[1].mul_add(d[1], d[0].mul_add(d[0], isa.splat_double(-1.0))));
    let unit = q
        .mul_add(isa.splat_double(0.273_437_5), isa.splat_double(-0.3125))
        .mul_add(q, isa.splat_double(0.375))
        .mul_add(q * q, q.mul_add(isa.splat_double(-0.5), isa.splat_double(1.0)));
    let t_h = dot(e, d) * unit;
    let beta_exact = dot(n, d) * unit;
    let along = t_h * unit;
    let foot = [along.mul_add(d[0], -e[0]), along.mul_add(d[1], -e[1]), along.mul_add(d[2], -e[2])];
    let alpha_h = dot(n, foot);

    let t_max = ray.end(isa);
    let t_prime_min = ray.t_min.widen() - t_h;
    let t_prime_max = t_max.widen() - t_h;
    let (ta, tb) = (I::V::narrow(t_prime_min), I::V::narrow(t_prime_max));
    // The least h that f64 tells from none at this distance.
    let least_h = (ta.abs().max((ray.t_min - ta).abs()) * c(1e-9)).max(c(1e-18));
    let foot_squared = dot(foot, foot);
    let size_squared = I::V::narrow(foot_squared);
    let least = least_h.widen();
    let exact_h_squared = foot_squared.max(least * least);
    let h_squared = (least_h * least_h).max(size_squared);
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
    let exact_t_n = t_h + t_prime_n;
    let t_n = I::V::narrow(exact_t_n).max(ray.t_min).min(t_max);
    let t_n_low = I::V::narrow(exact_t_n - t_n.widen());

    let valid = emitter.valid
        & I::V::narrow(q).abs().le(c(TOLERANCE))
        & largest::<I>(ray.origin).le(c(FARTHEST))
        & c(0.0).le(ray.t_min)
        & ray.t_min.le(c(FARTHEST))
        & ray.t_min.le(ray.t_max)
        // No number where one of the coordinates is none.
        & size_squared.le(c(16.0 * FARTHEST * FARTHEST));
    let lit = Lit {
        a: End { t: I::V::select(clip_a, t_n, ray.t_min), t_low: I::V::only(clip_a, t_n_low) },
        b: End { t: I::V::select(clip_b, t_n, t_max), t_low: I::V::only(clip_b, t_n_low) },
        length,
        valid,
    };
    let cosine = Cosine { m_least: m_a.min(m_b).max(c(0.0)), beta, has_normal };
    let t_h_high = I::V::narrow(t_h);
    let foot = Foot {
        h: h_squared.sqrt(),
        h_squared,
        h_squared_low: I::V::narrow(exact_h_squared - h_squared.widen()),
        t_h: t_h_high,
        t_h_low: I::V::narrow(t_h - t_h_high.widen()),
        a: I::V::select(clip_a, tn, ta),
        b: I::V::select(clip_b, tn, tb),
        alpha_h: I::V::narrow(alpha_h),
    };
    (lit, cosine, foot)
}
