//! A pair of equal types: the halves of a wide f64 vector, or two lane groups in flight.

use super::{Double, Lanes, Number};
use core::ops::{Add, BitAnd, BitOr, Div, Mul, Neg, Not, Sub};

/// Operations apply to both members.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Pair<T>(pub(super) T, pub(super) T);

macro_rules! binary_op {
    ($($Op:ident $op:ident)*) => {$(
        impl<T: $Op<Output = T>> $Op for Pair<T> {
            type Output = Self;
            #[inline]
            fn $op(self, o: Self) -> Self {
                Self(self.0.$op(o.0), self.1.$op(o.1))
            }
        }
    )*};
}
binary_op!(Add add Sub sub Mul mul Div div BitAnd bitand BitOr bitor);

impl<T: Neg<Output = T>> Neg for Pair<T> {
    type Output = Self;
    #[inline]
    fn neg(self) -> Self {
        Self(-self.0, -self.1)
    }
}

impl<T: Not<Output = T>> Not for Pair<T> {
    type Output = Self;
    #[inline]
    fn not(self) -> Self {
        Self(!self.0, !self.1)
    }
}

impl<T: Number> Number for Pair<T> {
    #[inline]
    fn mul_add(self, m: Self, a: Self) -> Self {
        Self(self.0.mul_add(m.0, a.0), self.1.mul_add(m.1, a.1))
    }
}

impl<D: Double> Double for Pair<D> {
    #[inline]
    fn min(self, o: Self) -> Self {
        Self(self.0.min(o.0), self.1.min(o.1))
    }
    #[inline]
    fn max(self, o: Self) -> Self {
        Self(self.0.max(o.0), self.1.max(o.1))
    }
}

impl<V: Lanes> Lanes for Pair<V> {
    type Mask = Pair<V::Mask>;
    type Double = Pair<V::Double>;
    const N: usize = 2 * V::N;

    #[inline]
    fn sqrt(self) -> Self {
        Self(self.0.sqrt(), self.1.sqrt())
    }
    #[inline]
    fn abs(self) -> Self {
        Self(self.0.abs(), self.1.abs())
    }
    #[inline]
    fn min(self, o: Self) -> Self {
        Self(self.0.min(o.0), self.1.min(o.1))
    }
    #[inline]
    fn max(self, o: Self) -> Self {
        Self(self.0.max(o.0), self.1.max(o.1))
    }
    #[inline]
    fn lt(self, o: Self) -> Self::Mask {
        Pair(self.0.lt(o.0), self.1.lt(o.1))
    }
    #[inline]
    fn le(self, o: Self) -> Self::Mask {
        Pair(self.0.le(o.0), self.1.le(o.1))
    }
    #[inline]
    fn eq(self, o: Self) -> Self::Mask {
        Pair(self.0.eq(o.0), self.1.eq(o.1))
    }
    #[inline]
    fn select(m: Self::Mask, yes: Self, no: Self) -> Self {
        Self(V::select(m.0, yes.0, no.0), V::select(m.1, yes.1, no.1))
    }
    #[inline]
    fn only(m: Self::Mask, x: Self) -> Self {
        Self(V::only(m.0, x.0), V::only(m.1, x.1))
    }
    #[inline]
    fn bits(m: Self::Mask) -> u32 {
        V::bits(m.0) | V::bits(m.1) << V::N
    }
    #[cfg_attr(optimized, inline(always))]
    fn pow2(self) -> Self {
        Self(self.0.pow2(), self.1.pow2())
    }
    #[cfg_attr(optimized, inline(always))]
    fn split(self) -> (Self, Self) {
        let ((m_0, e_0), (m_1, e_1)) = (self.0.split(), self.1.split());
        (Self(m_0, m_1), Self(e_0, e_1))
    }
    #[inline]
    fn widen(self) -> Self::Double {
        Pair(self.0.widen(), self.1.widen())
    }
    #[inline]
    fn narrow(d: Self::Double) -> Self {
        Self(V::narrow(d.0), V::narrow(d.1))
    }
    // One member after the other: the factors of both do not fit the registers.
    #[cfg_attr(optimized, inline(always))]
    fn multiply<const P: usize, const Q: usize, const R: usize>(p: &[Self; P], q: &[Self; Q]) -> [Self; R] {
        let (p_0, p_1) = apart(p);
        let (q_0, q_1) = apart(q);
        let (low, high): ([V; R], [V; R]) = (V::multiply(&p_0, &q_0), V::multiply(&p_1, &q_1));
        let mut product = [Self(low[0], high[0]); R];
        let mut k = 1;
        while k < R {
            product[k] = Self(low[k], high[k]);
            k += 1;
        }
        product
    }
}

/// The first members and the second members.
#[cfg_attr(optimized, inline(always))]
fn apart<T: Copy, const K: usize>(pairs: &[Pair<T>; K]) -> ([T; K], [T; K]) {
    let (mut low, mut high) = ([pairs[0].0; K], [pairs[0].1; K]);
    let mut k = 1;
    while k < K {
        low[k] = pairs[k].0;
        high[k] = pairs[k].1;
        k += 1;
    }
    (low, high)
}

#[cfg(test)]
mod tests {
    use super::*;
    use wide::f32x8;

    /// A small whole number, another one in every lane.
    fn number(k: usize) -> Pair<f32x8> {
        let half =
            |first: usize| f32x8::new(std::array::from_fn(|lane| ((7 * k + 3 * (first + lane)) % 17) as f32 - 8.0));
        Pair(half(0), half(8))
    }

    fn lanes(pair: Pair<f32x8>) -> [[f32; 8]; 2] {
        [pair.0.to_array(), pair.1.to_array()]
    }

    /// Products of small whole numbers and their sums are exact.
    #[test]
    fn polynomials_are_multiplied_lane_by_lane() {
        let (p, q): ([_; 4], [_; 6]) = (std::array::from_fn(number), std::array::from_fn(|k| number(k + 20)));
        let product: [_; 9] = Pair::multiply(&p, &q);
        for (k, product) in product.into_iter().enumerate() {
            let mut sum = Pair(f32x8::ZERO, f32x8::ZERO);
            for (i, p) in p.into_iter().enumerate() {
                if let Some(q) = k.checked_sub(i).and_then(|j| q.get(j)) {
                    sum = sum + p * *q;
                }
            }
            assert_eq!(lanes(product), lanes(sum), "degree {k}");
        }
    }
}
