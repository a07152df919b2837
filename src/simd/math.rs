//! Elementary functions of the kernels, each over the range that they need. `docs/mathematics.md`, section 11.2, lists them.
//!
//! Each function states what it returns, and three fields:
//!
//! - Types: the arguments and the result, per lane.
//! - Max error: with or without fused multiply-add, over all values of the range, rounded up. An ulp is that of the result.
//! - Range: the arguments for which this holds.
//!
//! The polynomials are minimax fits of our own (Remez exchange). `errors_are_as_stated` below checks the errors on a grid,
//! `errors_are_as_stated_at_every_float` at every f32 of the range.

use super::{Double, Isa, Lanes, Number};

/// The polynomial of `x` with coefficients `c`, highest degree first, by Horner's rule.
///
/// - Types: f32.
/// - Max error: half an ulp of the partial sum in each of the `K - 1` steps; without fused multiply-add two roundings.
/// - Range: all.
#[cfg_attr(optimized, inline(always))]
pub(crate) fn horner<I: Isa, const K: usize>(isa: I, x: I::V, c: [f32; K]) -> I::V {
    let mut p = isa.splat(c[0]);
    let mut k = 1;
    while k < K {
        p = p.mul_add(x, isa.splat(c[k]));
        k += 1;
    }
    p
}

/// The same in f64.
///
/// - Types: f64.
/// - Max error: as [`horner`].
/// - Range: all.
#[cfg_attr(optimized, inline(always))]
pub(crate) fn horner_double<I: Isa, const K: usize>(isa: I, x: I::Double, c: [f64; K]) -> I::Double {
    let mut p = isa.splat_double(c[0]);
    let mut k = 1;
    while k < K {
        p = p.mul_add(x, isa.splat_double(c[k]));
        k += 1;
    }
    p
}

/// The polynomial of `x` with coefficients `c` that differ between lanes, lowest degree first, by Horner's rule.
///
/// - Types: f32 or f64.
/// - Max error: as [`horner`].
/// - Range: all.
#[cfg_attr(optimized, inline(always))]
pub(crate) fn horner_lanes<V: Number, const K: usize>(x: V, c: [V; K]) -> V {
    let mut p = c[K - 1];
    let mut k = K - 1;
    while k > 0 {
        k -= 1;
        p = p.mul_add(x, c[k]);
    }
    p
}

/// `atan2(y, x)`: the angle of the point `(x, y)`, in `[0, pi]`.
///
/// - Types: f32.
/// - Max error: 1.4 ulp if `exact`, else 3.5 ulp, where `y/x` is exact; else the rounding of this quotient on top.
/// - Range: `y >= 0`, `x` and `y` not both 0.
#[cfg_attr(optimized, inline(always))]
pub(crate) fn angle_of<I: Isa>(isa: I, y: I::V, x: I::V, exact: bool) -> I::V {
    let c = |v| isa.splat(v);
    let size = x.abs();
    let q = size.min(y) / size.max(y);
    let z = q * q;
    let p = if exact { horner(isa, z, ATAN) } else { horner(isa, z, SHORT_ATAN) };
    // The low digits of the right angles are added to the small terms: the last sum rounds most.
    let back = x.lt(c(0.0));
    let steep = size.lt(y);
    let right_angles = I::V::select(steep, c(PI_2_HIGH), I::V::select(back, c(2.0 * PI_2_HIGH), c(0.0)));
    let q = I::V::select(steep, -q, q);
    let q = I::V::select(back, -q, q);
    let low = if exact { (q * z).mul_add(p, right_angles * c(PI_2_LOW / PI_2_HIGH)) } else { (q * z) * p };
    right_angles + (q + low)
}
/// Coefficients, highest degree first, of `(atan q / q - 1) / q^2` in `q^2`, for `|q| <= 1`.
const ATAN: [f32; 9] = [
    -1.793_600_9e-3,
    1.091_451_6e-2,
    -3.117_768_3e-2,
    5.795_743_7e-2,
    -8.403_441e-2,
    1.095_218_3e-1,
    -1.426_424_1e-1,
    1.999_854_9e-1,
    -3.333_33e-1,
];
const SHORT_ATAN: [f32; 7] =
    [-4.822_535e-3, 2.473_406_5e-2, -6.020_313e-2, 9.968_473e-2, -1.404_132_8e-1, 1.997_421_4e-1, -3.333_239_3e-1];
const PI_2_HIGH: f32 = core::f32::consts::FRAC_PI_2;
const PI_2_LOW: f32 = -4.371_139e-8;

/// `(sin x, cos x)`.
///
/// - Types: f32.
/// - Max error: 2.1 ulp of sin; 1.5e-7, absolute, of cos.
/// - Range: `[0, pi/2]`.
#[cfg_attr(optimized, inline(always))]
pub(crate) fn sin_cos<I: Isa>(isa: I, x: I::V) -> (I::V, I::V) {
    let z = x * x;
    let sin = (x * z).mul_add(horner(isa, z, SIN), x);
    let cos = z.mul_add(horner(isa, z, COS), isa.splat(1.0));
    (sin, cos)
}

/// Coefficients, highest degree first, of `(sin y / y - 1) / y^2` in `y^2`, for `|y| <= pi/2`.
pub(crate) const SIN: [f32; 4] = [2.605_779_2e-6, -1.980_960_2e-4, 8.333_066e-3, -1.666_666e-1];
/// Coefficients, highest degree first, of `(cos y - 1) / y^2` in `y^2`, for `|y| <= pi/2`.
const COS: [f32; 5] = [-2.607_711_2e-7, 2.476_188_6e-5, -1.388_840_4e-3, 4.166_664e-2, -0.5];

/// `tan x`.
///
/// - Types: f32.
/// - Max error: 1.5 ulp if `exact`, else 5.2 ulp.
/// - Range: `[0, pi/4]`.
#[cfg_attr(optimized, inline(always))]
pub(crate) fn tan<I: Isa>(isa: I, x: I::V, exact: bool) -> I::V {
    let z = x * x;
    let p = if exact { horner(isa, z, TAN) } else { horner(isa, z, SHORT_TAN) };
    (x * z).mul_add(p, x)
}
/// Coefficients, highest degree first, of `(tan x / x - 1) / x^2` in `x^2`, for `|x| <= pi/4`.
const TAN: [f32; 6] = [9.385_594e-3, 3.119_593_7e-3, 2.443_034_2e-2, 5.341_122_3e-2, 1.333_88e-1, 3.333_315_6e-1];
const SHORT_TAN: [f32; 5] = [2.011_853_8e-2, 1.298_675e-2, 5.690_418e-2, 1.329_234_7e-1, 3.333_515_8e-1];

/// `exp x`; 0 below -87.3.
///
/// - Types: f64 to f32.
/// - Max error: 1.1 ulp.
/// - Range: `x <= 0`.
#[cfg_attr(optimized, inline(always))]
pub(crate) fn exp<I: Isa>(isa: I, x: I::Double) -> I::V {
    let c = |v| isa.splat(v);
    let x = x.max(isa.splat_double(-104.0));
    let n = round(isa, I::V::narrow(x * isa.splat_double(core::f64::consts::LOG2_E)));
    let f = I::V::narrow(n.widen().mul_add(isa.splat_double(-core::f64::consts::LN_2), x));
    let p = exp_m1_reduced(isa, f) + c(1.0);
    I::V::only(c(-126.0).le(n), p * n.pow2())
}

/// `1/x`, by an f32 division and a Newton step.
///
/// - Types: f64.
/// - Max error: 1e-14, relative.
/// - Range: `[2^-100, 2^100]`.
#[cfg_attr(optimized, inline(always))]
pub(crate) fn reciprocal<I: Isa>(isa: I, x: I::Double) -> I::Double {
    reciprocal_near(isa, x, (isa.splat(1.0) / I::V::narrow(x)).widen())
}

/// `1/x`, by a Newton step from `near`, an approximation of it such as an f32 division gives.
///
/// - Types: f64.
/// - Max error: the square of the relative error of `near`, and two roundings.
/// - Range: all where `x near` and the result are finite.
#[cfg_attr(optimized, inline(always))]
pub(crate) fn reciprocal_near<I: Isa>(isa: I, x: I::Double, near: I::Double) -> I::Double {
    near * (isa.splat_double(2.0) - x * near)
}

/// `(1 - exp(-x), exp(-x))`; the latter is 0 beyond 87.3.
///
/// - Types: f32.
/// - Max error: 1.2 ulp of the former, 1.1 ulp of the latter.
/// - Range: `x >= 0`.
#[cfg_attr(optimized, inline(always))]
pub(crate) fn one_minus_exp<I: Isa>(isa: I, x: I::V) -> (I::V, I::V) {
    let c = |v| isa.splat(v);
    let x = x.min(c(104.0));
    let n = round(isa, x * c(-core::f32::consts::LOG2_E));
    // Cody and Waite: the products of n with the first part of ln 2 are exact.
    let f = n.mul_add(c(2.121_944_4e-4), n.mul_add(c(-0.693_359_4), -x));
    let q = exp_m1_reduced(isa, f);
    let s = I::V::only(c(-126.0).le(n), n.pow2());
    ((c(1.0) - s) - s * q, s.mul_add(q, s))
}

/// `2^-x`, shorter than [`exp`]; at least 2^-125. `most` is the largest argument.
///
/// - Types: f32.
/// - Max error: 2.4 ulp where `most` is at most 0.9, 6.0 up to 1.8, 15 up to 3.6, 35 up to 7.2, 3.1 above; beyond 125 that of the
///   bound.
/// - Range: `[0, most]`.
#[cfg_attr(optimized, inline(always))]
pub(crate) fn exp2_neg<I: Isa>(isa: I, x: I::V, most: f32) -> I::V {
    let squarings = squarings(most);
    if squarings > MOST_SQUARINGS {
        let x = x.min(isa.splat(125.0));
        let n = round(isa, -x);
        return horner(isa, -(x + n), EXP2) * n.pow2();
    }
    // A polynomial of x/2^squarings, squared so often: each squaring doubles its error.
    let (part, mut power, mut c) = (1.0 / (1 << squarings) as f32, 1.0, EXP2_OF_PART);
    let mut k = c.len() - 1;
    while k > 0 {
        k -= 1;
        power *= part;
        c[k] *= power;
    }
    let mut p = horner(isa, x, c);
    let mut n = 0;
    while n < squarings {
        p = p * p;
        n += 1;
    }
    p
}
/// Coefficients, highest degree first, of `2^f`, for `|f| <= 1/2`.
const EXP2: [f32; 6] = [1.327_647_2e-3, 9.675_541e-3, 5.550_713e-2, 2.402_212e-1, 6.931_469_7e-1, 1.000_000_1];
/// Coefficients, highest degree first, of `2^-y`, for `0 <= y <= LARGEST_PART`.
const EXP2_OF_PART: [f32; 6] =
    [-9.726_874e-4, 9.263_512e-3, -5.533_747e-2, 2.401_903_1e-1, -6.931_442_4e-1, 9.999_999_6e-1];
const LARGEST_PART: f32 = 0.9;
const MOST_SQUARINGS: u32 = 3;

/// How often `most` is halved until it is at most [`LARGEST_PART`].
const fn squarings(most: f32) -> u32 {
    let (mut part, mut count) = (most, 0);
    while part > LARGEST_PART {
        part *= 0.5;
        count += 1;
    }
    count
}

/// `exp f - 1`.
///
/// - Types: f32.
/// - Max error: not stated by itself; those of [`exp`] and [`one_minus_exp`] include it.
/// - Range: `|f| <= ln 2 / 2`.
#[cfg_attr(optimized, inline(always))]
fn exp_m1_reduced<I: Isa>(isa: I, f: I::V) -> I::V {
    let p = horner(isa, f, [1.394_714_7e-3, 8.367_008e-3, 4.166_627_7e-2, 1.666_654e-1, 0.5]);
    (f * f).mul_add(p, f)
}

/// The nearest integer, of two the even one.
///
/// - Types: f32.
/// - Max error: 0.
/// - Range: `|x| < 2^22`.
#[cfg_attr(optimized, inline(always))]
fn round<I: Isa>(isa: I, x: I::V) -> I::V {
    let shift = isa.splat(12_582_912.0);
    (x + shift) - shift
}

/// `-ln(1 - x)`, given also `y = 1 - x` as exactly as it is known. A `y` below f32's least normal number counts as that number.
///
/// - Types: f32.
/// - Max error: 2.7 ulp.
/// - Range: `[0, 1]`.
#[cfg_attr(optimized, inline(always))]
pub(crate) fn neg_ln_1m<I: Isa>(isa: I, x: I::V, y: I::V) -> I::V {
    let c = |v| isa.splat(v);
    let (m, e) = y.max(c(f32::MIN_POSITIVE)).split();
    let small = x.lt(c(0.29));
    let f = I::V::select(small, -x, m - c(1.0));
    let e = I::V::select(small, c(0.0), e);
    let s = f / (c(2.0) + f);
    let z = s * s;
    let p = horner(isa, z, [1.180_453_2e-1, 1.426_815_8e-1, 2.000_017e-1, 3.333_333_4e-1]);
    let two_s = s + s;
    let ln_m = (two_s * z).mul_add(p, two_s);
    -e.mul_add(c(core::f32::consts::LN_2), ln_m)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::simd::Portable;
    use std::f32::consts::{FRAC_PI_2, FRAC_PI_4};

    type V = <Portable as Isa>::V;

    #[test]
    fn the_reciprocal_is_as_exact_as_stated() {
        // A prime, so that the low bits are not all 0.
        let worst = (0..262_139u32).fold(0.0f32, |worst, i| {
            let x = ISA.splat_double(2f64.powi(i as i32 % 200 - 100) * (1.0 + f64::from(i) / 262_139.0));
            let error = (reciprocal(ISA, x) * x - ISA.splat_double(1.0)) * ISA.splat_double(1e14);
            worst.max(V::narrow(error).to_array()[0].abs())
        });
        assert!(worst <= 1.0, "{worst}e-14");
    }

    /// A function on an interval of positive numbers, and the error that its documentation states.
    struct Stated {
        name: &'static str,
        on: (f32, f32),
        f: fn(V) -> V,
        exact: fn(f64) -> f64,
        error: Error,
    }

    #[derive(Clone, Copy)]
    enum Error {
        Ulp(f64),
        /// In units of 1e-7.
        Absolute(f64),
    }
    use Error::{Absolute, Ulp};

    const ISA: Portable = Portable;

    #[rustfmt::skip]
    const ALL: [Stated; 22] = [
        Stated { name: "angle of (1, q), short", on: (0.0, 1.0), f: |q| angle_of(ISA, q, one(), false), exact: |q| q.atan2(1.0), error: SHORT },
        Stated { name: "angle of (q, 1), short", on: (0.0, 1.0), f: |q| angle_of(ISA, one(), q, false), exact: |q| 1f64.atan2(q), error: SHORT },
        Stated { name: "angle of (-1, q), short", on: (0.0, 1.0), f: |q| angle_of(ISA, q, -one(), false), exact: |q| q.atan2(-1.0), error: SHORT },
        Stated { name: "angle of (-q, 1), short", on: (0.0, 1.0), f: |q| angle_of(ISA, one(), -q, false), exact: |q| 1f64.atan2(-q), error: SHORT },
        Stated { name: "tan, short", on: (0.0, FRAC_PI_4), f: |x| tan(ISA, x, false), exact: f64::tan, error: Ulp(5.2) },
        Stated { name: "angle of (1, q)", on: (0.0, 1.0), f: |q| angle_of(ISA, q, one(), true), exact: |q| q.atan2(1.0), error: ANGLE },
        Stated { name: "angle of (q, 1)", on: (0.0, 1.0), f: |q| angle_of(ISA, one(), q, true), exact: |q| 1f64.atan2(q), error: ANGLE },
        Stated { name: "angle of (-1, q)", on: (0.0, 1.0), f: |q| angle_of(ISA, q, -one(), true), exact: |q| q.atan2(-1.0), error: ANGLE },
        Stated { name: "angle of (-q, 1)", on: (0.0, 1.0), f: |q| angle_of(ISA, one(), -q, true), exact: |q| 1f64.atan2(-q), error: ANGLE },
        Stated { name: "sin", on: (0.0, FRAC_PI_2), f: |x| sin_cos(ISA, x).0, exact: f64::sin, error: Ulp(2.1) },
        Stated { name: "cos", on: (0.0, FRAC_PI_2), f: |x| sin_cos(ISA, x).1, exact: f64::cos, error: Absolute(1.5) },
        Stated { name: "tan", on: (0.0, FRAC_PI_4), f: |x| tan(ISA, x, true), exact: f64::tan, error: Ulp(1.5) },
        Stated { name: "2^-x, not squared", on: (0.0, 0.9), f: |x| exp2_neg(ISA, x, 0.9), exact: |x| (-x).exp2(), error: Ulp(2.4) },
        Stated { name: "2^-x, squared once", on: (0.0, 1.8), f: |x| exp2_neg(ISA, x, 1.8), exact: |x| (-x).exp2(), error: Ulp(6.0) },
        Stated { name: "2^-x, squared twice", on: (0.0, 3.6), f: |x| exp2_neg(ISA, x, 3.6), exact: |x| (-x).exp2(), error: Ulp(15.0) },
        Stated { name: "2^-x, most squared", on: (0.0, 7.2), f: |x| exp2_neg(ISA, x, 7.2), exact: |x| (-x).exp2(), error: Ulp(35.0) },
        Stated { name: "2^-x, by powers", on: (0.0, 125.0), f: |x| exp2_neg(ISA, x, 300.0), exact: |x| (-x).exp2(), error: Ulp(3.1) },
        Stated { name: "exp(-x)", on: (0.0, 87.3), f: |x| exp(ISA, (-x).widen()), exact: |x| (-x).exp(), error: Ulp(1.1) },
        Stated { name: "1 - exp(-x)", on: (0.0, 88.0), f: |x| one_minus_exp(ISA, x).0, exact: |x| -(-x).exp_m1(), error: Ulp(1.2) },
        Stated { name: "exp(-x) beside it", on: (0.0, 87.3), f: |x| one_minus_exp(ISA, x).1, exact: |x| (-x).exp(), error: Ulp(1.1) },
        Stated { name: "-ln(1 - x), low", on: (0.0, 0.5), f: |x| neg_ln_1m(ISA, x, one() - x), exact: |x| -(-x).ln_1p(), error: LN },
        Stated { name: "-ln(1 - x), high", on: (0.5, 1.0f32.next_down()), f: |x| neg_ln_1m(ISA, x, one() - x), exact: |x| -(-x).ln_1p(), error: LN },
    ];
    const ANGLE: Error = Ulp(1.4);
    const SHORT: Error = Ulp(3.5);
    const LN: Error = Ulp(2.7);

    fn one() -> V {
        ISA.splat(1.0)
    }

    impl Stated {
        /// The largest error over eight points at a time, in the unit of the stated one.
        fn worst(&self, points: impl Iterator<Item = [f32; 8]>) -> f64 {
            points.fold(0.0, |worst, points| {
                let values = (self.f)(V::new(points)).to_array();
                points.into_iter().zip(values).fold(worst, |worst, (x, value)| {
                    let exact = (self.exact)(x.into());
                    let unit = match self.error {
                        Ulp(_) => ulp(exact),
                        Absolute(_) => 1e-7,
                    };
                    worst.max((f64::from(value) - exact).abs() / unit)
                })
            })
        }

        /// Prints the largest error and whether it is as stated.
        fn holds(&self, worst: f64) -> bool {
            let (stated, unit) = match self.error {
                Ulp(stated) => (stated, "ulp"),
                Absolute(stated) => (stated, "e-7"),
            };
            let holds = worst <= stated;
            println!("{:18} {worst:.3} of {stated} {unit}{}", self.name, if holds { "" } else { ": too much" });
            holds
        }
    }

    /// The distance between neighbouring f32 around `x`.
    fn ulp(x: f64) -> f64 {
        let power_of_two = f64::from_bits(x.to_bits() & (0x7ff << 52));
        f64::from(f32::EPSILON) * power_of_two.max(f32::MIN_POSITIVE.into())
    }

    #[test]
    fn errors_are_as_stated() {
        let all_hold = ALL.iter().fold(true, |all_hold, stated| {
            let (a, b) = stated.on;
            // A prime, so that the low bits of the points are not all 0: 1 - x would be exact.
            let at = |i: u32| (a + (b - a) * (i as f32 / 262_139.0)).min(b);
            let points = (0..1 << 15).map(|i| std::array::from_fn(|k| at(8 * i + k as u32 + 1)));
            stated.holds(stated.worst(points)) && all_hold
        });
        assert!(all_hold);
    }

    /// Without FMA: `cargo test --lib every_float -- --ignored --nocapture`. With it, after
    /// `export RUSTFLAGS="-C target-feature=+fma"`.
    #[test]
    #[ignore = "exhaustive: minutes"]
    fn errors_are_as_stated_at_every_float() {
        let all_hold = ALL.iter().fold(true, |all_hold, stated| {
            // The bits of positive floats ascend as they do.
            let (first, last) = (stated.on.0.to_bits(), stated.on.1.to_bits());
            let middle = first + (last - first) / 2;
            let every = |first: u32, last: u32| {
                let bits = move |i: u32| std::array::from_fn(|k| f32::from_bits((i + k as u32).min(last)));
                (first..=last).step_by(8).map(bits)
            };
            let worst = std::thread::scope(|scope| {
                let low = scope.spawn(|| stated.worst(every(first, middle)));
                stated.worst(every(middle, last)).max(low.join().expect("no panic"))
            });
            stated.holds(worst) && all_hold
        });
        assert!(all_hold);
    }
}
