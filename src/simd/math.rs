//! Elementary functions of the kernels, each over the range they need.
//!
//! The polynomials are minimax fits of our own (Remez exchange); the stated errors are checked by the tests below.

use super::{Double, Isa, Lanes, Number};

/// The polynomial with coefficients `c`, highest degree first.
#[inline(always)]
pub(crate) fn horner<I: Isa, const K: usize>(isa: I, x: I::V, c: [f32; K]) -> I::V {
    let mut p = isa.splat(c[0]);
    let mut k = 1;
    while k < K {
        p = p.mul_add(x, isa.splat(c[k]));
        k += 1;
    }
    p
}

/// The same in double precision.
#[inline(always)]
pub(crate) fn horner_double<I: Isa, const K: usize>(isa: I, x: I::Double, c: [f64; K]) -> I::Double {
    let mut p = isa.splat_double(c[0]);
    let mut k = 1;
    while k < K {
        p = p.mul_add(x, isa.splat_double(c[k]));
        k += 1;
    }
    p
}

/// The polynomial with the given coefficients in each lane, from degree 0 on.
#[inline(always)]
pub(crate) fn horner_lanes<V: Number, const K: usize>(x: V, c: [V; K]) -> V {
    let mut p = c[K - 1];
    let mut k = K - 1;
    while k > 0 {
        k -= 1;
        p = p.mul_add(x, c[k]);
    }
    p
}

/// The angle of the point `(x, y)`, in `[0, pi]`, for `y >= 0`, not both 0. Max error 3 ulp.
#[inline(always)]
pub(crate) fn angle_of<I: Isa>(isa: I, y: I::V, x: I::V) -> I::V {
    let c = |v| isa.splat(v);
    let size = x.abs();
    let q = size.min(y) / size.max(y);
    let z = q * q;
    let p = horner(
        isa,
        z,
        [
            -1.793_600_9e-3,
            1.091_451_6e-2,
            -3.117_768_3e-2,
            5.795_743_7e-2,
            -8.403_441e-2,
            1.095_218_3e-1,
            -1.426_424_1e-1,
            1.999_854_9e-1,
            -3.333_33e-1,
        ],
    );
    let atan = (q * z).mul_add(p, q);
    let octant = I::V::select(size.lt(y), (c(PI_2_HIGH) - atan) + c(PI_2_LOW), atan);
    I::V::select(x.lt(c(0.0)), (c(2.0 * PI_2_HIGH) - octant) + c(2.0 * PI_2_LOW), octant)
}
const PI_2_HIGH: f32 = core::f32::consts::FRAC_PI_2;
const PI_2_LOW: f32 = -4.371_139e-8;

/// `(sin x, cos x)` for `x` in `[0, pi]`. Max error 2 ulp of sin on `[0, pi/2]`, else 1.5e-7.
#[inline(always)]
pub(crate) fn sin_cos<I: Isa>(isa: I, x: I::V) -> (I::V, I::V) {
    let c = |v| isa.splat(v);
    let obtuse = c(PI_2_HIGH).lt(x);
    let y = I::V::select(obtuse, (c(2.0 * PI_2_HIGH) - x) + c(2.0 * PI_2_LOW), x);
    let z = y * y;
    let sin = (y * z).mul_add(sin_series(isa, z), y);
    let cos = z.mul_add(cos_series(isa, z), c(1.0));
    (sin, I::V::select(obtuse, -cos, cos))
}

/// Coefficients, highest degree first, of `(sin y / y - 1) / y^2` in `y^2`, for `|y| <= pi/2`.
pub(crate) const SIN: [f32; 4] = [2.605_779_2e-6, -1.980_960_2e-4, 8.333_066e-3, -1.666_666e-1];
/// Coefficients, highest degree first, of `(cos y - 1) / y^2` in `y^2`, for `|y| <= pi/2`.
pub(crate) const COS: [f32; 5] = [-2.607_711_2e-7, 2.476_188_6e-5, -1.388_840_4e-3, 4.166_664e-2, -0.5];

#[inline(always)]
fn sin_series<I: Isa>(isa: I, z: I::V) -> I::V {
    horner(isa, z, SIN)
}
#[inline(always)]
fn cos_series<I: Isa>(isa: I, z: I::V) -> I::V {
    horner(isa, z, COS)
}

/// `tan x` for `x` in `[0, pi/4]`. Max error 2 ulp.
#[inline(always)]
pub(crate) fn tan<I: Isa>(isa: I, x: I::V) -> I::V {
    let z = x * x;
    let p = horner(isa, z, [9.385_594e-3, 3.119_593_7e-3, 2.443_034_2e-2, 5.341_122_3e-2, 1.333_88e-1, 3.333_315_6e-1]);
    (x * z).mul_add(p, x)
}

/// `exp x` for `x <= 0`, rounded from double precision; 0 below -87.3. Max error 2 ulp.
#[inline(always)]
pub(crate) fn exp<I: Isa>(isa: I, x: I::Double) -> I::V {
    let c = |v| isa.splat(v);
    let x = x.max(isa.splat_double(-104.0));
    let n = round(isa, I::V::narrow(x * isa.splat_double(core::f64::consts::LOG2_E)));
    let f = I::V::narrow(n.widen().mul_add(isa.splat_double(-core::f64::consts::LN_2), x));
    let p = exp_m1_reduced(isa, f) + c(1.0);
    I::V::select(c(-126.0).le(n), p * n.max(c(-126.0)).pow2(), c(0.0))
}

/// `(1 - exp(-x), exp(-x))` for `x >= 0`. Max error 3 ulp of the former; the latter is 0 beyond 87.3.
#[inline(always)]
pub(crate) fn one_minus_exp<I: Isa>(isa: I, x: I::V) -> (I::V, I::V) {
    let c = |v| isa.splat(v);
    let x = x.min(c(104.0));
    let n = round(isa, x * c(-core::f32::consts::LOG2_E));
    // Cody and Waite: the products of n with the first part of ln 2 are exact.
    let f = n.mul_add(c(2.121_944_4e-4), n.mul_add(c(-0.693_359_4), -x));
    let q = exp_m1_reduced(isa, f);
    let s = I::V::select(c(-126.0).le(n), n.max(c(-126.0)).pow2(), c(0.0));
    ((c(1.0) - s) - s * q, s.mul_add(q, s))
}

/// `exp f - 1` for `|f| <= ln 2 / 2`.
#[inline(always)]
fn exp_m1_reduced<I: Isa>(isa: I, f: I::V) -> I::V {
    let p = horner(isa, f, [1.394_714_7e-3, 8.367_008e-3, 4.166_627_7e-2, 1.666_654e-1, 0.5]);
    (f * f).mul_add(p, f)
}

/// The nearest integer, for `|x| < 2^22`.
#[inline(always)]
fn round<I: Isa>(isa: I, x: I::V) -> I::V {
    let shift = isa.splat(12_582_912.0);
    (x + shift) - shift
}

/// `-ln(1 - x)` for `x` in `[0, 1]`, given also `y = 1 - x` as exactly as it is known. Max error 3 ulp.
#[inline(always)]
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

    type V = <Portable as Isa>::V;

    /// Largest error of `f` in ulp of `exact`, or 1 where `floor` is larger than an ulp, over `n` points of `[a, b]`.
    fn worst(a: f64, b: f64, floor: f64, f: impl Fn(V) -> V, exact: impl Fn(f64) -> f64) -> f64 {
        let n = 1 << 18;
        let mut worst = 0.0f64;
        for i in 0..=n {
            let x = (a + (b - a) * f64::from(i) / f64::from(n)) as f32;
            let mut out = [0.0; 8];
            f(V::splat(x)).store_prefix(&mut out);
            let want = exact(f64::from(x));
            let ulp = f64::from(f32::EPSILON) * 2f64.powi(want.abs().log2().floor().max(-126.0) as i32);
            worst = worst.max((f64::from(out[3]) - want).abs() / ulp.max(floor));
        }
        worst
    }

    fn check(name: &str, bound: f64, worst: f64) {
        println!("{name}: {worst:.2} of {bound} ulp");
        assert!(worst <= bound, "{name}: {worst} ulp, stated {bound}");
    }

    #[test]
    fn errors_are_within_the_stated_ulp() {
        let isa = Portable;
        let c = |x| isa.splat(x);
        check("atan below 1", 3.0, worst(0.0, 1.0, 1e-30, |x| angle_of(isa, x, c(1.0)), |x| x.atan2(1.0)));
        check("atan above 1", 3.0, worst(1.0, 1e4, 0.0, |x| angle_of(isa, x, c(1.0)), |x| x.atan2(1.0)));
        check("atan left", 3.0, worst(0.0, 1e2, 0.0, |x| angle_of(isa, x, c(-1.0)), |x| x.atan2(-1.0)));
        check("sin", 2.0, worst(0.0, core::f64::consts::FRAC_PI_2, 1e-30, |x| sin_cos(isa, x).0, f64::sin));
        check("sin beyond", 1.5, worst(1.5, core::f64::consts::PI, 1e-7, |x| sin_cos(isa, x).0, f64::sin));
        check("cos", 1.5, worst(0.0, core::f64::consts::PI, 1e-7, |x| sin_cos(isa, x).1, f64::cos));
        check("tan", 2.0, worst(0.0, core::f64::consts::FRAC_PI_4, 1e-30, |x| tan(isa, x), f64::tan));
        check("exp", 2.0, worst(-87.3, 0.0, 0.0, |x| exp(isa, x.widen()), f64::exp));
        check("1 - exp", 3.0, worst(0.0, 30.0, 1e-30, |x| one_minus_exp(isa, x).0, |x| -(-x).exp_m1()));
        check("1 - exp near 0", 3.0, worst(0.0, 0.5, 1e-30, |x| one_minus_exp(isa, x).0, |x| -(-x).exp_m1()));
        check("exp(-x)", 3.0, worst(0.0, 87.0, 0.0, |x| one_minus_exp(isa, x).1, |x| (-x).exp()));
        let ln = |x: V| neg_ln_1m(isa, x, c(1.0) - x);
        check("-ln(1 - x)", 3.0, worst(0.0, 0.49, 1e-30, ln, |x| -(-x).ln_1p()));
        check("-ln(1 - x) near 1", 3.0, worst(0.5, 1.0 - 1e-7, 1e-30, ln, |x| -(-x).ln_1p()));
    }
}
