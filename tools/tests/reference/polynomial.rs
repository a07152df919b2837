//! The Taylor polynomials from the differential equations of what they approximate, and their integrals times `N`.

use super::number::{Big, big, exp};
use std::array::from_fn;

/// By ascending degree.
#[derive(Clone)]
pub(super) struct Polynomial(pub(super) Vec<Big>);

/// Degree 6 at most.
const TERMS: usize = 7;
const FACTORIALS: [f64; TERMS] = [1.0, 1.0, 2.0, 6.0, 24.0, 120.0, 720.0];

impl Polynomial {
    pub(super) fn constant(c: Big) -> Self {
        Self(vec![c])
    }

    /// Of `f = exp(-m (e - 1))` with `e = tan + sec`, from `f' = -m e' f`.
    pub(super) fn transmittance(m: &Big) -> Self {
        // The zigzag numbers.
        let e: [Big; TERMS] = from_fn(|n| big([1.0, 1.0, 1.0, 2.0, 5.0, 16.0, 61.0][n]) / big(FACTORIALS[n]));
        let mut f = vec![big(1.0)];
        for n in 1..TERMS {
            let sum = (1..=n).fold(big(0.0), |sum, k| sum + big(k as f64) * &e[k] * &f[n - k]);
            f.push(-m * sum / big(n as f64));
        }
        Self(f)
    }

    /// Of `f = b^(-3/2)` with `b = 1 + 2g/(1 + g^2) sin`, from `b f' = -3/2 b' f`.
    pub(super) fn phase(g: &Big) -> Self {
        let sine: [f64; TERMS] = [0.0, 1.0, 0.0, -1.0, 0.0, 1.0, 0.0];
        let scale = big(2.0) * g / (big(1.0) + g * g);
        let b: [Big; TERMS] = from_fn(|n| if n == 0 { big(1.0) } else { &scale * big(sine[n]) / big(FACTORIALS[n]) });
        let mut f = vec![big(1.0)];
        for n in 1..TERMS {
            let sum =
                (1..=n).fold(big(0.0), |sum, k| sum - (big(1.5 * k as f64) + big((n - k) as f64)) * &b[k] * &f[n - k]);
            f.push(sum / big(n as f64));
        }
        Self(f)
    }

    pub(super) fn at(&self, x: &Big) -> Big {
        self.0.iter().rev().fold(big(0.0), |sum, c| sum * x + c)
    }

    fn derivative(&self) -> Self {
        Self(self.0.iter().enumerate().skip(1).map(|(n, c)| c * big(n as f64)).collect())
    }

    /// An antiderivative.
    pub(super) fn integral_at(&self, x: &Big) -> Big {
        self.0.iter().enumerate().rev().fold(big(0.0), |sum, (n, c)| sum * x + c / big((n + 1) as f64)) * x
    }

    /// An antiderivative of this times `N = alpha cos + beta sin`, by parts until nothing is left.
    pub(super) fn integral_times_cosine_at(&self, [alpha, beta]: &[Big; 2], direction: &Direction) -> Big {
        // N and what integrating it once, twice, ... makes of it.
        let mut n = alpha * &direction.cos + beta * &direction.sin;
        let mut integral = alpha * &direction.sin - beta * &direction.cos;
        let (mut p, mut sum, mut sign) = (self.clone(), big(0.0), big(1.0));
        while !p.0.is_empty() {
            sum += &sign * p.at(&direction.theta) * &integral;
            (n, integral) = (integral, -n);
            (p, sign) = (p.derivative(), -sign);
        }
        sum
    }
}

/// A direction from the emitter.
#[derive(Clone)]
pub(super) struct Direction {
    pub(super) theta: Big,
    pub(super) sin: Big,
    pub(super) cos: Big,
}

impl Direction {
    pub(super) fn new(theta: Big) -> Self {
        let (sin, cos) = theta.sin_cos();
        Self { theta, sin, cos }
    }

    /// Of the point at `t'`, for the distance `h`.
    pub(super) fn to(t_prime: &Big, h: &Big) -> Self {
        let r = (h * h + t_prime * t_prime).sqrt();
        Self { theta: (t_prime / h).atan(), sin: t_prime / &r, cos: h / r }
    }
}

/// The printed clamps.
pub(super) fn transmittance_clamp(m: &Big) -> Big {
    exp(&(big(0.210824) - big(0.15974) * m))
}

pub(super) fn phase_clamp(g: &Big) -> Big {
    Polynomial([18.8217, -93.8831, 184.173, -160.212, 51.7683].map(big).into()).at(g)
}
