//! 16 lanes of AVX-512.

use super::{operators, proven, token};
use crate::simd::pair::Pair;
use crate::simd::{Double, Isa, Lanes, Number};
use core::arch::x86_64::*;
use core::ops::{Add, Div, Mul, Neg, Sub};

/// Proof of AVX-512 with its extension DQ, of VL (compilers use it for narrower values), and of AVX2, FMA and POPCNT.
#[derive(Clone, Copy, Debug)]
pub(in crate::simd) struct Avx512(());
token!(Avx512: "avx512f,avx512dq,avx512vl,avx2,fma,popcnt", detected "avx512f" "avx512dq" "avx512vl" "avx2" "fma" "popcnt");

#[derive(Clone, Copy)]
pub(crate) struct F32x16(__m512);
operators!(F32x16: Add add _mm512_add_ps, Sub sub _mm512_sub_ps, Mul mul _mm512_mul_ps, Div div _mm512_div_ps);

#[derive(Clone, Copy)]
pub(crate) struct F64x8(__m512d);
operators!(F64x8: Add add _mm512_add_pd, Sub sub _mm512_sub_pd, Mul mul _mm512_mul_pd);

impl Isa for Avx512 {
    type V = F32x16;
    type Mask = __mmask16;
    type Double = Pair<F64x8>;
    type Group = [f32; 16];
    const FUSED: bool = true;

    #[inline]
    fn splat(self, x: f32) -> F32x16 {
        F32x16(proven!(_mm512_set1_ps(x)))
    }
    #[inline]
    fn splat_double(self, x: f64) -> Pair<F64x8> {
        let x = F64x8(proven!(_mm512_set1_pd(x)));
        Pair(x, x)
    }
    #[inline]
    fn groups(column: &[f32]) -> &[[f32; 16]] {
        column.as_chunks().0
    }
    #[inline]
    fn groups_mut(column: &mut [f32]) -> &mut [[f32; 16]] {
        column.as_chunks_mut().0
    }
    #[inline]
    fn load(self, group: &[f32; 16]) -> F32x16 {
        F32x16(proven!(_mm512_loadu_ps(group.as_ptr())))
    }
    #[inline]
    fn store(self, lanes: F32x16, group: &mut [f32; 16]) {
        proven!(_mm512_storeu_ps(group.as_mut_ptr(), lanes.0));
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

impl Neg for F32x16 {
    type Output = Self;
    #[inline]
    fn neg(self) -> Self {
        Self(proven!(_mm512_xor_ps(self.0, _mm512_set1_ps(-0.0))))
    }
}

impl Number for F32x16 {
    #[inline]
    fn mul_add(self, m: Self, a: Self) -> Self {
        Self(proven!(_mm512_fmadd_ps(self.0, m.0, a.0)))
    }
}

impl Lanes for F32x16 {
    type Mask = __mmask16;
    type Double = Pair<F64x8>;
    const N: usize = 16;

    #[inline]
    fn sqrt(self) -> Self {
        Self(proven!(_mm512_sqrt_ps(self.0)))
    }
    #[inline]
    fn abs(self) -> Self {
        Self(proven!(_mm512_abs_ps(self.0)))
    }
    #[inline]
    fn min(self, o: Self) -> Self {
        Self(proven!(_mm512_min_ps(self.0, o.0)))
    }
    #[inline]
    fn max(self, o: Self) -> Self {
        Self(proven!(_mm512_max_ps(self.0, o.0)))
    }
    #[inline]
    fn lt(self, o: Self) -> __mmask16 {
        proven!(_mm512_cmp_ps_mask::<_CMP_LT_OQ>(self.0, o.0))
    }
    #[inline]
    fn le(self, o: Self) -> __mmask16 {
        proven!(_mm512_cmp_ps_mask::<_CMP_LE_OQ>(self.0, o.0))
    }
    #[inline]
    fn eq(self, o: Self) -> __mmask16 {
        proven!(_mm512_cmp_ps_mask::<_CMP_EQ_OQ>(self.0, o.0))
    }
    #[inline]
    fn select(m: __mmask16, yes: Self, no: Self) -> Self {
        Self(proven!(_mm512_mask_blend_ps(m, no.0, yes.0)))
    }
    #[inline]
    fn only(m: __mmask16, x: Self) -> Self {
        Self(proven!(_mm512_maskz_mov_ps(m, x.0)))
    }
    #[inline]
    fn bits(m: __mmask16) -> u32 {
        m.into()
    }
    #[inline]
    fn pow2(self) -> Self {
        let n = self + Self(proven!(_mm512_set1_ps(12_582_912.0)));
        Self(proven!(_mm512_castsi512_ps(_mm512_slli_epi32::<23>(_mm512_add_epi32(
            _mm512_castps_si512(n.0),
            _mm512_set1_epi32(127)
        )))))
    }
    #[inline]
    fn split(self) -> (Self, Self) {
        let bits = proven!(_mm512_castps_si512(self.0));
        let exponent = proven!(_mm512_srai_epi32::<23>(_mm512_sub_epi32(bits, _mm512_set1_epi32(0x3f35_04f3))));
        let significand = proven!(_mm512_sub_epi32(bits, _mm512_slli_epi32::<23>(exponent)));
        (Self(proven!(_mm512_castsi512_ps(significand))), Self(proven!(_mm512_cvtepi32_ps(exponent))))
    }
    #[inline]
    fn widen(self) -> Pair<F64x8> {
        Pair(
            F64x8(proven!(_mm512_cvtps_pd(_mm512_castps512_ps256(self.0)))),
            F64x8(proven!(_mm512_cvtps_pd(_mm512_extractf32x8_ps::<1>(self.0)))),
        )
    }
    #[inline]
    fn narrow(d: Pair<F64x8>) -> Self {
        let low = proven!(_mm512_castps256_ps512(_mm512_cvtpd_ps(d.0.0)));
        Self(proven!(_mm512_insertf32x8::<1>(low, _mm512_cvtpd_ps(d.1.0))))
    }
}

impl Neg for F64x8 {
    type Output = Self;
    #[inline]
    fn neg(self) -> Self {
        Self(proven!(_mm512_xor_pd(self.0, _mm512_set1_pd(-0.0))))
    }
}

impl Number for F64x8 {
    #[inline]
    fn mul_add(self, m: Self, a: Self) -> Self {
        Self(proven!(_mm512_fmadd_pd(self.0, m.0, a.0)))
    }
}

impl Double for F64x8 {
    #[inline]
    fn min(self, o: Self) -> Self {
        Self(proven!(_mm512_min_pd(self.0, o.0)))
    }
    #[inline]
    fn max(self, o: Self) -> Self {
        Self(proven!(_mm512_max_pd(self.0, o.0)))
    }
}
