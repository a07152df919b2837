//! 8 lanes of AVX2 with FMA.

use super::{operators, proven, token};
use crate::simd::pair::Pair;
use crate::simd::{Double, Isa, Lanes, Number};
use core::arch::x86_64::*;
use core::ops::{Add, BitAnd, BitOr, Div, Mul, Neg, Not, Sub};

/// Proof of AVX2, FMA and POPCNT.
#[derive(Clone, Copy, Debug)]
pub(in crate::simd) struct Avx2(());
token!(Avx2: "avx2,fma,popcnt", detected "avx2" "fma" "popcnt");

#[derive(Clone, Copy)]
pub(crate) struct F32x8(__m256);
operators!(F32x8: Add add _mm256_add_ps, Sub sub _mm256_sub_ps, Mul mul _mm256_mul_ps, Div div _mm256_div_ps);

#[derive(Clone, Copy)]
pub(crate) struct F64x4(__m256d);
operators!(F64x4: Add add _mm256_add_pd, Sub sub _mm256_sub_pd, Mul mul _mm256_mul_pd);

/// A mask: all bits of a lane are set, or none.
#[derive(Clone, Copy)]
pub(crate) struct Mask8(__m256);
operators!(Mask8: BitAnd bitand _mm256_and_ps, BitOr bitor _mm256_or_ps);

impl Not for Mask8 {
    type Output = Self;
    #[inline]
    fn not(self) -> Self {
        Self(proven!(_mm256_xor_ps(self.0, _mm256_castsi256_ps(_mm256_set1_epi32(-1)))))
    }
}

impl Isa for Avx2 {
    type V = F32x8;
    type Mask = Mask8;
    type Double = Pair<F64x4>;
    type Group = [f32; 8];
    const FUSED: bool = true;

    #[inline]
    fn splat(self, x: f32) -> F32x8 {
        F32x8(proven!(_mm256_set1_ps(x)))
    }
    #[inline]
    fn splat_double(self, x: f64) -> Pair<F64x4> {
        let x = F64x4(proven!(_mm256_set1_pd(x)));
        Pair(x, x)
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
    fn load(self, group: &[f32; 8]) -> F32x8 {
        F32x8(proven!(_mm256_loadu_ps(group.as_ptr())))
    }
    #[inline]
    fn store(self, lanes: F32x8, group: &mut [f32; 8]) {
        proven!(_mm256_storeu_ps(group.as_mut_ptr(), lanes.0));
    }
    #[inline]
    fn prefetch(self, group: &Self::Group, ahead: usize) {
        // A prefetch does not fault, wherever it points.
        proven!(_mm_prefetch::<_MM_HINT_T0>(core::ptr::from_ref(group).wrapping_add(ahead).cast()));
    }
    fn vectorize<H, R>(self, work: impl FnOnce() -> R) -> R {
        // SAFETY: `self` proves that the CPU has the features.
        unsafe { H::vectorized(work) }
    }
}

impl Neg for F32x8 {
    type Output = Self;
    #[inline]
    fn neg(self) -> Self {
        Self(proven!(_mm256_xor_ps(self.0, _mm256_set1_ps(-0.0))))
    }
}

impl Number for F32x8 {
    #[inline]
    fn mul_add(self, m: Self, a: Self) -> Self {
        Self(proven!(_mm256_fmadd_ps(self.0, m.0, a.0)))
    }
}

impl Lanes for F32x8 {
    type Mask = Mask8;
    type Double = Pair<F64x4>;
    const N: usize = 8;

    #[inline]
    fn sqrt(self) -> Self {
        Self(proven!(_mm256_sqrt_ps(self.0)))
    }
    #[inline]
    fn abs(self) -> Self {
        Self(proven!(_mm256_andnot_ps(_mm256_set1_ps(-0.0), self.0)))
    }
    #[inline]
    fn min(self, o: Self) -> Self {
        Self(proven!(_mm256_min_ps(self.0, o.0)))
    }
    #[inline]
    fn max(self, o: Self) -> Self {
        Self(proven!(_mm256_max_ps(self.0, o.0)))
    }
    #[inline]
    fn lt(self, o: Self) -> Mask8 {
        Mask8(proven!(_mm256_cmp_ps::<_CMP_LT_OQ>(self.0, o.0)))
    }
    #[inline]
    fn le(self, o: Self) -> Mask8 {
        Mask8(proven!(_mm256_cmp_ps::<_CMP_LE_OQ>(self.0, o.0)))
    }
    #[inline]
    fn eq(self, o: Self) -> Mask8 {
        Mask8(proven!(_mm256_cmp_ps::<_CMP_EQ_OQ>(self.0, o.0)))
    }
    #[inline]
    fn select(m: Mask8, yes: Self, no: Self) -> Self {
        Self(proven!(_mm256_blendv_ps(no.0, yes.0, m.0)))
    }
    #[inline]
    fn only(m: Mask8, x: Self) -> Self {
        Self(proven!(_mm256_and_ps(m.0, x.0)))
    }
    #[inline]
    fn bits(m: Mask8) -> u32 {
        proven!(_mm256_movemask_ps(m.0)) as u32
    }
    #[inline]
    fn pow2(self) -> Self {
        let n = self + Self(proven!(_mm256_set1_ps(12_582_912.0)));
        Self(proven!(_mm256_castsi256_ps(_mm256_slli_epi32::<23>(_mm256_add_epi32(
            _mm256_castps_si256(n.0),
            _mm256_set1_epi32(127)
        )))))
    }
    #[inline]
    fn split(self) -> (Self, Self) {
        let bits = proven!(_mm256_castps_si256(self.0));
        let exponent = proven!(_mm256_srai_epi32::<23>(_mm256_sub_epi32(bits, _mm256_set1_epi32(0x3f35_04f3))));
        let significand = proven!(_mm256_sub_epi32(bits, _mm256_slli_epi32::<23>(exponent)));
        (Self(proven!(_mm256_castsi256_ps(significand))), Self(proven!(_mm256_cvtepi32_ps(exponent))))
    }
    #[inline]
    fn widen(self) -> Pair<F64x4> {
        Pair(
            F64x4(proven!(_mm256_cvtps_pd(_mm256_castps256_ps128(self.0)))),
            F64x4(proven!(_mm256_cvtps_pd(_mm256_extractf128_ps::<1>(self.0)))),
        )
    }
    #[inline]
    fn narrow(d: Pair<F64x4>) -> Self {
        Self(proven!(_mm256_set_m128(_mm256_cvtpd_ps(d.1.0), _mm256_cvtpd_ps(d.0.0))))
    }
}

impl Neg for F64x4 {
    type Output = Self;
    #[inline]
    fn neg(self) -> Self {
        Self(proven!(_mm256_xor_pd(self.0, _mm256_set1_pd(-0.0))))
    }
}

impl Number for F64x4 {
    #[inline]
    fn mul_add(self, m: Self, a: Self) -> Self {
        Self(proven!(_mm256_fmadd_pd(self.0, m.0, a.0)))
    }
}

impl Double for F64x4 {
    #[inline]
    fn min(self, o: Self) -> Self {
        Self(proven!(_mm256_min_pd(self.0, o.0)))
    }
    #[inline]
    fn max(self, o: Self) -> Self {
        Self(proven!(_mm256_max_pd(self.0, o.0)))
    }
}
