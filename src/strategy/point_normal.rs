//! Proportional to `N/r^2`; of an emitter without a normal the equi-angular density.
//!
//! Equations of `docs/mathematics.md`, with its `M` and `G` as `S` and `D`. `N = alpha cos theta + beta sin theta`, and
//! `S = alpha sin theta - beta cos theta` is an antiderivative of it, counted towards the interval from an end `e`:
//!
//! ```text
//! mass = S_b - S_a = (N_a + N_b) tan(Theta/2)                              (3.6)
//! D = u mass from a, or (1 - u) mass from b                                (3.7)
//! N^2 = N_e^2 - D (2 S_e + D)                                              (3.8)
//! tan(delta/2) = D / (N + N_e); t, t' from it                              (3.9), (2.8), (2.9)
//! p_t = N h / (mass r^2)                                                   (3.10)
//! CDF = (N_a + N) tan(delta/2) / mass, delta: the angle from a             (3.6)
//! ```
//!
//! Departures from this, and why:
//!
//! 1. `mass` is the product on narrow intervals, where the difference cancels, and the difference on intervals of more than a
//!    right angle, where `tan(Theta/2)` is large.
//! 2. The mass is measured from `a` up to half of the angle, were `N` straight in it, plus or minus [`BIAS`](crate::geometry::BIAS),
//!    else from `b`: (2.8) asks for less than a right angle from the end.
//! 3. A variate stays 1e-12 of the mass away from the ends, where `N` may be 0.
//! 4. (3.8) is scaled by a power of two where a ray runs along the emitter's plane: its squares would leave f32.
//!
//! In fast precision the mass is measured from `a` up to 1/2, and polynomials are shorter.

use crate::Precision;
use crate::density::{self, Density, Drawn, Pdf, SetUp};
use crate::geometry::{Angle, Extent, Geometry, Point, RayLanes};
use crate::integrand::{ChannelLanes, MediumLanes};
use crate::precision::is_exact;
use crate::simd::math::{angle_of, tan};
use crate::simd::{Isa, Lanes, Number, Records, none};

/// `EXACT` is the precision.
pub(crate) struct Kind<const EXACT: bool>;

impl<const EXACT: bool> density::Kind for Kind<EXACT> {
    type On<I: Isa> = PointNormal<I, EXACT>;
}

#[derive(Clone, Copy)]
pub(crate) struct PointNormal<I: Isa, const EXACT: bool> {
    /// N at the ends.
    n_a: I::V,
    n_b: I::V,
    /// `S` at the ends, counted towards the interval.
    s_a: I::V,
    s_b: I::V,
    /// The integral of N over `theta`; without a normal `Theta`.
    mass: I::V,
}

impl<I: Isa, const EXACT: bool> PointNormal<I, EXACT> {
    /// Whether the arithmetic is that of `Precision::Exact`.
    const FULL: bool = is_exact::<I>(EXACT);

    /// The largest variate of which the mass is measured from `a`.
    #[cfg_attr(optimized, inline(always))]
    fn turn(&self, isa: I, geometry: Geometry<'_, I>) -> I::V {
        // In a wide interval half of the mass is within a right angle of either end.
        let half = isa.splat(0.5);
        if !Self::FULL {
            return half;
        }
        // The share of the mass in half of the angle, were N straight between the ends.
        let sum = self.n_a + self.n_b;
        let half_way = (self.n_a + self.n_a + sum) / (isa.splat(4.0) * sum);
        I::V::select(geometry.wide(isa), half, half_way + geometry.bias_to_a(isa))
    }
}

/// (3.6): the integral of N between two angles, given N and S at both and `tan_half` of their difference. `wide` intervals are
/// those of more than a right angle.
#[cfg_attr(optimized, inline(always))]
fn mass_of_cosine<I: Isa>(n: [I::V; 2], s: [I::V; 2], tan_half: I::V, wide: I::Mask) -> I::V {
    I::V::select(wide, s[1] - s[0], (n[0] + n[1]) * tan_half)
}

/// (3.8), (3.9): `tan(delta/2)` of the angle from an end within which N has the integral `mass`.
#[cfg_attr(optimized, inline(always))]
pub(crate) fn tan_half_at_mass<I: Isa>(isa: I, n_end: I::V, s_end: I::V, mass: I::V) -> I::V {
    let c = |x| isa.splat(x);
    // Along the emitter's plane the squares of these leave f32.
    let unit = I::V::select((n_end + s_end.abs()).lt(c(SMALL)), c(LARGE), c(1.0));
    let (n_end, s_end, mass) = (n_end * unit, s_end * unit, mass * unit);
    let n = n_end.mul_add(n_end, -(mass * (s_end + s_end + mass))).max(c(0.0)).sqrt();
    mass / (n + n_end).max(c(1e-37))
}
/// Powers of two: scaling by them rounds nothing.
const SMALL: f32 = 1.0 / (1 << 20) as f32;
const LARGE: f32 = (1u64 << 60) as f32;

/// The least share of the mass between a sample and an end of the interval.
pub(crate) const NEAREST: f32 = 1e-12;

impl<I: Isa, const EXACT: bool> Density<I> for PointNormal<I, EXACT> {
    const EXTENT: Extent = Extent::Cosine;
    type Place = Angle<I>;
    type SetUps = Records<SetUp<I, Self>>;

    #[cfg_attr(optimized, inline(always))]
    fn new(
        isa: I,
        _: Precision,
        _: &RayLanes<I>,
        geometry: Geometry<'_, I>,
        _: &MediumLanes<I>,
        _: Option<&ChannelLanes<I>>,
    ) -> (Self, I::Mask) {
        let g = geometry;
        let (ends, [s_a, s_b]) = g.ends_and_antiderivatives(isa);
        let [n_a, n_b] = ends.n;
        let dot = g.dot_of_ends();
        let tan_half = (g.foot.h * g.lit.length) / ends.r[0].mul_add(ends.r[1], dot);
        let wide = dot.lt(isa.splat(0.0));
        let mut mass = mass_of_cosine::<I>([n_a, n_b], [s_a, s_b], tan_half, wide);
        if I::V::bits(!g.cosine.has_normal) != 0 {
            mass = I::V::select(g.cosine.has_normal, mass, g.subtended(isa, Self::FULL));
        }
        let lit = g.lit(isa) & g.bright(isa, &ends);
        (Self { n_a, n_b, s_a, s_b: -s_b, mass }, lit)
    }

    #[cfg_attr(optimized, inline(always))]
    fn draw(&self, isa: I, geometry: Geometry<'_, I>, u: I::V) -> Angle<I> {
        let rest = isa.splat(1.0) - u;
        let from_a = u.le(self.turn(isa, geometry));
        // (3.7), away from the end, where N may be 0.
        let mass = self.mass * I::V::select(from_a, u, rest).max(isa.splat(NEAREST));
        let n_end = I::V::select(from_a, self.n_a, self.n_b);
        let s_end = I::V::select(from_a, self.s_a, self.s_b);
        let mut tan_half = tan_half_at_mass(isa, n_end, s_end, mass);
        if I::V::bits(!geometry.cosine.has_normal) != 0 {
            tan_half = I::V::select(geometry.cosine.has_normal, tan_half, tan(isa, isa.splat(0.5) * mass, Self::FULL));
        }
        Angle { from_a, tan_half }
    }

    #[cfg_attr(optimized, inline(always))]
    fn point(&self, isa: I, geometry: Geometry<'_, I>, angle: &Angle<I>) -> Drawn<I> {
        let point = geometry.point_at_angle(isa, angle, Self::FULL);
        Drawn { point, pdf: self.pdf(isa, geometry, &point), bisected: none(isa) }
    }

    #[cfg_attr(optimized, inline(always))]
    fn pdf(&self, isa: I, geometry: Geometry<'_, I>, point: &Point<I>) -> Pdf<I> {
        // (3.10)
        let one = isa.splat(1.0);
        let inv_r = one / point.r;
        let n = I::V::select(geometry.cosine.has_normal, point.m * inv_r, one);
        let h = geometry.foot.h;
        Pdf { over_t: ((h * inv_r) * (n * inv_r)) / self.mass, times_r2: h * n / self.mass }
    }

    #[cfg_attr(optimized, inline(always))]
    fn cdf(&self, isa: I, geometry: Geometry<'_, I>, point: &Point<I>) -> I::V {
        let g = geometry;
        let [across, along] = g.seen_from(isa, !none(isa), point);
        // tan(delta/2) = sin delta/(1 + cos delta), times r_a r above and below; then (3.6).
        let tan_half = across / g.foot.r(g.foot.a).mul_add(point.r, along);
        let (n, s) = (g.cosine(isa, point), g.antiderivative(point.t_prime, point.r));
        let cosines = mass_of_cosine::<I>([self.n_a, n], [self.s_a, s], tan_half, along.lt(isa.splat(0.0)));
        I::V::select(g.cosine.has_normal, cosines, angle_of(isa, across, along, Self::FULL)) / self.mass
    }
}
