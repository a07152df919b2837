//! The equations of the supplement "Practical product sampling for single scattering in media" (Villeneuve, Gruson,
//! Georgiev, Nowrouzezahrai, 2021) in f64, under its numbers and with its misprints corrected.
//!
//! The misprints are `mu_n` for `mu_t` in (11); 15 for 15/2 in (15); a missing square root in (20); the second polynomial of (22),
//! whose factors are `(beta, -alpha)`; and the sign of the `l` terms after the first in (24)-(28). Section 4.3 of
//! [mathematics](crate::guide::mathematics#43-misprints-of-the-supplement) lists them with their tests.

use std::f64::consts::PI;

/// A polynomial of order 6, its constant first.
pub type Polynomial = [f64; 7];

/// The polynomial's value at `x`.
#[must_use]
pub fn horner(p: &Polynomial, x: f64) -> f64 {
    p.iter().rev().fold(0.0, |sum, c| sum * x + c)
}

/// `first * ratio^n` for n = 0..=6, the form that both `u_n` and `v_n` have.
#[must_use]
pub fn geometric(first: f64, ratio: f64) -> Polynomial {
    let mut terms = [first; 7];
    for n in 1..7 {
        terms[n] = terms[n - 1] * ratio;
    }
    terms
}

/// (3) The transmittance from the emitter to the ray and along it from `t = 0`, at the angle `theta` \[rad\].
///
/// `mu_t` \[1/m\], `h` and `t_h` \[m\].
#[must_use]
pub fn transmittance(mu_t: f64, h: f64, t_h: f64, theta: f64) -> f64 {
    (-mu_t * (t_h + h * (theta.tan() + 1.0 / theta.cos()))).exp()
}

/// (11) `u_n = mu_t^n h^n Q_T0`, with (4) `Q_T0 = exp(-mu_t (t_h + h))`.
///
/// `mu_t` \[1/m\], `h` and `t_h` \[m\].
#[must_use]
pub fn u(mu_t: f64, h: f64, t_h: f64) -> Polynomial {
    geometric((-mu_t * (t_h + h)).exp(), mu_t * h)
}

/// (4)-(10) `Q_T0` to `Q_T6`, the Taylor coefficients of the transmittance (3) about `theta` = 0, from [`u`].
#[must_use]
pub fn transmittance_taylor(u: &Polynomial) -> Polynomial {
    let [u0, u1, u2, u3, u4, u5, u6] = *u;
    [
        u0,                                                                                                    // (4)
        -u1,                                                                                                   // (5)
        (u2 - u1) / 2.0,                                                                                       // (6)
        -u3 / 6.0 + u2 / 2.0 - u1 / 3.0,                                                                       // (7)
        u4 / 24.0 - u3 / 4.0 + 11.0 / 24.0 * u2 - 5.0 / 24.0 * u1,                                             // (8)
        -u5 / 120.0 + u4 / 12.0 - 7.0 / 24.0 * u3 + 3.0 / 8.0 * u2 - 2.0 / 15.0 * u1,                          // (9)
        u6 / 720.0 - u5 / 48.0 + 17.0 / 144.0 * u4 - 7.0 / 24.0 * u3 + 211.0 / 720.0 * u2 - 61.0 / 720.0 * u1, // (10)
    ]
}

/// (12) The phase function of Henyey and Greenstein \[1/sr\] at the angle `theta` \[rad\].
#[must_use]
pub fn phase(g: f64, theta: f64) -> f64 {
    (1.0 - g * g) / (4.0 * PI * (1.0 + g * g + 2.0 * g * theta.sin()).powf(1.5))
}

/// (20) `v_n = (1-g^2) g^n / (4 pi (1+g^2)^((2n+3)/2))`.
#[must_use]
pub fn v(g: f64) -> Polynomial {
    let s = 1.0 + g * g;
    geometric((1.0 - g * g) / (4.0 * PI * s.powf(1.5)), g / s)
}

/// (13)-(19) `Q_rho0` to `Q_rho6`, the Taylor coefficients of the phase function (12) about `theta` = 0, from [`v`].
#[must_use]
pub fn phase_taylor(v: &Polynomial) -> Polynomial {
    let [v0, v1, v2, v3, v4, v5, v6] = *v;
    [
        v0,                                               // (13)
        -3.0 * v1,                                        // (14)
        15.0 / 2.0 * v2,                                  // (15)
        -35.0 / 2.0 * v3 + v1 / 2.0,                      // (16)
        315.0 / 8.0 * v4 - 5.0 / 2.0 * v2,                // (17)
        -693.0 / 8.0 * v5 + 35.0 / 4.0 * v3 - v1 / 40.0,  // (18)
        3003.0 / 16.0 * v6 - 105.0 / 4.0 * v4 + v2 / 3.0, // (19)
    ]
}

/// (21) The polynomial `f` times the emitter's cosine, `f(theta) (alpha cos theta + beta sin theta)`.
#[must_use]
pub fn product(f: &Polynomial, alpha: f64, beta: f64, theta: f64) -> f64 {
    horner(f, theta) * (alpha * theta.cos() + beta * theta.sin())
}

/// (22) An antiderivative of [`product`], with the polynomials (23).
#[must_use]
pub fn antiderivative(f: &Polynomial, alpha: f64, beta: f64, theta: f64) -> f64 {
    let [q_cos, q_sin] = coefficients(f, alpha, beta);
    horner(&q_cos, theta) * theta.cos() + horner(&q_sin, theta) * theta.sin()
}

/// The polynomials of (22): `Q^{alpha, beta}` of the cosine and `Q^{beta, -alpha}` of the sine.
#[must_use]
pub fn coefficients(f: &Polynomial, alpha: f64, beta: f64) -> [Polynomial; 2] {
    [q(f, alpha, beta), q(f, beta, -alpha)]
}

/// (24)-(30) `Q^{k,l}_0` to `Q^{k,l}_6` for the polynomial `f`.
#[must_use]
pub fn q(f: &Polynomial, k: f64, l: f64) -> Polynomial {
    let [f0, f1, f2, f3, f4, f5, f6] = *f;
    [
        -l * f0 + k * f1 + 2.0 * l * (f2 - 12.0 * f4 + 360.0 * f6) - 6.0 * k * (f3 - 20.0 * f5), // (24)
        -l * f1 + 2.0 * k * f2 + 6.0 * l * (f3 - 20.0 * f5) - 24.0 * k * (f4 - 30.0 * f6),       // (25)
        -l * f2 + 3.0 * k * f3 + 12.0 * l * (f4 - 30.0 * f6) - 60.0 * k * f5,                    // (26)
        -l * f3 + 4.0 * k * f4 + 20.0 * l * f5 - 120.0 * k * f6,                                 // (27)
        -l * f4 + 5.0 * k * f5 + 30.0 * l * f6,                                                  // (28)
        -l * f5 + 6.0 * k * f6,                                                                  // (29)
        -l * f6,                                                                                 // (30)
    ]
}

/// [`coefficients`] by a recurrence from the top degree down, which follows from comparing powers of theta in
/// `(b cos + a sin)' = f (alpha cos + beta sin)`.
#[must_use]
pub fn coefficients_by_recurrence(f: &Polynomial, alpha: f64, beta: f64) -> [Polynomial; 2] {
    let above = |p: &Polynomial, n: usize| p.get(n).copied().unwrap_or(0.0);
    let (mut q_cos, mut q_sin) = ([0.0; 7], [0.0; 7]);
    for n in (0..7).rev() {
        let (n1, n2) = (n as f64 + 1.0, n as f64 + 2.0);
        q_sin[n] = alpha * f[n] + beta * n1 * above(f, n + 1) - n2 * n1 * above(&q_sin, n + 2);
        q_cos[n] = n1 * above(&q_sin, n + 1) - beta * f[n];
    }
    [q_cos, q_sin]
}

/// The angle \[rad\] up to which the published code trusts the polynomial (4)-(10), for `m = mu_t h`.
#[must_use]
pub fn transmittance_clamp(m: f64) -> f64 {
    (0.210824 - 0.15974 * m).exp()
}

/// The angle \[rad\] up to which the published code trusts the polynomial (13)-(19), for `g >= 0`.
#[must_use]
pub fn phase_clamp(g: f64) -> f64 {
    18.8217 + g * (-93.8831 + g * (184.173 + g * (-160.212 + g * 51.7683)))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_published_clamps_by_hand() {
        for (value, expected) in [
            (transmittance_clamp(0.0), 1.234_695),
            (transmittance_clamp(2.0), 0.897_039),
            (phase_clamp(0.0), 18.8217),
            (phase_clamp(0.5), 1.132_419),
            (phase_clamp(1.0), 0.6679),
        ] {
            assert!((value - expected).abs() < 1e-6, "{value} is not {expected}");
        }
    }
}
