//! The paper's closed forms: (22)-(30) are the integral, and (4)-(11) and (13)-(20) the Taylor series, that they claim.

mod series;

use airlight::oracle::paper::{
    Polynomial, antiderivative, coefficients, coefficients_by_recurrence, horner, phase, phase_taylor, product,
    transmittance, transmittance_taylor, u, v,
};
use airlight::oracle::quadrature::gauss_legendre;
use proptest::prelude::*;
use std::f64::consts::{FRAC_PI_2, PI};

fn config() -> ProptestConfig {
    ProptestConfig { cases: 2000, failure_persistence: None, ..ProptestConfig::default() }
}

fn largest(p: &Polynomial) -> f64 {
    p.iter().fold(0.0, |m, c| m.max(c.abs()))
}

fn assert_same(value: &Polynomial, expected: &Polynomial) {
    for i in 0..7 {
        let error = (value[i] - expected[i]).abs();
        assert!(error <= 1e-12 * largest(expected), "coefficient {i}: {} is not {}", value[i], expected[i]);
    }
}

proptest! {
    #![proptest_config(config())]

    #[test]
    fn eqs_22_to_30_are_the_integral(
        f in prop::array::uniform7(-1f64..1.0),
        phi in -PI..PI,
        ends in [-FRAC_PI_2..FRAC_PI_2, -FRAC_PI_2..FRAC_PI_2],
    ) {
        let (beta, alpha) = phi.sin_cos();
        let value = antiderivative(&f, alpha, beta, ends[1]) - antiderivative(&f, alpha, beta, ends[0]);
        let expected = gauss_legendre(|theta| product(&f, alpha, beta, theta), ends[0], ends[1]);
        let scale = coefficients(&f, alpha, beta).iter().map(largest).fold(1.0, f64::max);
        prop_assert!((value - expected).abs() <= 1e-12 * scale, "{value} is not {expected}");
    }

    #[test]
    fn eqs_24_to_30_are_the_recurrence(f in prop::array::uniform7(-1f64..1.0), phi in -PI..PI) {
        let (beta, alpha) = phi.sin_cos();
        let (table, recurrence) = (coefficients(&f, alpha, beta), coefficients_by_recurrence(&f, alpha, beta));
        for (value, expected) in table.iter().zip(&recurrence) {
            assert_same(value, expected);
        }
    }

    #[test]
    fn eqs_4_to_11_are_the_series_of_the_transmittance(mu_t in 0f64..4.0, h in 0f64..4.0, t_h in -1f64..1.0) {
        let q_t0 = (-mu_t * (t_h + h)).exp();
        assert_same(&transmittance_taylor(&u(mu_t, h, t_h)), &series::transmittance(mu_t * h).map(|c| c * q_t0));
    }

    #[test]
    fn eqs_13_to_20_are_the_series_of_the_phase_function(g in -1f64..1.0) {
        assert_same(&phase_taylor(&v(g)), &series::phase(g));
    }

    /// The series above is that of the functions (3) and (12): the remainder is of order 7.
    #[test]
    fn near_zero_the_series_are_the_functions(m in 0f64..3.0, g in -0.9f64..0.9, theta in -0.01f64..0.01) {
        let t = transmittance(m, 1.0, -1.0, theta);
        prop_assert!((horner(&transmittance_taylor(&u(m, 1.0, -1.0)), theta) - t).abs() <= 1e-12);
        prop_assert!((horner(&phase_taylor(&v(g)), theta) - phase(g, theta)).abs() <= 1e-12);
    }
}
