//! 8 lanes of `wide::f32x8`, with the instruction set that the build enables. The easiest implementation to read.

use super::pair::Pair;
use super::{Double, Isa, Lanes, Number};
use wide::bytemuck::cast;
use wide::{f32x8, f64x4, i32x8};

/// Needs no CPU check.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Portable;

impl Isa for Portable {
    type V = f32x8;
    type Mask = f32x8;
    type Double = Pair<f64x4>;
    type Group = [f32; 8];
    const FUSED: bool = cfg!(any(target_arch = "aarch64", all(target_arch = "x86_64", target_feature = "fma")));

    #[inline]
    fn splat(self, x: f32) -> f32x8 {
        f32x8::splat(x)
    }
    #[inline]
    fn splat_double(self, x: f64) -> Pair<f64x4> {
        Pair(f64x4::splat(x), f64x4::splat(x))
    }
    #[inline]
    fn groups(column: &[f32]) -> &[[f32; 8]] {
        column.as_chunks().0
    }
    #[inline]
    fn groups_mut(column: &mut [f32]) -> &mut [[f32; 8]] {
        column.as_chunks_mut().0
    }
    #[inline]
    fn load(self, group: &[f32; 8]) -> f32x8 {
        f32x8::new(*group)
    }
    #[inline]
    fn store(self, lanes: f32x8, group: &mut [f32; 8]) {
        *group = lanes.to_array();
    }
    fn vectorize<H, R>(self, work: impl FnOnce() -> R) -> R {
        H::apart(work)
    }
}

/// The module of the machine code of the portable kernels.
trait Home: Sized {
    #[inline(never)]
    fn apart<R>(work: impl FnOnce() -> R) -> R {
        work()
    }
}

impl<T> Home for T {}

impl Number for f32x8 {
    #[inline]
    fn mul_add(self, m: Self, a: Self) -> Self {
        f32x8::mul_add(self, m, a)
    }
}

impl Lanes for f32x8 {
    type Mask = f32x8;
    type Double = Pair<f64x4>;
    const N: usize = 8;

    #[inline]
    fn sqrt(self) -> Self {
        f32x8::sqrt(self)
    }
    #[inline]
    fn abs(self) -> Self {
        f32x8::abs(self)
    }
    #[inline]
    fn min(self, o: Self) -> Self {
        self.fast_min(o)
    }
    #[inline]
    fn max(self, o: Self) -> Self {
        self.fast_max(o)
    }
    #[inline]
    fn lt(self, o: Self) -> f32x8 {
        self.simd_lt(o)
    }
    #[inline]
    fn le(self, o: Self) -> f32x8 {
        self.simd_le(o)
    }
    #[inline]
    fn eq(self, o: Self) -> f32x8 {
        self.simd_eq(o)
    }
    #[inline]
    fn select(m: f32x8, yes: Self, no: Self) -> Self {
        m.bitselect(yes, no)
    }
    #[inline]
    fn only(m: f32x8, x: Self) -> Self {
        m & x
    }
    #[inline]
    fn bits(m: f32x8) -> u32 {
        m.to_bitmask()
    }
    #[inline]
    fn pow2(self) -> Self {
        // Adding 1.5 * 2^23 moves the integer to the low bits of the significand.
        let n: i32x8 = cast(self + f32x8::splat(12_582_912.0));
        cast((n + i32x8::splat(127)) << 23)
    }
    #[inline]
    fn split(self) -> (Self, Self) {
        let bits: i32x8 = cast(self);
        let exponent = (bits - i32x8::splat(0x3f35_04f3)) >> 23;
        (cast(bits - (exponent << 23)), f32x8::from_i32x8(exponent))
    }
    #[inline]
    fn widen(self) -> Pair<f64x4> {
        let [a, b, c, d, e, f, g, h] = self.to_array();
        Pair(
            f64x4::new([f64::from(a), f64::from(b), f64::from(c), f64::from(d)]),
            f64x4::new([f64::from(e), f64::from(f), f64::from(g), f64::from(h)]),
        )
    }
    #[inline]
    fn narrow(x: Pair<f64x4>) -> Self {
        let [a, b, c, d] = x.0.to_array();
        let [e, f, g, h] = x.1.to_array();
        f32x8::new([a as f32, b as f32, c as f32, d as f32, e as f32, f as f32, g as f32, h as f32])
    }
}

impl Number for f64x4 {
    #[inline]
    fn mul_add(self, m: Self, a: Self) -> Self {
        f64x4::mul_add(self, m, a)
    }
}

impl Double for f64x4 {
    #[inline]
    fn min(self, o: Self) -> Self {
        self.fast_min(o)
    }
    #[inline]
    fn max(self, o: Self) -> Self {
        self.fast_max(o)
    }
}
