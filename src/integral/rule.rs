//! Gauss and Legendre's rule in a variable in which the integrand is nearly a polynomial.
//!
//! The variable is that of the product densities, with a map of its own. With `X = t' + r` and `Y = X - X_a`,
//!
//! ```text
//! Y = Y_c v/(e + 1 - v)                    e = Y_c/Y_b
//! 1/Y_c = 0.09 mu_t + 1/(2.6 X_a + 0.9 h B/A)
//! v = s + d s (1 - s)                      1/d = 1 + 28 mu_t Y_c + 19 e
//! ```
//!
//! and `s` in `[0, 1]` has the nodes. In a thin medium a long ray ends where the transmittance does, within the last
//! `mu_t Y_c` of `v`: the second map, which is straight elsewhere, draws the last nodes to the end. In all of it sums have
//! positive terms alone, so that nothing cancels.
//!
//! The constants are those with the least errors over the sets `generic`, `dense` and `broad` of `airlight integral`.

use crate::geometry::{Geometry, RayLanes};
use crate::integrand::{Lobe, MediumLanes, transmittance};
use crate::simd::math::one_minus_exp;
use crate::simd::{Isa, Lanes, Number};
use crate::strategy::product::along_v::{AlongV, At, ConeAlongV, Units, x_and_h_over_it};

/// What `1/Y_c` has of `mu_t`, and `Y_c` of `X_a` and of `h B/A`.
const OF_MU_T: f32 = 0.09;
const OF_X_A: f32 = 2.6;
const OF_LOBE: f32 = 0.9;
/// What `1/d` has of `mu_t Y_c`, and of `e`.
const OF_DEPTH: f32 = 28.0;
const OF_E: f32 = 19.0;
/// No length is resolved below this \[m\].
const SHORTEST: f32 = 1e-18;

/// Nodes below 1/2 and their weights, on \[0, 1\].
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

/// A node `s`.
#[derive(Clone, Copy)]
struct Node {
    s: f32,
    to_1: f32,
    weight: f32,
    /// The weight times `1 - 2 s`, by which it grows with `d`: `dv/ds = 1 + d (1 - 2 s)`.
    slope: f32,
}

impl Node {
    const fn new(s: f64, to_1: f64, weight: f64) -> Self {
        Self { s: s as f32, to_1: to_1 as f32, weight: weight as f32, slope: (weight * (to_1 - s)) as f32 }
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

    /// The integral of the integrand over the lit part of the ray \[1/m^2\].
    ///
    /// With `P`, `Q` in place of `h`, `X` in a scale of their own, `A = 1 + g`, `B = 1 - g` and `m = N r`,
    /// `T rho N dt / r^2` is proportional to `E m Q (P^2 + Q^2)^(-1/2) (A^2 Q^2 + B^2 P^2)^(-3/2) dv`.
    #[cfg_attr(optimized, inline(always))]
    pub(crate) fn radiance<I: Isa>(
        isa: I,
        ray: &RayLanes<I>,
        geometry: Geometry<'_, I>,
        medium: &MediumLanes<I>,
    ) -> I::V {
        let c = |x| isa.splat(x);
        let (g, h, one) = (geometry, geometry.foot.h, c(1.0));
        let Lobe { a2, b2, b_over_a, height } = medium.lobe;

        let [r_a, r_b] = [g.foot.r(g.foot.a), g.foot.r(g.foot.b)];
        let inv_h = one / h;
        let (x_a, h_x_a) = x_and_h_over_it(isa, h, inv_h, g.foot.a, r_a);
        let (x_b, h_x_b) = x_and_h_over_it(isa, h, inv_h, g.foot.b, r_b);
        let y_b = g.lit.length * ((x_a + x_b) / (r_a + r_b));
        let reach = x_a.mul_add(c(OF_X_A), c(OF_LOBE) * h * b_over_a);
        let y_c = (one / medium.mu_t.mul_add(c(OF_MU_T), one / reach)).max(c(SHORTEST));
        let depth = medium.mu_t * y_c;
        // 1/(1 + e) and e/(1 + e).
        let inv_sum = one / (y_b + y_c);
        let (w_0, s_b) = (y_b * inv_sum, y_c * inv_sum);
        let d = w_0 / w_0.mul_add(depth.mul_add(c(OF_DEPTH), one), s_b * c(OF_E));

        // Lengths in units of the largest: no power of them leaves f32.
        let inv_size = one / h.max(x_a).max(y_c);
        let (h_c, x_c, y_c_c) = (h * inv_size, x_a * inv_size, y_c * inv_size);
        let units = Units { of_v: w_0 * y_c_c, of_to_1: y_b * inv_size, h_x_a, h_x_b };
        let m_along = AlongV::new(isa, &g.cosine.ramp(isa), g.cosine.m_least * inv_size, &units);
        let cone = ConeAlongV::new(isa, g, inv_size, one, &units);

        let mut sum = c(0.0);
        let mut k = 0;
        while k < K {
            let node = Self::NODES[k];
            let v = d.mul_add(c(node.s * node.to_1), c(node.s));
            let to_1 = c(node.to_1) * d.mul_add(c(-node.s), one);
            let weight = d.mul_add(c(node.slope), c(node.weight));
            // Y/Y_c = w/s.
            let (w, s) = (w_0 * v, w_0.mul_add(to_1, s_b));
            let (_, transmittance) = one_minus_exp(isa, depth * (w / s));

            let p = h_c * s;
            let q = x_c.mul_add(s, y_c_c * w);
            let at = At { v, to_1, scale: s, p, q };
            let m = m_along.at(&at);
            let p2 = p * p;
            let s_1 = q.mul_add(q, p2);
            let s_2 = (a2 * q).mul_add(q, b2 * p2);
            let mut numerator = I::V::select(g.cosine.has_normal, m, s_1);
            if let Some(cone) = &cone {
                numerator = numerator * cone.at(isa, &at, m, s_1);
            }
            sum = (weight * transmittance).mul_add(numerator / (s_2 * (s_1 * s_2).sqrt()), sum);
            k += 1;
        }
        let unit = inv_size * (w_0 * y_c_c) * I::V::select(g.cosine.has_normal, c(4.0), c(2.0));
        let mass = (sum * unit).min(c(f32::MAX));
        let start = transmittance(isa, ray, g, medium, &g.start(isa, r_a));
        (medium.mu_s * start) * (height * mass)
    }
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
