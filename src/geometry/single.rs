//! The geometry in f32.
//!
//! ```text
//! e = y - o                       q = |d|^2 - 1, and |d| - 1 = q/2 - q^2/8
//! s = e.d, tau = s - q s          f = tau d - e, the foot of the perpendicular but for rho = f.d along d
//! t_h = tau + (tau (|d| - 1) - rho)                      h^2 = f.f - rho^2
//! m(t) = n.(x - y) = beta t - n.e                        beta = n.d / |d|
//! near = t_min - m(t_min)/beta                           t_n = near - m(near)/beta, where N = 0
//! ```
//!
//! `rho` takes up what rounding did to `tau`, so that `h` and `t'` are known to 2^-24 of `h`, not of `t_h`, but for the
//! rounding of `e`. `EXACT` adds
//!
//! - `f` in f64, so that `h` and `t'` are rounded once;
//! - `q`, `beta` and `m` in f64, and a Newton step from `near` to `t_n`: where N = 0 is known to 2^-48 of the distance,
//!   to 2^-40 where `|d|` is 1e-5 off.
//!
//! A lane is hard, and found in f64, where one of these holds; no other lane is asked:
//!
//! - the line passes the emitter closer than 2^-14 of `t_h`, 1e-6 of `t_min`, or 1e-12 m;
//! - `d` or the normal is farther from unit length than 1e-5;
//! - a number is very large, or none;
//! - with `EXACT`, an end of the ray is closer to the emitter's plane than 2^-18 of its distance from the emitter: the sign
//!   of `m` is certain elsewhere.

use super::{Cosine, EmitterLanes, End, Foot, Lit, PLAIN, RayLanes, dot, two_difference, widen};
use crate::simd::{Isa, Lanes, Number, none};

/// What `m` is without a normal: an end is then never dark.
pub(super) const NO_NORMAL: f32 = 1e30;
/// The least `h` of an easy lane, as a share of `t_h` and of `t_min`.
const NEAR: f32 = 1.0 / (1 << 14) as f32;
const NEAR_OF_T_MIN: f32 = 1e-6;
/// And in any case \[m\].
const NEAREST: f32 = 1e-12;
/// The least `|m|` of a lane that is easy for `EXACT` at the ends of the ray, as a share of `|t_h| + h`.
const EDGE: f32 = 1.0 / (1 << 18) as f32;
/// The largest `||d|^2 - 1|` of an easy lane.
pub(super) const UNIT: f32 = 2e-5;
/// The largest `h` of an easy lane \[m\]: for a direction of exactly unit length, and smaller for others.
const WIDEST: f32 = PLAIN * 1e-4;

/// What clipping hands on to the foot.
#[derive(Clone, Copy)]
pub(crate) struct Clipped<I: Isa> {
    pub(crate) lit: Lit<I>,
    q: I::V,
    /// `tau`.
    tau: I::V,
    /// The least `|m|` at the ends of the ray, and `m` at `tau`.
    margin: I::V,
    m_tau: I::V,
}

/// The part of the ray that the emitter faces, and what `m` is at its ends where the `COSINE` is wanted.
#[cfg_attr(optimized, inline(always))]
pub(crate) fn clip<I: Isa, const EXACT: bool, const COSINE: bool>(
    isa: I,
    ray: &RayLanes<I>,
    emitter: &EmitterLanes<I>,
) -> (Clipped<I>, Cosine<I>) {
    let c = |x| isa.splat(x);
    let zero = c(0.0);
    let (d, n) = (ray.direction, emitter.normal);
    let (t_min, t_max) = (ray.t_min, ray.end(isa));

    let (d_64, n_64) = (widen::<I>(d), widen::<I>(n));
    let q = if EXACT {
        let from_one = d_64[0].mul_add(d_64[0], isa.splat_double(-1.0));
        I::V::narrow(d_64[2].mul_add(d_64[2], d_64[1].mul_add(d_64[1], from_one)))
    } else {
        d[2].mul_add(d[2], d[1].mul_add(d[1], d[0].mul_add(d[0], c(-1.0))))
    };
    // |d| - 1, and 1 - 1/|d|.
    let excess = q * q.mul_add(c(-0.125), c(0.5));
    let shrink = (-excess).mul_add(excess, excess);
    let beta_64 = dot(n_64, d_64);
    let n_d = if EXACT { I::V::narrow(beta_64) } else { dot(n, d) };
    let beta_low = -(n_d * shrink);
    let beta = n_d + beta_low;
    // -n.e, or without a normal more than anything.
    let (o, y) = (ray.origin, emitter.position);
    let (o_64, y_64) = (widen::<I>(o), widen::<I>(y));
    let m_0_64 = (o_64[2] - y_64[2]).mul_add(
        n_64[2],
        (o_64[1] - y_64[1]).mul_add(n_64[1], (o_64[0] - y_64[0]).mul_add(n_64[0], emitter.in_plane.widen())),
    );
    let m_0 = if EXACT {
        I::V::narrow(m_0_64)
    } else {
        (o[2] - y[2]).mul_add(n[2], (o[1] - y[1]).mul_add(n[1], (o[0] - y[0]).mul_add(n[0], emitter.in_plane)))
    };
    let (m_min, m_max) = (beta.mul_add(t_min, m_0), beta.mul_add(t_max, m_0));

    let (dark_a, dark_b) = (m_min.le(zero), m_max.le(zero));
    let inv_beta = c(1.0) / beta;
    let near = (-m_min).mul_add(inv_beta, t_min);
    let near = if EXACT { near } else { near.max(t_min).min(t_max) };
    let (mut m_a, mut m_b) = (m_min, m_max);
    let (mut t_n, mut t_n_low) = (near, zero);
    if EXACT {
        let (at_a, at_b) =
            if COSINE { (I::V::select(dark_a, near, t_min), I::V::select(dark_b, near, t_max)) } else { (near, near) };
        m_a = I::V::narrow(beta_64.mul_add(at_a.widen(), m_0_64)) + beta_low * at_a;
        m_b = m_a;
        if COSINE {
            m_b = I::V::narrow(beta_64.mul_add(at_b.widen(), m_0_64)) + beta_low * at_b;
        }
        let rest = -(I::V::select(dark_a, m_a, m_b) * inv_beta);
        t_n = near + rest;
        t_n_low = rest - (t_n - near);
    }
    let (a, b) = (I::V::select(dark_a, t_n, t_min), I::V::select(dark_b, t_n, t_max));
    let (a_low, b_low) = (I::V::only(dark_a, t_n_low), I::V::only(dark_b, t_n_low));
    let length = I::V::only(!(dark_a & dark_b), (b - a) + (b_low - a_low));

    let s = dot([y[0] - o[0], y[1] - o[1], y[2] - o[2]], d);
    let tau = (-q).mul_add(s, s);
    let m_tau = match (COSINE, EXACT) {
        (false, _) => zero,
        (true, false) => beta.mul_add(tau, m_0),
        (true, true) => I::V::narrow(beta_64.mul_add(tau.widen(), m_0_64)) + beta_low * tau,
    };
    let lit = Lit { a: End { t: a, t_low: a_low }, b: End { t: b, t_low: b_low }, length };
    let margin = m_min.abs().min(m_max.abs());
    let (m_a, m_b) = (I::V::only(!dark_a, m_a), I::V::only(!dark_b, m_b));
    (Clipped { lit, q, tau, margin, m_tau }, Cosine { m_a, m_b, beta, has_normal: emitter.has_normal })
}

/// The foot of the perpendicular; with `alpha_h` where the `COSINE` is wanted. A lane that is hard is not valid here.
#[cfg_attr(optimized, inline(always))]
pub(crate) fn find_foot<I: Isa, const EXACT: bool, const COSINE: bool>(
    isa: I,
    ray: &RayLanes<I>,
    emitter: &EmitterLanes<I>,
    clipped: &Clipped<I>,
    beta: I::V,
) -> Foot<I> {
    let c = |x| isa.splat(x);
    let zero = c(0.0);
    let (d, t_min) = (ray.direction, ray.t_min);
    let Clipped { lit: Lit { a, b, .. }, q, tau, margin, m_tau } = *clipped;

    let (o, y) = (ray.origin, emitter.position);
    let (rho, h_squared, h_squared_low);
    if EXACT {
        let (o, d, y, tau) = (widen::<I>(o), widen::<I>(d), widen::<I>(y), tau.widen());
        let f = [tau.mul_add(d[0], o[0] - y[0]), tau.mul_add(d[1], o[1] - y[1]), tau.mul_add(d[2], o[2] - y[2])];
        let exact_rho = dot(f, d);
        let exact = (-exact_rho).mul_add(exact_rho, dot(f, f));
        (rho, h_squared) = (I::V::narrow(exact_rho), I::V::narrow(exact));
        h_squared_low = I::V::narrow(exact - h_squared.widen());
    } else {
        let f = [tau.mul_add(d[0], o[0] - y[0]), tau.mul_add(d[1], o[1] - y[1]), tau.mul_add(d[2], o[2] - y[2])];
        rho = dot(f, d);
        (h_squared, h_squared_low) = ((-rho).mul_add(rho, dot(f, f)), zero);
    }
    let tau_low = tau.mul_add(q * q.mul_add(c(-0.125), c(0.5)), -rho);
    let ([from_a, left_a], [from_b, left_b]) = (two_difference(a.t, tau), two_difference(b.t, tau));
    let (t_prime_a, t_prime_b) = if EXACT {
        (from_a + (left_a + (a.t_low - tau_low)), from_b + (left_b + (b.t_low - tau_low)))
    } else {
        (from_a - tau_low, from_b - tau_low)
    };
    let alpha_h = if COSINE { I::V::only(emitter.has_normal, beta.mul_add(tau_low, m_tau)) } else { zero };

    let (h, distance) = (h_squared.sqrt(), tau.abs());
    let mut easy = emitter.plain
        & zero.le(t_min)
        & t_min.le(ray.t_max)
        & t_min.mul_add(c(NEAR_OF_T_MIN), distance.mul_add(c(NEAR), c(NEAREST))).le(h)
        & h.mul_add(c(UNIT / WIDEST), q.abs()).le(c(UNIT));
    if EXACT {
        easy = easy & ((distance + h) * c(EDGE)).le(margin);
    }
    Foot { h, h_squared, h_squared_low, t_h: tau, t_h_low: tau_low, a: t_prime_a, b: t_prime_b, alpha_h, valid: easy }
}

/// Records of which all lanes are hard.
#[cfg_attr(optimized, inline(always))]
pub(crate) fn unknown<I: Isa>(isa: I) -> (Clipped<I>, Foot<I>) {
    let (zero, none) = (isa.splat(0.0), none(isa));
    let end = End { t: zero, t_low: zero };
    let foot = Foot {
        h: zero,
        h_squared: zero,
        h_squared_low: zero,
        t_h: zero,
        t_h_low: zero,
        a: zero,
        b: zero,
        alpha_h: zero,
        valid: none,
    };
    (Clipped { lit: Lit { a: end, b: end, length: zero }, q: zero, tau: zero, margin: zero, m_tau: zero }, foot)
}
