//! `p(theta)` proportional to `N = alpha cos theta + beta sin theta`, (21), or uniform for an emitter without normal.
//!
//! With `S = alpha sin theta - beta cos theta`, an antiderivative of N, the CDF from an end is `D = S - S_e` over the
//! mass `S_b - S_a`, and `N^2 = N_e^2 - D (2 S_e + D)`. The angle from that end has `tan(delta/2) = D / (N + N_e)`.

use crate::density::{self, Density, Drawn, Pdf, SetUp};
use crate::geometry::{Angle, Extent, Geometry, Point, RayLanes};
use crate::integrand::{ChannelLanes, MediumLanes};
use crate::simd::math::{angle_of, tan};
use crate::simd::{Isa, Lanes, Number, Records, none};

pub(crate) struct Kind;

impl density::Kind for Kind {
    type On<I: Isa> = PointNormal<I>;
}

#[derive(Clone, Copy)]
pub(crate) struct PointNormal<I: Isa> {
    /// N at the ends.
    n_a: I::V,
    n_b: I::V,
    /// `S` there, counted towards the interval.
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
    const EXTENT: Extent = Extent::Cosine;
    type Place = Angle<I>;
    type SetUps = Records<SetUp<I, Self>>;

    #[cfg_attr(optimized, inline(always))]
    fn new(
        isa: I,
        _: &RayLanes<I>,
        geometry: Geometry<'_, I>,
        _: &MediumLanes<I>,
        _: Option<&ChannelLanes<I>>,
    ) -> (Self, I::Mask) {
        let g = geometry;
        let ends = g.ends(isa);
        let ([n_a, n_b], [s_a, s_b]) = (ends.n, g.antiderivatives(&ends));
        let dot = g.dot_of_ends();
        let tan_half = (g.foot.h * g.lit.length) / ends.r[0].mul_add(ends.r[1], dot);
        let wide = dot.lt(isa.splat(0.0));
        let mut mass = mass_of_cosine::<I>([n_a, n_b], [s_a, s_b], tan_half, wide);
        // The mass of half of the angle, were N straight between the ends; from a dark end half of the mass is most of it.
        // It is not where the interval is wide, but there half of the mass is within a right angle of either end.
        let sum = n_a + n_b;
        let half_way = (n_a + n_a + sum) / (isa.splat(4.0) * sum);
        let turn = I::V::select(wide, isa.splat(0.5), half_way + g.bias_to_a(isa));
        if I::V::bits(!g.cosine.has_normal) != 0 {
            mass = I::V::select(g.cosine.has_normal, mass, g.subtended(isa));
        }
        let lit = g.lit(isa) & g.bright(isa, &ends);
        (Self { n_a, n_b, s_a, s_b: -s_b, mass, turn }, lit)
    }

    #[cfg_attr(optimized, inline(always))]
    fn draw(&self, isa: I, geometry: Geometry<'_, I>, u: I::V) -> Angle<I> {
        let rest = isa.splat(1.0) - u;
        let from_a = u.le(self.turn);
        // Off the very end, where N may be 0.
        let mass = self.mass * I::V::select(from_a, u, rest).max(isa.splat(NEAREST));
        let n_end = I::V::select(from_a, self.n_a, self.n_b);
        let s_end = I::V::select(from_a, self.s_a, self.s_b);
        let mut tan_half = tan_half_at_mass(isa, n_end, s_end, mass);
        if I::V::bits(!geometry.cosine.has_normal) != 0 {
            tan_half = I::V::select(geometry.cosine.has_normal, tan_half, tan(isa, isa.splat(0.5) * mass));
        }
        Angle { from_a, tan_half }
    }

    #[cfg_attr(optimized, inline(always))]
    fn point(&self, isa: I, geometry: Geometry<'_, I>, angle: &Angle<I>) -> Drawn<I> {
        let point = geometry.point_at_angle(isa, angle);
        Drawn { point, pdf: self.pdf(isa, geometry, &point), bisected: none(isa) }
    }

    #[cfg_attr(optimized, inline(always))]
    fn pdf(&self, isa: I, geometry: Geometry<'_, I>, point: &Point<I>) -> Pdf<I> {
        Pdf::over_angle(geometry.cosine(isa, point), self.mass, geometry, point)
    }

    #[cfg_attr(optimized, inline(always))]
    fn cdf(&self, isa: I, geometry: Geometry<'_, I>, point: &Point<I>) -> I::V {
        let g = geometry;
        let [across, along] = g.seen_from(isa, !none(isa), point);
        let tan_half = across / g.foot.r(g.foot.a).mul_add(point.r, along);
        let (n, s) = (g.cosine(isa, point), g.antiderivative(point.t_prime, point.r));
        let cosines = mass_of_cosine::<I>([self.n_a, n], [self.s_a, s], tan_half, along.lt(isa.splat(0.0)));
        I::V::select(g.cosine.has_normal, cosines, angle_of(isa, across, along)) / self.mass
    }
}
