//! The geometry of emitters that are no spots, in f32.
//!
//! Equations of `docs/mathematics.md`, section 2.3:
//!
//! ```text
//! e = y - o,   q = |d|^2 - 1,   |d| - 1 = q/2 - q^2/8                      (2.10)
//! s = e.d,   tau = s - 2 (|d| - 1) s,   f = tau d - e,   rho = f.d         (2.11)
//! t_h = tau + (tau (|d| - 1) - rho),   h^2 = f.f - rho^2                   (2.12)
//! m(t) = beta t - n.e,   beta = n.d/|d|,   alpha h = n.f - beta rho        (2.13)
//! near = t_min - m(t_min)/beta,   t_n = near - m(near)/beta, where m = 0   (2.14)
//! ```
//!
//! `rho` is what rounding did to `tau`, so that `h` and `t'` have an error of 2^-24 of `h`, not of `t_h`, besides that of the
//! rounding of `e`.
//!
//! Departures from f32, and why:
//!
//! 1. `EXACT` computes `f` in f64: `h` and `t'` are then rounded once.
//! 2. `EXACT` computes `q`, `beta` and `m` in f64, and the Newton step from `near` to `t_n`: the place of `m` = 0 then has an error
//!    of 2^-45 of the distance, of 2^-39 where `|d|` is 1e-5 off.
//! 3. Without `EXACT`, `t_n` is `near`, by a division: a subnormal slope has no reciprocal.
//! 4. A lane is hard, and is computed in f64 (`double`), if one of these holds. No other lane changes this.
//!    - `d` or the normal is farther from unit length than 1e-5;
//!    - a number is very large, or NaN;
//!    - with `EXACT`, an end of the ray is closer to the emitter's plane than 2^-18 of `|e_x| + |e_y| + |e_z|`: elsewhere the
//!      sign of `m` is certain;
//!    - where the foot is needed, the line passes the emitter closer than 2^-14 of `t_h`, 1e-6 of `t_min`, or 1e-12 m.

use super::{Cosine, EmitterLanes, Foot, Lit, PLAIN, RayLanes, Rests, dot, two_difference, widen};
use crate::simd::{Isa, Lanes, Number};

/// The `m` of an emitter without a normal: an end is then never dark.
pub(super) const NO_NORMAL: f32 = 1e30;
/// The least `h` of an easy lane, as a share of `t_h`, as a share of `t_min`, and in any case \[m\].
const NEAR: f32 = 1.0 / (1 << 14) as f32;
const NEAR_OF_T_MIN: f32 = 1e-6;
const NEAREST: f32 = 1e-12;
/// The least `|m|` at the ends of the ray of a lane that is easy for `EXACT`, as a share of the emitter's distance along the axes,
/// and in any case \[m\]. A lit interval is then longer than one that counts as none.
const EDGE: f32 = 1.0 / (1 << 18) as f32;
const EDGE_LEAST: f32 = 1e-17;
/// The largest `||d|^2 - 1|` of an easy lane.
pub(super) const UNIT: f32 = 2e-5;
/// The largest distance of the emitter of an easy lane \[m\], for a direction of exactly unit length; for other directions it is
/// smaller. `EXACT` bounds the distance along the axes. Without it `h` is bounded; `|t_h|` is then at most `h/NEAR`.
const WIDEST: f32 = PLAIN * 1e-4;

/// What [`clip`] finds.
pub(crate) struct Clipped<I: Isa> {
    pub(crate) lit: Lit<I>,
    /// 0 without `EXACT`.
    pub(crate) rests: Rests<I>,
    /// `|d| - 1`, for [`find_foot`].
    pub(crate) excess: I::V,
    /// `|d|^2 - 1`, for [`find_foot`] without `EXACT`.
    pub(crate) q: I::V,
    pub(crate) cosine: Cosine<I>,
    /// Which lanes are easy as far as known.
    pub(crate) easy: I::Mask,
}

/// The lit interval, with `m` at its ends if `COSINE` is set. Without `FOOT` it is the whole ray if any of it is lit.
#[cfg_attr(optimized, inline(always))]
pub(crate) fn clip<I: Isa, const EXACT: bool, const FOOT: bool, const COSINE: bool>(
    isa: I,
    ray: &RayLanes<I>,
    emitter: &EmitterLanes<I>,
) -> Clipped<I> {
    let c = |x| isa.splat(x);
    let zero = c(0.0);
    let (d, n) = (ray.direction, emitter.normal);
    let (t_min, t_max) = (ray.t_min, ray.end(isa));

    // (2.10)
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
    // (2.13)
    let beta_64 = dot(n_64, d_64);
    let n_d = if EXACT { I::V::narrow(beta_64) } else { dot(n, d) };
    let beta_low = -(n_d * shrink);
    let beta = if EXACT { n_d + beta_low } else { (-n_d).mul_add(shrink, n_d) };
    // -n.e; without a normal larger than any m.
    let (o, y) = (ray.origin, emitter.position);
    let (o_64, y_64) = (widen::<I>(o), widen::<I>(y));
    let m_0_64 = (o_64[2] - y_64[2]).mul_add(
        n_64[2],
        (o_64[1] - y_64[1]).mul_add(n_64[1], (o_64[0] - y_64[0]).mul_add(n_64[0], emitter.in_plane.widen())),
    );
    let e = [y[0] - o[0], y[1] - o[1], y[2] - o[2]];
    let m_0 = if EXACT {
        I::V::narrow(m_0_64)
    } else {
        (-e[2]).mul_add(n[2], (-e[1]).mul_add(n[1], (-e[0]).mul_add(n[0], emitter.in_plane)))
    };
    let (m_min, m_max) = (beta.mul_add(t_min, m_0), beta.mul_add(t_max, m_0));
    let (dark_a, dark_b) = (m_min.le(zero), m_max.le(zero));

    let mut easy = emitter.plain & zero.le(t_min) & t_min.le(t_max);
    if EXACT {
        let away = e[0].abs() + e[1].abs() + e[2].abs();
        easy = easy
            & away.mul_add(c(UNIT / WIDEST), q.abs()).le(c(UNIT))
            & away.mul_add(c(EDGE), c(EDGE_LEAST)).le(m_min.abs().min(m_max.abs()));
    }
    let mut rests = Rests::none(isa);
    if !FOOT {
        let lit = Lit { a: t_min, b: t_max, length: I::V::only(!(dark_a & dark_b), t_max - t_min) };
        return Clipped { lit, rests, excess, q, cosine: Cosine::none(isa), easy };
    }

    // (2.14)
    let dark = dark_a | dark_b;
    let (m_least, t_n, t_n_low);
    if EXACT {
        let inv_beta = c(1.0) / beta;
        let near = (-m_min).mul_add(inv_beta, t_min);
        // At m = 0, or at the end where m is smaller.
        let mut at = near;
        if COSINE {
            at = I::V::select(dark, near, I::V::select(zero.le(beta), t_min, t_max));
        }
        let m = I::V::narrow(beta_64.mul_add(at.widen(), m_0_64)) + beta_low * at;
        m_least = I::V::only(!dark, m);
        let rest = -(m * inv_beta);
        t_n = near + rest;
        t_n_low = rest - (t_n - near);
    } else {
        m_least = m_min.min(m_max).max(zero);
        t_n = (t_min - m_min / beta).max(t_min).min(t_max);
        t_n_low = zero;
    }
    // Both are t_n, and the length is 0, where both ends are dark.
    let (a, b) = (I::V::select(dark_a, t_n, t_min), I::V::select(dark_b, t_n, t_max));
    let mut length = b - a;
    if EXACT {
        rests = Rests { a: I::V::only(dark_a, t_n_low), b: I::V::only(dark_b, t_n_low), ..rests };
        length = I::V::only(!(dark_a & dark_b), length + (rests.b - rests.a));
    }
    let cosine = Cosine { m_least, beta, has_normal: emitter.has_normal };
    Clipped { lit: Lit { a, b, length }, rests, excess, q, cosine, easy }
}

/// What [`find_foot`] finds.
pub(crate) struct FoundFoot<I: Isa> {
    pub(crate) foot: Foot<I>,
    /// The remainder of `h^2`; 0 without `EXACT`.
    pub(crate) h_squared_rest: I::V,
    /// 0 without `COSINE`.
    pub(crate) alpha_h: I::V,
    /// Which lanes are easy.
    pub(crate) easy: I::Mask,
}

/// The foot of the perpendicular, with `alpha_h` if `COSINE` is set.
#[cfg_attr(optimized, inline(always))]
pub(crate) fn find_foot<I: Isa, const EXACT: bool, const COSINE: bool>(
    isa: I,
    ray: &RayLanes<I>,
    emitter: &EmitterLanes<I>,
    clipped: &Clipped<I>,
) -> FoundFoot<I> {
    let c = |x| isa.splat(x);
    let zero = c(0.0);
    let (d, t_min) = (ray.direction, ray.t_min);
    let Clipped { lit: Lit { a, b, .. }, rests, excess, q, cosine, easy } = clipped;
    let excess = *excess;

    // (2.11)
    let (o, y, n) = (ray.origin, emitter.position, emitter.normal);
    let e = [y[0] - o[0], y[1] - o[1], y[2] - o[2]];
    let s = dot(e, d);
    let tau = (-excess).mul_add(s + s, s);
    // m_f = n.f
    let (rho, h_squared, h_squared_rest, m_f);
    if EXACT {
        let (o, d, y, n, tau) = (widen::<I>(o), widen::<I>(d), widen::<I>(y), widen::<I>(n), tau.widen());
        let f = [tau.mul_add(d[0], o[0] - y[0]), tau.mul_add(d[1], o[1] - y[1]), tau.mul_add(d[2], o[2] - y[2])];
        let exact_rho = dot(f, d);
        let exact = (-exact_rho).mul_add(exact_rho, dot(f, f));
        (rho, h_squared) = (I::V::narrow(exact_rho), I::V::narrow(exact));
        h_squared_rest = I::V::narrow(exact - h_squared.widen());
        m_f = if COSINE { I::V::narrow(dot(n, f)) } else { zero };
    } else {
        let f = [tau.mul_add(d[0], -e[0]), tau.mul_add(d[1], -e[1]), tau.mul_add(d[2], -e[2])];
        rho = dot(f, d);
        (h_squared, h_squared_rest, m_f) = ((-rho).mul_add(rho, dot(f, f)), zero, dot(n, f));
    }
    // (2.12): t_h = tau + tau_low
    let tau_low = tau.mul_add(excess, -rho);
    let (t_prime_a, t_prime_b) = if EXACT {
        let ([from_a, left_a], [from_b, left_b]) = (two_difference(*a, tau), two_difference(*b, tau));
        (from_a + (left_a + (rests.a - tau_low)), from_b + (left_b + (rests.b - tau_low)))
    } else {
        ((*a - tau) - tau_low, (*b - tau) - tau_low)
    };
    // (2.13)
    let alpha_h = if COSINE { I::V::only(cosine.has_normal, (-rho).mul_add(cosine.beta, m_f)) } else { zero };

    let h = h_squared.sqrt();
    let least = t_min.mul_add(c(NEAR_OF_T_MIN), tau.abs().mul_add(c(NEAR), c(NEAREST)));
    let mut easy = *easy & least.le(h);
    if !EXACT {
        easy = easy & h.mul_add(c(UNIT / WIDEST), q.abs()).le(c(UNIT));
    }
    let foot = Foot { h, h_squared, t_h: tau, t_h_low: tau_low, a: t_prime_a, b: t_prime_b };
    FoundFoot { foot, h_squared_rest, alpha_h, easy }
}
