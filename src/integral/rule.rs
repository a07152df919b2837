//! Gauss and Legendre's rule in a variable in which the integrand is nearly a polynomial.
//!
//! Equations of `docs/mathematics.md`, section 7; `X`, `Y`, `A`, `B`, `m` are those of section 5:
//!
//! ```text
//! 1/Y_c = 0.09 mu_t + 1/(2.6 X_a + 0.9 h B/A),   e = Y_c/Y_b                         (7.1)
//! v = z + d z (1 - z),   1/d = 1 + 28 mu_t Y_c + 19 e                                (7.2)
//! Y = Y_c v/(e + 1 - v)                                                              (6.3)
//! L = mu_s exp(-mu_t (t_a - t_min + r_a)) (1 - g^2)/(4 pi)
//!     Sum_k w_k (1 + d (1 - 2 z_k)) exp(-mu_t Y) F(X) Y_c (1 + e)/(e + 1 - v)^2      (7.3)
//! F: 4 m X (X^2 + h^2)^(-1/2) (A^2 X^2 + B^2 h^2)^(-3/2), by (6.9), (6.10)           (5.12)
//!    2 (X^2 + h^2)^(1/2) (A^2 X^2 + B^2 h^2)^(-3/2)  without a normal                (5.13)
//! ```
//!
//! In a thin medium a long ray ends where the transmittance does, within the last `mu_t Y_c` of `v`: (7.2) moves the last nodes
//! towards the end, and is straight elsewhere. All terms are positive, so that nothing cancels. The constants are those with the
//! least errors over the sets `generic`, `dense` and `broad` of `airlight integral`.
//!
//! Departures from this, and why:
//!
//! 1. `share = (e + 1 - v)/(1 + e)` stands for `e + 1 - v`, and `w_0 = 1/(1 + e)`, `s_b = e/(1 + e)`: finite for `e` of any size.
//! 2. Lengths are in units of the largest of `h`, `X_a`, `Y_c`: no power of them leaves f32.
//! 3. `Y_c` is at least 1e-18 m, and the sum at most `f32::MAX`.

use crate::geometry::{Geometry, RayLanes};
use crate::integrand::{Lobe, MediumLanes, transmittance};
use crate::simd::math::one_minus_exp;
use crate::simd::{Isa, Lanes, Number};
use crate::strategy::product::along_v::{AlongV, At, ConeAlongV, Units, x_and_h_over_it};

/// The factors of `mu_t`, `X_a` and `h B/A` in (7.1).
const OF_MU_T: f32 = 0.09;
const OF_X_A: f32 = 2.6;
const OF_LOBE: f32 = 0.9;
/// The factors of `mu_t Y_c` and of `e` in (7.2).
const OF_DEPTH: f32 = 28.0;
const OF_E: f32 = 19.0;
/// The least `Y_c` \[m\].
const SHORTEST: f32 = 1e-18;

/// The nodes below 1/2 on \[0, 1\], and their weights.
const FOUR: [[f64; 2]; 2] =
    [[0.069_431_844_202_973_71, 0.173_927_422_568_726_93], [0.330_009_478_207_571_87, 0.326_072_577_431_273_07]];
const SIX: [[f64; 2]; 3] = [
    [0.033_765_242_898_423_99, 0.085_662_246_189_585_17],
    [0.169_395_306_766_867_74, 0.180_380_786_524_069_3],
    [0.380_690_406_958_401_55, 0.233_956_967_286_345_52],
];
const EIGHT: [[f64; 2]; 4] = [
    [0.019_855_071_751_231_88, 0.050_614_268_145_188_13],
    [0.101_666_761_293_186_63, 0.111_190_517_226_687_24],
    [0.237_233_795_041_835_5, 0.156_853_322_938_943_64],
    [0.408_282_678_752_175_1, 0.181_341_891_689_181],
];
const TWELVE: [[f64; 2]; 6] = [
    [0.009_219_682_876_640_37, 0.023_587_668_193_255_91],
    [0.047_941_371_814_762_57, 0.053_469_662_997_659_22],
    [0.115_048_662_902_847_66, 0.080_039_164_271_673_11],
    [0.206_341_022_856_691_3, 0.101_583_713_361_532_96],
    [0.316_084_250_500_909_9, 0.116_746_268_269_177_4],
    [0.437_383_295_744_265_54, 0.124_573_522_906_701_39],
];

/// A node and its weight.
#[derive(Clone, Copy)]
struct Node {
    /// `z_k`
    s: f32,
    /// `1 - z_k`
    to_1: f32,
    /// `w_k`
    weight: f32,
    /// `w_k (1 - 2 z_k)`: `dv/dz = 1 + d (1 - 2 z)`.
    slope: f32,
}

impl Node {
    const fn new(s: f64, to_1: f64, weight: f64) -> Self {
        Self { s: s as f32, to_1: to_1 as f32, weight: weight as f32, slope: (weight * (to_1 - s)) as f32 }
    }
}

/// The variable `v` of a lane group, and what goes with it.
#[derive(Clone, Copy)]
pub(crate) struct Variable<I: Isa> {
    /// `r` and `X` at the start.
    r_a: I::V,
    x_a: I::V,
    /// `h/X` at the ends.
    h_x_a: I::V,
    h_x_b: I::V,
    y_b: I::V,
    y_c: I::V,
    /// `1/(1 + e)`, `e/(1 + e)`.
    w_0: I::V,
    s_b: I::V,
    d: I::V,
    /// The reciprocal of the largest of `h`, `X_a` and `Y_c`.
    inv_size: I::V,
}

impl<I: Isa> Variable<I> {
    /// (1.3): the transmittance from `t_min` over the start of the lit part to the emitter.
    #[cfg_attr(optimized, inline(always))]
    pub(crate) fn start<const EXACT: bool>(
        &self,
        isa: I,
        ray: &RayLanes<I>,
        geometry: Geometry<'_, I>,
        medium: &MediumLanes<I>,
    ) -> I::V {
        transmittance::<I, EXACT>(isa, ray, geometry, medium, &geometry.start(isa, self.r_a))
    }
}

/// The rule with `K` nodes.
pub(crate) struct Rule<const K: usize>;

impl<const K: usize> Rule<K> {
    const NODES: [Node; K] = {
        let half: &[[f64; 2]] = match K {
            4 => &FOUR,
            6 => &SIX,
            8 => &EIGHT,
            _ => &TWELVE,
        };
        assert!(2 * half.len() == K);
        let mut nodes = [Node::new(0.0, 0.0, 0.0); K];
        let mut k = 0;
        while k < half.len() {
            let [s, weight] = half[k];
            nodes[k] = Node::new(s, 1.0 - s, weight);
            nodes[K - 1 - k] = Node::new(1.0 - s, s, weight);
            k += 1;
        }
        nodes
    };

    /// (7.1), (7.2).
    #[cfg_attr(optimized, inline(always))]
    pub(crate) fn variable<I: Isa>(isa: I, geometry: Geometry<'_, I>, medium: &MediumLanes<I>) -> Variable<I> {
        let c = |x| isa.splat(x);
        let (g, h, one) = (geometry, geometry.foot.h, c(1.0));
        let b_over_a = medium.lobe.b_over_a;

        // X at the ends (5.7), Y_b (5.8), Y_c (7.1).
        let [r_a, r_b] = [g.foot.r(g.foot.a), g.foot.r(g.foot.b)];
        let inv_h = one / h;
        let (x_a, h_x_a) = x_and_h_over_it(isa, h, inv_h, g.foot.a, r_a);
        let (x_b, h_x_b) = x_and_h_over_it(isa, h, inv_h, g.foot.b, r_b);
        let y_b = g.lit.length * ((x_a + x_b) / (r_a + r_b));
        let reach = x_a.mul_add(c(OF_X_A), c(OF_LOBE) * h * b_over_a);
        let y_c = (one / medium.mu_t.mul_add(c(OF_MU_T), one / reach)).max(c(SHORTEST));
        // 1/(1 + e), e/(1 + e), and d (7.2).
        let inv_sum = one / (y_b + y_c);
        let (w_0, s_b) = (y_b * inv_sum, y_c * inv_sum);
        let d = w_0 / w_0.mul_add((medium.mu_t * y_c).mul_add(c(OF_DEPTH), one), s_b * c(OF_E));
        let inv_size = one / h.max(x_a).max(y_c);
        Variable { r_a, x_a, h_x_a, h_x_b, y_b, y_c, w_0, s_b, d, inv_size }
    }

    /// (7.3): the integral of the integrand over the lit part of the ray \[1/m^2\], given the transmittance at its `start`.
    #[cfg_attr(optimized, inline(always))]
    pub(crate) fn radiance<I: Isa>(
        isa: I,
        geometry: Geometry<'_, I>,
        medium: &MediumLanes<I>,
        variable: &Variable<I>,
        start: I::V,
    ) -> I::V {
        let c = |x| isa.splat(x);
        let (g, h, one) = (geometry, geometry.foot.h, c(1.0));
        let Lobe { a2, b2, height, .. } = medium.lobe;
        let Variable { x_a, h_x_a, h_x_b, y_b, y_c, w_0, s_b, d, inv_size, .. } = *variable;
        let depth = medium.mu_t * y_c;

        // h, X_a and Y_c over the largest of them.
        let (h_unit, x_unit, y_c_unit) = (h * inv_size, x_a * inv_size, y_c * inv_size);
        let units = Units { of_v: w_0 * y_c_unit, of_to_1: y_b * inv_size, h_x_a, h_x_b };
        let m_along = AlongV::new(isa, &g.cosine.ramp(isa), g.cosine.m_least * inv_size, &units);
        let cone = ConeAlongV::new(isa, g, inv_size, one, &units);

        let mut sum = c(0.0);
        let mut k = 0;
        while k < K {
            // (7.2), and w_k (1 + d (1 - 2 z_k))
            let node = Self::NODES[k];
            let v = d.mul_add(c(node.s * node.to_1), c(node.s));
            let to_1 = c(node.to_1) * d.mul_add(c(-node.s), one);
            let weight = d.mul_add(c(node.slope), c(node.weight));
            // Y/Y_c = w/share (6.3)
            let (w, share) = (w_0 * v, w_0.mul_add(to_1, s_b));
            let (_, transmittance) = one_minus_exp(isa, depth * (w / share));

            // P, Q, m X s^2 (6.9) over (1 + e), (1 + e), (1 + e)^2; P^2 + Q^2 and A^2 Q^2 + B^2 P^2.
            let p = h_unit * share;
            let q = x_unit.mul_add(share, y_c_unit * w);
            let at = At { v, to_1, scale: share, p, q };
            let m = m_along.at(&at);
            let p2 = p * p;
            let squares = q.mul_add(q, p2);
            let lobe = (a2 * q).mul_add(q, b2 * p2);
            let mut numerator = I::V::select(g.cosine.has_normal, m, squares);
            if let Some(cone) = &cone {
                numerator = numerator * cone.at(isa, &at, m, squares);
            }
            // (6.10)
            sum = (weight * transmittance).mul_add(numerator / (lobe * (squares * lobe).sqrt()), sum);
            k += 1;
        }
        // The units, Y_c/(1 + e), and the 4 of (5.12) or the 2 of (5.13).
        let unit = inv_size * (w_0 * y_c_unit) * I::V::select(g.cosine.has_normal, c(4.0), c(2.0));
        let mass = (sum * unit).min(c(f32::MAX));
        product(isa, medium.mu_s, start, height * mass)
    }
}

/// `a share c`, at most `f32::MAX`, with `share` in \[0, 1\] and the others at least 0. No intermediate result leaves f32 before the
/// product does: if the larger of `a` and `c` is at least 1, the first product is at least `share`; else all are below 1, and it is
/// at least the result.
#[cfg_attr(optimized, inline(always))]
fn product<I: Isa>(isa: I, a: I::V, share: I::V, c: I::V) -> I::V {
    let most = isa.splat(f32::MAX);
    let (large, small) = (a.max(c).min(most), a.min(c).min(most));
    ((large * share) * small).min(most)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn assert_exact<const K: usize>() {
        let integral = |degree: usize| {
            Rule::<K>::NODES.iter().map(|node| f64::from(node.weight) * f64::from(node.s).powi(degree as i32)).sum()
        };
        for degree in 0..2 * K {
            let (sum, expected): (f64, f64) = (integral(degree), 1.0 / (degree + 1) as f64);
            // Nodes and weights are rounded to f32: half an ulp of each factor, at most.
            let rounding = (degree + 1) as f64 * f64::from(f32::EPSILON) / 2.0;
            assert!((sum / expected - 1.0).abs() <= rounding, "{K} nodes, degree {degree}: {sum} is not {expected}");
        }
        assert!(K > 4 || (integral(2 * K) - 1.0 / (2 * K + 1) as f64).abs() > 1e-5, "{K} nodes, beyond the degree");
    }

    #[test]
    fn the_rules_are_exact_for_polynomials_of_their_degree() {
        assert_exact::<4>();
        assert_exact::<6>();
        assert_exact::<8>();
        assert_exact::<12>();
    }
}
