//! Vectors with twice the digits of f64: sums of products that cancel keep all digits of an f64.

use glam::DVec3;
use std::ops::{Add, Mul, Sub};

/// The unevaluated sum of a number and the remainder of its rounding.
#[derive(Clone, Copy, Debug)]
pub(super) struct Twofold {
    high: f64,
    low: f64,
}

impl Twofold {
    /// Rounded to f64.
    pub(super) fn value(self) -> f64 {
        self.high
    }

    /// `a + b` exactly (Knuth).
    fn sum(a: f64, b: f64) -> Self {
        let high = a + b;
        let of_b = high - a;
        Self { high, low: (a - (high - of_b)) + (b - of_b) }
    }
}

impl From<f64> for Twofold {
    fn from(value: f64) -> Self {
        Self { high: value, low: 0.0 }
    }
}

impl Add for Twofold {
    type Output = Self;
    fn add(self, o: Self) -> Self {
        let sum = Self::sum(self.high, o.high);
        Self::sum(sum.high, sum.low + (self.low + o.low))
    }
}

impl Sub for Twofold {
    type Output = Self;
    fn sub(self, o: Self) -> Self {
        self + Self { high: -o.high, low: -o.low }
    }
}

impl Mul for Twofold {
    type Output = Self;
    fn mul(self, o: Self) -> Self {
        let high = self.high * o.high;
        let rounding = self.high.mul_add(o.high, -high);
        Self::sum(high, rounding + (self.high * o.low + self.low * o.high))
    }
}

/// A vector of [`Twofold`].
#[derive(Clone, Copy, Debug)]
pub(super) struct Vector([Twofold; 3]);

impl Vector {
    /// `a - b` exactly.
    pub(super) fn difference(a: [f32; 3], b: [f32; 3]) -> Self {
        Self([0, 1, 2].map(|k| Twofold::sum(a[k].into(), -f64::from(b[k]))))
    }

    pub(super) fn cross(self, o: Self) -> Self {
        let ([a0, a1, a2], [b0, b1, b2]) = (self.0, o.0);
        Self([a1 * b2 - a2 * b1, a2 * b0 - a0 * b2, a0 * b1 - a1 * b0])
    }

    /// The scalar product with twice the digits.
    pub(super) fn product(self, o: Self) -> Twofold {
        let ([a0, a1, a2], [b0, b1, b2]) = (self.0, o.0);
        a0 * b0 + a1 * b1 + a2 * b2
    }

    pub(super) fn dot(self, o: Self) -> f64 {
        self.product(o).value()
    }

    pub(super) fn length(self) -> f64 {
        DVec3::from_array(self.0.map(|c| c.high)).length()
    }
}

impl From<[f32; 3]> for Vector {
    fn from(v: [f32; 3]) -> Self {
        Self::difference(v, [0.0; 3])
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn products_that_cancel_leave_all_digits() {
        let (long, step) = (2f32.powi(25), f32::EPSILON);
        let w = Vector::difference([long, long, 0.0], [-1.0 / long, -1.0 / long, 0.0]);
        let expected = f64::from(step) * (f64::from(long) + 1.0 / f64::from(long));
        assert_eq!(w.dot(Vector::from([1.0 + step, -1.0, 0.0])), expected);
        assert_eq!(w.cross(Vector::from([1.0 + step, 1.0, 0.0])).length(), expected);
    }
}
