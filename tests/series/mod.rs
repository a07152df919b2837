//! The Taylor series of T and rho about theta = 0 from their differential equations, not from the paper's tables.

use airlight::oracle::paper::Polynomial;

/// The coefficient of `theta^n` in the product of two series.
fn product(x: &Polynomial, y: &Polynomial, n: usize) -> f64 {
    (0..=n).map(|k| x[k] * y[n - k]).sum()
}

/// `exp(-m X)` relative to its value at 0, with `X = tan theta + sec theta`.
pub(crate) fn transmittance(m: f64) -> Polynomial {
    let (mut x, mut t) = ([0.0; 7], [0.0; 7]);
    (x[0], t[0]) = (1.0, 1.0);
    for n in 0..6 {
        let n1 = n as f64 + 1.0;
        // X' = (1 + X^2)/2
        x[n + 1] = (f64::from(u8::from(n == 0)) + product(&x, &x, n)) / (2.0 * n1);
        // T' = -m X' T
        let slope: f64 = (0..=n).map(|k| (k as f64 + 1.0) * x[k + 1] * t[n - k]).sum();
        t[n + 1] = -m * slope / n1;
    }
    t
}

/// The phase function of Henyey and Greenstein.
pub(crate) fn phase(g: f64) -> Polynomial {
    let s = 1.0 + g * g;
    // w = 1 + g^2 + 2 g sin theta
    let w = [s, 2.0 * g, 0.0, -g / 3.0, 0.0, g / 60.0, 0.0];
    let mut rho = [0.0; 7];
    rho[0] = (1.0 - g * g) / (4.0 * std::f64::consts::PI * s.powf(1.5));
    for n in 0..6 {
        // w rho' = -3/2 w' rho
        let right: f64 = (0..=n).map(|k| -1.5 * (k as f64 + 1.0) * w[k + 1] * rho[n - k]).sum();
        let known: f64 = (1..=n).map(|k| w[k] * (n - k + 1) as f64 * rho[n - k + 1]).sum();
        rho[n + 1] = (right - known) / (w[0] * (n as f64 + 1.0));
    }
    rho
}
