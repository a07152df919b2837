//! The geometry of emitters that are no spots, in f32.
//!
//! Equations of `docs/mathematics.md`, section 2.3:
//!
//! ```text
//! e = y - o,   q = |d|^2 - 1,   |d| - 1 = q/2                              (2.10)
//! s = e.d,   tau = s - q s,   f = tau d - e,   rho = f.d                   (2.11)
//! t_h = tau + (tau (|d| - 1) - rho),   h^2 = f.f - rho^2                   (2.12)
//! m(t) = beta t - n.e,   beta = n.d/|d|,   alpha h = n.f - beta rho        (2.13)
//! near = t_min - m(t_min)/beta,   t_n = near - m(near)/beta, where m = 0   (2.14)
//! ```
//!
//! (2.10) leaves out `q^2/8`, at most 2^-40 with `EXACT`. `rho` is what rounding did to `tau`, so that `h` and `t'` have an error
//! of 2^-24 of `h`, not of `t_h`, besides that of the rounding of `e`.
//!
//! Departures from f32, and why:
//!
//! 1. `EXACT` takes `e` with the remainder of its rounding: `h` then has an error of a few 2^-24 of itself, and `t'` one of `h` or
//!    `t'`, whichever is larger.
//! 2. `EXACT` computes `q`, `n.d`, `n.e`, `m` at `t_n` and `n.f` in f64: `t_n` then has an error of 2^-45 of the distance, and
//!    `alpha` has all digits where the emitter is seen edge-on. It takes `n.d` for `beta` in the signs of `m` at the ends, and in
//!    `near`.
//! 3. Without `EXACT`, `t_n` is `near`, by a division: a subnormal slope has no reciprocal.
//! 4. A lane is hard, and is computed in f64 (`double`), if one of these holds. No other lane changes this.
//!    - `d` is farther from unit length than 1e-5, with `EXACT` 1e-6; or the normal farther than 1e-5;
//!    - a number is very large, or NaN;
//!    - with `EXACT`, an end of the ray is closer to the emitter's plane than 2^-18 of `|t_h| + h`: elsewhere the sign of `m` is
//!      certain;
//!    - where the foot is needed, the line passes the emitter closer than 2^-14 of `t_h`, 1e-6 of `t_min`, or 1e-12 m.

use super::{Cosine, EmitterLanes, Foot, Lit, Located, PLAIN, RayLanes, Rests, dot, two_difference, widen};
use crate::simd::{Isa, Lanes, Number};

/// The `m` of an emitter without a normal: an end is then never dark.
pub(super) const NO_NORMAL: f32 = 1e30;
/// The least `h` of an easy lane, as a share of `t_h`, as a share of `t_min`, and in any case \[m\].
const NEAR: f32 = 1.0 / (1 << 14) as f32;
const NEAR_OF_T_MIN: f32 = 1e-6;
const NEAREST: f32 = 1e-12;
/// The least `|m|` at the ends of the ray of a lane that is easy for `EXACT`, as a share of the emitter's distance, and in any case
/// \[m\]. A lit interval is then longer than one that counts as none.
const EDGE: f32 = 1.0 / (1 << 18) as f32;
const EDGE_LEAST: f32 = 1e-17;
/// The largest `||d|^2 - 1|` of an easy lane, and of one that is easy for `EXACT`.
pub(super) const UNIT: f32 = 2e-5;
const UNIT_EXACT: f32 = 2e-6;
/// The largest `h` of an easy lane \[m\], for a direction of exactly unit length; for other directions it is smaller. `|t_h|` is at
/// most `h/NEAR`. Where the foot is not needed, it bounds the distance along the axes.
const WIDEST: f32 = PLAIN * 1e-4;

/// The lit interval, with the foot of the perpendicular if `FOOT` is set, and the emitter's cosine if `COSINE` is. Without `FOOT`
/// the interval is the whole ray if any of it is lit. Lanes that are valid are easy.
#[cfg_attr(optimized, inline(always))]
pub(crate) fn locate<I: Isa, const EXACT: bool, const FOOT: bool, const COSINE: bool>(
    isa: I,
    ray: &RayLanes<I>,
    emitter: &EmitterLanes<I>,
) -> Located<I> {
    let c = |x| isa.splat(x);
    let zero = c(0.0);
    let (o, d, y, n) = (ray.origin, ray.direction, emitter.position, emitter.normal);
    let (t_min, t_max) = (ray.t_min, ray.end(isa));
    let (o_64, d_64, y_64, n_64) = (widen::<I>(o), widen::<I>(d), widen::<I>(y), widen::<I>(n));

    // (2.10)
    let (q, unit) = if EXACT {
        let from_one = d_64[0].mul_add(d_64[0], isa.splat_double(-1.0));
        (I::V::narrow(d_64[2].mul_add(d_64[2], d_64[1].mul_add(d_64[1], from_one))), UNIT_EXACT)
    } else {
        (d[2].mul_add(d[2], d[1].mul_add(d[1], d[0].mul_add(d[0], c(-1.0)))), UNIT)
    };
    // |d| - 1, and 1 - 1/|d|.
    let (excess, shrink) = (q * c(0.5), q * q.mul_add(c(-0.375), c(0.5)));
    let [[e_x, low_x], [e_y, low_y], [e_z, low_z]] =
        [two_difference(y[0], o[0]), two_difference(y[1], o[1]), two_difference(y[2], o[2])];
    let e = [e_x, e_y, e_z];

    // (2.13)
    let beta_64 = dot(n_64, d_64);
    let n_d = if EXACT { I::V::narrow(beta_64) } else { dot(n, d) };
    let beta = (-n_d).mul_add(shrink, n_d);
    // -n.e; without a normal larger than any m.
    let m_0_64 = (o_64[2] - y_64[2]).mul_add(
        n_64[2],
        (o_64[1] - y_64[1]).mul_add(n_64[1], (o_64[0] - y_64[0]).mul_add(n_64[0], emitter.in_plane.widen())),
    );
    let m_0 = if EXACT {
        I::V::narrow(m_0_64)
    } else {
        (-e[2]).mul_add(n[2], (-e[1]).mul_add(n[1], (-e[0]).mul_add(n[0], emitter.in_plane)))
    };
    let slope = if EXACT { n_d } else { beta };
    let (m_min, m_max) = (slope.mul_add(t_min, m_0), slope.mul_add(t_max, m_0));
    let (dark_a, dark_b) = (m_min.le(zero), m_max.le(zero));
    let least_m = m_min.abs().min(m_max.abs());
    let in_order = emitter.plain & zero.le(t_min) & t_min.le(t_max);
    if !FOOT {
        let away = e[0].abs() + e[1].abs() + e[2].abs();
        let easy = in_order
            & away.mul_add(c(unit / WIDEST), q.abs()).le(c(unit))
            & away.mul_add(c(EDGE), c(EDGE_LEAST)).le(least_m);
        return Located::of(
            isa,
            Lit { a: t_min, b: t_max, length: I::V::only(!(dark_a & dark_b), t_max - t_min) },
            easy,
        );
    }

    // (2.14)
    let dark = dark_a | dark_b;
    let (m_least, t_n, t_n_low);
    if EXACT {
        let inv_beta = c(1.0) / n_d;
        let near = (-m_min).mul_add(inv_beta, t_min);
        // At m = 0, or at the end where m is smaller.
        let mut at = near;
        if COSINE {
            at = I::V::select(dark, near, I::V::select(zero.le(beta), t_min, t_max));
        }
        let m = (-(n_d * shrink)).mul_add(at, I::V::narrow(beta_64.mul_add(at.widen(), m_0_64)));
        m_least = I::V::only(!dark, m);
        t_n = (-m).mul_add(inv_beta, near);
        t_n_low = (-m).mul_add(inv_beta, near - t_n);
    } else {
        m_least = m_min.min(m_max).max(zero);
        t_n = (t_min - m_min / beta).max(t_min).min(t_max);
        t_n_low = zero;
    }

    // (2.11)
    let s = dot(e, d);
    let tau = (-q).mul_add(s, s);
    let mut f = [tau.mul_add(d[0], -e[0]), tau.mul_add(d[1], -e[1]), tau.mul_add(d[2], -e[2])];
    if EXACT {
        f = [f[0] - low_x, f[1] - low_y, f[2] - low_z];
    }
    let rho = dot(f, d);
    // (2.12): t_h = tau + tau_low
    let tau_low = tau.mul_add(excess, -rho);
    let h_squared = (-rho).mul_add(rho, dot(f, f));
    let h = h_squared.sqrt();

    // Both are t_n, and the length is 0, or NaN without a slope, where both ends are dark.
    let (a, b) = (I::V::select(dark_a, t_n, t_min), I::V::select(dark_b, t_n, t_max));
    let (rests, length, t_prime_a, t_prime_b);
    if EXACT {
        rests = Rests { a: I::V::only(dark_a, t_n_low), b: I::V::only(dark_b, t_n_low) };
        length = (b - a) + (rests.b - rests.a);
        let ([from_a, left_a], [from_b, left_b]) = (two_difference(a, tau), two_difference(b, tau));
        (t_prime_a, t_prime_b) = (from_a + (left_a + (rests.a - tau_low)), from_b + (left_b + (rests.b - tau_low)));
    } else {
        (rests, length) = (Rests::none(isa), b - a);
        (t_prime_a, t_prime_b) = ((a - tau) - tau_low, (b - tau) - tau_low);
    }
    let mut alpha_h = zero;
    if COSINE {
        // n.f, which is m at tau.
        let m_f = if EXACT { I::V::narrow(beta_64.mul_add(tau.widen(), m_0_64)) } else { dot(n, f) };
        alpha_h = I::V::only(emitter.has_normal, (-rho).mul_add(beta, m_f));
    }

    let away = tau.abs();
    let mut easy = in_order
        & t_min.mul_add(c(NEAR_OF_T_MIN), away.mul_add(c(NEAR), c(NEAREST))).le(h)
        & h.mul_add(c(unit / WIDEST), q.abs()).le(c(unit));
    if EXACT {
        easy = easy & away.mul_add(c(EDGE), h.mul_add(c(EDGE), c(EDGE_LEAST))).le(least_m);
    }
    Located {
        lit: Lit { a, b, length },
        rests,
        cosine: Cosine { m_least, beta, has_normal: emitter.has_normal },
        foot: Foot { h, h_squared, t_h: tau, t_h_low: tau_low, a: t_prime_a, b: t_prime_b },
        alpha_h,
        valid: easy,
    }
}
