//! The supplement's misprints: what is printed is off by a wide margin, what stands in `airlight::oracle::paper` holds.

mod series;

use airlight::oracle::paper::{
    Polynomial, antiderivative, coefficients, geometric, horner, phase_taylor, product, q, transmittance_taylor, u, v,
};
use airlight::oracle::quadrature::gauss_legendre;
use std::f64::consts::PI;

const HOLDS: f64 = 1e-12;
const FAILS: f64 = 1e-2;

/// A polynomial, `alpha`, `beta`, and an interval in which no term hides another.
const F: Polynomial = [0.7, -0.4, 0.9, 0.5, -0.6, 0.8, 0.3];
const ALPHA: f64 = 0.8;
const BETA: f64 = 0.6;
const A: f64 = -0.9;
const B: f64 = 1.2;

/// The largest difference between two polynomials, relative to the largest coefficient of the second.
fn difference(value: &Polynomial, expected: &Polynomial) -> f64 {
    let largest = |p: Polynomial| p.iter().fold(0.0, |m: f64, c| m.max(c.abs()));
    largest(std::array::from_fn(|i| value[i] - expected[i])) / largest(*expected)
}

/// How far the polynomials `[of the cosine, of the sine]` of an antiderivative are off the quadrature, relatively.
fn off_quadrature([q_cos, q_sin]: [Polynomial; 2]) -> f64 {
    let at = |theta: f64| horner(&q_cos, theta) * theta.cos() + horner(&q_sin, theta) * theta.sin();
    let expected = gauss_legendre(|theta| product(&F, ALPHA, BETA, theta), A, B);
    ((at(B) - at(A) - expected) / expected).abs()
}

#[test]
fn eq_11_has_mu_t() {
    let (mu_s, mu_a, h, t_h) = (0.2, 0.5, 1.3, 0.4);
    let mu_t: f64 = mu_s + mu_a;
    let q_t0 = (-mu_t * (t_h + h)).exp();
    let expected = series::transmittance(mu_t * h).map(|c| c * q_t0);
    // The "mu_n" that is printed is defined nowhere. It is neither of the other two coefficients.
    for mu_n in [mu_s, mu_a] {
        let printed = geometric(q_t0, mu_n * h);
        assert!(difference(&transmittance_taylor(&printed), &expected) > FAILS);
    }
    assert!(difference(&transmittance_taylor(&u(mu_t, h, t_h)), &expected) < HOLDS);
}

#[test]
fn eq_15_has_15_halves() {
    let g = 0.5;
    let expected = series::phase(g);
    let corrected = phase_taylor(&v(g));
    let mut printed = corrected;
    printed[2] = 15.0 * v(g)[2];
    assert!(difference(&printed, &expected) > FAILS);
    assert!(difference(&corrected, &expected) < HOLDS);
}

#[test]
fn eq_20_has_a_square_root() {
    let g: f64 = 0.5;
    let expected = series::phase(g);
    let printed: Polynomial = std::array::from_fn(|n| {
        let n = n as i32;
        (1.0 - g * g) * g.powi(n) / (4.0 * PI * (1.0 + g * g).powi(2 * n + 3))
    });
    assert!(difference(&phase_taylor(&printed), &expected) > FAILS);
    assert!(difference(&phase_taylor(&v(g)), &expected) < HOLDS);
}

#[test]
fn eq_22_has_q_of_beta_and_minus_alpha() {
    // Printed are two letters that stand for N's factors and for the bounds: neither reading holds.
    for (k, l) in [(ALPHA, -BETA), (A, -B)] {
        assert!(off_quadrature([q(&F, ALPHA, BETA), q(&F, k, l)]) > FAILS);
    }
    assert!(off_quadrature(coefficients(&F, ALPHA, BETA)) < HOLDS);
    let corrected = antiderivative(&F, ALPHA, BETA, B) - antiderivative(&F, ALPHA, BETA, A);
    let expected = gauss_legendre(|theta| product(&F, ALPHA, BETA, theta), A, B);
    assert!((corrected / expected - 1.0).abs() < HOLDS);
}

/// (24)-(28) as printed: the `l` terms of the second, fourth and sixth derivative.
fn printed_terms(l: f64) -> [f64; 5] {
    let [_, _, f2, f3, f4, f5, f6] = F;
    [
        -2.0 * l * (f2 - 12.0 * f4 + 360.0 * f6), // (24)
        -6.0 * l * (f3 - 20.0 * f5),              // (25)
        -12.0 * l * (f4 - 30.0 * f6),             // (26)
        -20.0 * l * f5,                           // (27)
        -30.0 * l * f6,                           // (28)
    ]
}

#[test]
fn eqs_24_to_28_have_plus_l() {
    for i in 0..5 {
        let as_printed = |k: f64, l: f64| {
            let mut q = q(&F, k, l);
            q[i] += 2.0 * printed_terms(l)[i];
            q
        };
        let off = off_quadrature([as_printed(ALPHA, BETA), as_printed(BETA, -ALPHA)]);
        assert!(off > FAILS, "({}) as printed is off by {off:e} only", 24 + i);
    }
    let all_as_printed = |k: f64, l: f64| {
        let mut q = q(&F, k, l);
        (0..5).for_each(|i| q[i] += 2.0 * printed_terms(l)[i]);
        q
    };
    assert!(off_quadrature([all_as_printed(ALPHA, BETA), all_as_printed(BETA, -ALPHA)]) > FAILS);
    assert!(off_quadrature(coefficients(&F, ALPHA, BETA)) < HOLDS);
}
