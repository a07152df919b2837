//! `p(theta)` proportional to `N = alpha cos theta + beta sin theta`, (21), or uniform for an emitter without normal.
//!
//! With `S = alpha sin theta - beta cos theta`, an antiderivative of N, the CDF from an end is `D = S - S_e` over the
//! mass `S_b - S_a`, and `N^2 = N_e^2 - D (2 S_e + D)`. The angle from that end has `tan(delta/2) = D / (N + N_e)`.

use crate::density::{self, Density, Drawn, Pdf};
use crate::geometry::{Geometry, Point};
use crate::integrand::MediumLanes;
use crate::simd::math::tan;
use crate::simd::{Isa, Lanes, Number, none};

pub(crate) struct Kind;

impl density::Kind for Kind {
    type On<I: Isa> = PointNormal<I>;
}

pub(crate) struct PointNormal<I: Isa> {
    /// `S` at the ends, counted towards the interval.
    s_a: I::V,
    s_b: I::V,
    /// The integral of N over `theta`; without a normal the angle itself.
    mass: I::V,
    /// Up to which variate the mass is measured from `a`.
    turn: I::V,
}

/// The integral of N between two angles, given N and S at both and `tan_half` of their difference.
///
/// The product is exact for narrow intervals; `wide` ones, beyond a right angle, take the difference.
#[cfg_attr(optimized, inline(always))]
pub(crate) fn mass_of_cosine<I: Isa>(n: [I::V; 2], s: [I::V; 2], tan_half: I::V, wide: I::Mask) -> I::V {
    I::V::select(wide, s[1] - s[0], (n[0] + n[1]) * tan_half)
}

/// `tan(delta/2)` of the angle from an end within which N has the integral `mass`.
#[cfg_attr(optimized, inline(always))]
pub(crate) fn tan_half_at_mass<I: Isa>(isa: I, n_end: I::V, s_end: I::V, mass: I::V) -> I::V {
    let c = |x| isa.splat(x);
    // Of a ray along the emitter's plane they are all so small that their squares leave f32.
    let unit = I::V::select((n_end + s_end.abs()).lt(c(SMALL)), c(LARGE), c(1.0));
    let (n_end, s_end, mass) = (n_end * unit, s_end * unit, mass * unit);
    let n = n_end.mul_add(n_end, -(mass * (s_end + s_end + mass))).max(c(0.0)).sqrt();
    mass / (n + n_end).max(c(1e-37))
}
/// Powers of two, so that no bit is rounded.
const SMALL: f32 = 1.0 / (1 << 20) as f32;
const LARGE: f32 = (1u64 << 60) as f32;

/// The least share of the mass between a sample and an end of the interval.
pub(crate) const NEAREST: f32 = 1e-12;

impl<I: Isa> Density<I> for PointNormal<I> {
    #[cfg_attr(optimized, inline(always))]
    fn new(isa: I, geometry: &Geometry<I>, _: &MediumLanes<I>) -> Self {
        let g = geometry;
        let [s_a, s_b] = [g.antiderivative(&g.a), g.antiderivative(&g.b)];
        let dot = g.dot_of_ends();
        let tan_half = (g.h * g.length) / g.a.r.mul_add(g.b.r, dot);
        let wide = dot.lt(isa.splat(0.0));
        let mut mass = mass_of_cosine::<I>([g.a.n, g.b.n], [s_a, s_b], tan_half, wide);
        // The mass of half of the angle, were N straight between the ends; from a dark end half of the mass is most of it.
        // It is not where the interval is wide, but there half of the mass is within a right angle of either end.
        let sum = g.a.n + g.b.n;
        let half_way = (g.a.n + g.a.n + sum) / (isa.splat(4.0) * sum);
        let turn = I::V::select(wide, isa.splat(0.5), half_way + g.bias_to_a(isa));
        if I::V::bits(!g.has_normal) != 0 {
            mass = I::V::select(g.has_normal, mass, g.subtended(isa));
        }
        Self { s_a, s_b: -s_b, mass, turn }
    }

    #[cfg_attr(optimized, inline(always))]
    fn invert(&self, isa: I, geometry: &Geometry<I>, u: I::V) -> Drawn<I> {
        let g = geometry;
        let rest = isa.splat(1.0) - u;
        let from_a = u.le(self.turn);
        // Off the very end, where N may be 0.
        let mass = self.mass * I::V::select(from_a, u, rest).max(isa.splat(NEAREST));
        let n_end = I::V::select(from_a, g.a.n, g.b.n);
        let s_end = I::V::select(from_a, self.s_a, self.s_b);
        let mut tan_half = tan_half_at_mass(isa, n_end, s_end, mass);
        if I::V::bits(!g.has_normal) != 0 {
            tan_half = I::V::select(g.has_normal, tan_half, tan(isa, isa.splat(0.5) * mass));
        }
        let point = g.point_at_angle(isa, from_a, tan_half);
        let pdf = self.pdf(isa, g, &point);
        Drawn { point, pdf, bisected: none(isa) }
    }

    #[cfg_attr(optimized, inline(always))]
    fn lit(isa: I, geometry: &Geometry<I>) -> I::Mask {
        geometry.lit & geometry.bright(isa)
    }

    #[cfg_attr(optimized, inline(always))]
    fn pdf(&self, isa: I, geometry: &Geometry<I>, point: &Point<I>) -> Pdf<I> {
        Pdf::over_angle(geometry.cosine(isa, point) / self.mass, geometry, point)
    }
}
