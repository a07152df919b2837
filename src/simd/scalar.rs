//! One lane, without vector instructions: the wide sets with FMA must give the same bits.

use super::{Double, Isa, Lanes, Number};

/// Needs no CPU check; without FMA in the CPU `mul_add` is slow and gives the same bits.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Scalar;

impl Isa for Scalar {
    type V = f32;
    type Mask = bool;
    type Double = f64;
    type Group = f32;
    const FUSED: bool = true;

    #[inline]
    fn splat(self, x: f32) -> f32 {
        x
    }
    #[inline]
    fn splat_double(self, x: f64) -> f64 {
        x
    }
    #[inline]
    fn groups(column: &[f32]) -> &[f32] {
        column
    }
    #[inline]
    fn groups_mut(column: &mut [f32]) -> &mut [f32] {
        column
    }
    #[inline]
    fn load(self, group: &f32) -> f32 {
        *group
    }
    #[inline]
    fn store(self, lanes: f32, group: &mut f32) {
        *group = lanes;
    }
    /// With FMA in the CPU `mul_add` is an instruction instead of a call.
    fn vectorize<H, R>(self, work: impl FnOnce() -> R) -> R {
        #[cfg(all(target_arch = "x86_64", not(test)))]
        if let Some(proof) = super::x86::Avx2::detect() {
            return proof.vectorize::<H, R>(work);
        }
        work()
    }
}

impl Number for f32 {
    #[inline]
    fn mul_add(self, m: Self, a: Self) -> Self {
        f32::mul_add(self, m, a)
    }
}

impl Lanes for f32 {
    type Mask = bool;
    type Double = f64;
    const N: usize = 1;

    #[inline]
    fn sqrt(self) -> Self {
        f32::sqrt(self)
    }
    #[inline]
    fn abs(self) -> Self {
        f32::abs(self)
    }
    #[inline]
    fn min(self, o: Self) -> Self {
        if self < o { self } else { o }
    }
    #[inline]
    fn max(self, o: Self) -> Self {
        if self > o { self } else { o }
    }
    #[inline]
    fn lt(self, o: Self) -> bool {
        self < o
    }
    #[inline]
    fn le(self, o: Self) -> bool {
        self <= o
    }
    #[inline]
    fn eq(self, o: Self) -> bool {
        self == o
    }
    #[inline]
    fn select(m: bool, yes: Self, no: Self) -> Self {
        if m { yes } else { no }
    }
    #[inline]
    fn only(m: bool, x: Self) -> Self {
        if m { x } else { 0.0 }
    }
    #[inline]
    fn bits(m: bool) -> u32 {
        m.into()
    }
    #[inline]
    fn pow2(self) -> Self {
        f32::from_bits(((self + 12_582_912.0).to_bits().wrapping_add(127)) << 23)
    }
    #[inline]
    fn split(self) -> (Self, Self) {
        let bits = self.to_bits() as i32;
        let exponent = bits.wrapping_sub(0x3f35_04f3) >> 23;
        (f32::from_bits(bits.wrapping_sub(exponent << 23) as u32), exponent as f32)
    }
    #[inline]
    fn widen(self) -> f64 {
        self.into()
    }
    #[inline]
    fn narrow(d: f64) -> Self {
        d as f32
    }
}

impl Number for f64 {
    #[inline]
    fn mul_add(self, m: Self, a: Self) -> Self {
        f64::mul_add(self, m, a)
    }
}

impl Double for f64 {
    #[inline]
    fn min(self, o: Self) -> Self {
        if self < o { self } else { o }
    }
    #[inline]
    fn max(self, o: Self) -> Self {
        if self > o { self } else { o }
    }
}
