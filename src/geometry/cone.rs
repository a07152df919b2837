//! The cone of a spot along a ray: the lit interval, in f64, and the falloff of the intensity there.
//!
//! With `a` the unit axis, `c = cos_outer`, `m = a.(x - y) = alpha_h + beta t'` and `G = a.(f x d)` of the foot `f`, the equations
//! of `docs/mathematics.md`, section 8, times powers of `h`: `hs` is `h sigma`, `G` is `h gamma`, `R` is `h c_max`.
//!
//! ```text
//! (hs)^2 = (1 - c^2) h^2 - G^2             R^2 = alpha_h^2 + beta^2 h^2     (8.3)
//! H_1 = alpha_h c + beta hs                B_1 = beta c h^2 - alpha_h hs    below, t'_lo = B_1/H_1: (8.4)
//! H_2 = alpha_h c - beta hs                B_2 = beta c h^2 + alpha_h hs    above, t'_hi = B_2/H_2: (8.5)
//! before = (H_1 t' - B_1)/R                after = (B_2 - H_2 t')/R         D_1, D_2: (8.8), (8.9)
//! cos phi - c = before after / (r (m + c r))                                (8.10)
//! S = s^2 (3 - 2 s),  s = (cos phi - c)/(cos_inner - c)                     (8.1)
//! ```
//!
//! The line misses the cone if `(hs)^2 <= 0`. It is inside from `t' = B_1/H_1` on if `H_1 > 0`, and up to `t' = B_2/H_2` if
//! `H_2 > 0`; if neither is positive, it meets only the other half of the double cone.
//!
//! Departures from this, and why:
//!
//! 1. Two edges of the interval are `2 c hs/(c^2 - beta^2)` apart: not a difference of distances.
//! 2. `before` and `after` are computed from the end of the lit interval where they are smaller, and grow from there: nothing
//!    cancels in f32, however narrow the cone.
//! 3. An emitter on the line has the least `h` of `double`, and `(hs)^2 = alpha_h^2 + (beta^2 - c^2) h^2`.
//! 4. Lengths are multiplied by 2^40 where `h` is below 1 m: squares of a tiny `h` stay within f32.

use super::double::{Line, excess_of_square, one_over_length};
use super::{Cosine, Lit, Located, RayLanes, Rests, TOLERANCE, dot, largest, widen};
use crate::scene::FARTHEST;
use crate::simd::math::{reciprocal, reciprocal_near};
use crate::simd::{Double, Isa, Lanes, Number, none};

/// The spots of a lane group.
pub(crate) struct SpotLanes<I: Isa> {
    pub(crate) position: [I::V; 3],
    pub(crate) axis: [I::V; 3],
    pub(crate) cos_outer: I::V,
    pub(crate) cos_inner: I::V,
}

impl<I: Isa> SpotLanes<I> {
    /// Which lanes have a cone: two cosines of -1 mean none.
    #[cfg_attr(optimized, inline(always))]
    pub(crate) fn is_spot(&self, isa: I) -> I::Mask {
        let all = isa.splat(-1.0);
        !(self.cos_outer.eq(all) & self.cos_inner.eq(all))
    }
}

/// A function that is linear along the ray and not negative within the lit interval.
#[derive(Clone, Copy)]
pub(crate) struct Ramp<I: Isa> {
    /// Its value at the end where it is smaller: `a` where it rises, else `b`.
    pub(crate) least: I::V,
    /// The growth from there per length.
    pub(crate) slope: I::V,
    pub(crate) rising: I::Mask,
}

impl<I: Isa> Ramp<I> {
    /// The value at the point with these distances from the ends.
    #[cfg_attr(optimized, inline(always))]
    pub(crate) fn between(&self, from_a: I::V, to_b: I::V) -> I::V {
        self.slope.mul_add(I::V::select(self.rising, from_a, to_b), self.least)
    }
}

/// The falloff of a spot within the lit interval.
#[derive(Clone, Copy)]
pub(crate) struct Cone<I: Isa> {
    /// `before` and `after` \[m\].
    pub(crate) before: Ramp<I>,
    pub(crate) after: Ramp<I>,
    cos_outer: I::V,
    /// `1/(cos_inner - cos_outer)`.
    inv_fall: I::V,
    hard: I::Mask,
    pub(crate) is_spot: I::Mask,
}

impl<I: Isa> Cone<I> {
    /// (8.1), (8.10): `S`, given `before`, `after` and `m` over `r`; 1 without a cone.
    #[cfg_attr(optimized, inline(always))]
    pub(crate) fn falloff(&self, isa: I, before: I::V, after: I::V, m: I::V) -> I::V {
        let c = |x| isa.splat(x);
        // If c = 0, m vanishes together with `after`.
        let sum = (m + self.cos_outer).max(c(1e-30));
        let s = (before * (after / sum) * self.inv_fall).min(c(1.0));
        I::V::select(self.hard | !self.is_spot, c(1.0), s * s * (c(3.0) - (s + s)))
    }
}

/// `yes` where the mask holds, else `no`, both finite.
#[cfg_attr(optimized, inline(always))]
fn select<I: Isa>(isa: I, mask: I::Mask, yes: I::Double, no: I::Double) -> I::Double {
    let one = isa.splat(1.0);
    yes.mul_add(I::V::only(mask, one).widen(), no * I::V::only(!mask, one).widen())
}

/// The root and its reciprocal; a tiny value and a large one for 0.
#[cfg_attr(optimized, inline(always))]
fn root<I: Isa>(isa: I, squared: I::Double) -> (I::Double, I::Double) {
    // One Newton step of the reciprocal.
    let near = (isa.splat(1.0) / I::V::narrow(squared).max(isa.splat(1e-36)).sqrt()).widen();
    let half = squared * isa.splat_double(0.5);
    let inverse = near * (isa.splat_double(1.5) - (half * near) * near);
    (squared * inverse, inverse)
}

impl<I: Isa> Line<I> {
    /// The direction, of unit length.
    #[cfg_attr(optimized, inline(always))]
    fn direction(&self) -> [I::Double; 3] {
        [self.d[0] * self.unit, self.d[1] * self.unit, self.d[2] * self.unit]
    }

    /// The square of the least `h` that is resolved at this distance, not rounded to f32: the edges of a cone depend on it.
    #[cfg_attr(optimized, inline(always))]
    fn least_h_squared(&self, isa: I) -> I::Double {
        // max(|t_h|, |t_min - t_h|): as t_min is not negative, the larger one is positive.
        let away = self.t_h.max(self.t_prime[0]);
        let least = (away * isa.splat_double(1e-9)).max(isa.splat_double(1e-18));
        least * least
    }

    /// The foot with all its digits, also where it is much nearer to the emitter than the ray's origin is, and the distance along
    /// the ray by which it misses the exact foot.
    #[cfg_attr(optimized, inline(always))]
    fn exact_foot(&self) -> ([I::Double; 3], I::Double) {
        let Self { d, e, .. } = *self;
        let along = self.t_h * self.unit;
        // Products of two f32 are exact.
        let high = I::V::narrow(along).widen();
        let low = along - high;
        let f = [
            low.mul_add(d[0], high.mul_add(d[0], -e[0])),
            low.mul_add(d[1], high.mul_add(d[1], -e[1])),
            low.mul_add(d[2], high.mul_add(d[2], -e[2])),
        ];
        (f, dot(f, d) * self.unit)
    }
}

/// The geometry of the spots of a lane group.
#[cfg_attr(optimized, inline(always))]
pub(crate) fn locate<I: Isa>(isa: I, ray: &RayLanes<I>, spot: &SpotLanes<I>) -> (Located<I>, Cone<I>) {
    let c = |x| isa.splat(x);
    let zero = c(0.0);
    let (cos_outer, cos_inner) = (spot.cos_outer, spot.cos_inner);
    let line = Line::new(isa, ray, spot.position);
    let d = line.d;
    let (f, rho) = line.exact_foot();
    let a = widen::<I>(spot.axis);
    let q = excess_of_square(isa, a);
    let over_a = one_over_length(isa, q);

    // Departure 4.
    let foot_squared = (-rho).mul_add(rho, dot(f, f));
    let h_squared = foot_squared.max(line.least_h_squared(isa));
    let unit = I::V::select(I::V::narrow(h_squared).lt(c(1.0)), c((1u64 << 40) as f32), c(1.0)).widen();
    let unit_squared = unit * unit;
    let beta = dot(a, d) * (over_a * line.unit);
    let alpha_h = (-beta).mul_add(rho, dot(a, f) * over_a);
    let f_x_d =
        [f[1].mul_add(d[2], -(f[2] * d[1])), f[2].mul_add(d[0], -(f[0] * d[2])), f[0].mul_add(d[1], -(f[1] * d[0]))];
    let g = dot(a, f_x_d) * (over_a * line.unit);
    let one = isa.splat_double(1.0);
    let outer = cos_outer.widen();
    let sin_squared = (one - outer) * (one + outer);
    let c2_less_beta2 =
        difference_of_squares(isa, [a[0] * over_a, a[1] * over_a, a[2] * over_a], line.direction(), outer, beta);
    // (8.3), off the line, and on it by departure 3.
    let off_line = foot_squared.mul_add(sin_squared, -(g * g));
    let on_line = alpha_h.mul_add(alpha_h, -(h_squared * c2_less_beta2));
    let is_off = I::V::narrow(h_squared - foot_squared).le(zero);
    let hs_squared = select(isa, is_off, off_line, on_line) * unit_squared;
    let met = zero.lt(I::V::narrow(hs_squared));
    let (hs_units, _) = root(isa, hs_squared.max(isa.splat_double(0.0)));

    // (8.4), (8.5): H is in units, B in their square.
    let (alpha_units, h2_units) = (alpha_h * unit, h_squared * unit_squared);
    let r2_units = alpha_units.mul_add(alpha_units, (beta * beta) * h2_units);
    let (_, over_r) = root(isa, r2_units);
    let (level, tilt) = ((beta * outer) * h2_units, alpha_units * hs_units);
    let slopes = slopes(isa, alpha_units * outer, beta * hs_units, r2_units * c2_less_beta2);
    let offsets = [level - tilt, level + tilt];
    let opens = [zero.lt(I::V::narrow(slopes[0])), zero.lt(I::V::narrow(slopes[1]))];
    let edges = [edge(isa, offsets[0], slopes[0], unit), edge(isa, offsets[1], slopes[1], unit)];

    let [t_prime_min, t_prime_max] = [line.t_prime[0] + rho, line.t_prime[1] + rho];
    let clip_a = opens[0] & zero.lt(I::V::narrow(edges[0] - t_prime_min));
    let clip_b = opens[1] & zero.lt(I::V::narrow(t_prime_max - edges[1]));
    let start = select(isa, clip_a, edges[0], t_prime_min);
    let end = select(isa, clip_b, edges[1], t_prime_max);
    // Departure 1.
    let between_edges = I::V::narrow(outer * (hs_units + hs_units) * reciprocal(isa, c2_less_beta2 * unit));
    let whole = line.t_max - ray.t_min;
    let length = I::V::select(clip_a | clip_b, I::V::narrow(end - start), whole);
    let between = clip_a & clip_b & zero.lt(between_edges);
    let length = I::V::select(between, between_edges, length).min(whole);
    // Both slopes are 0 if c and beta are: the ray then stays on its side of the plane.
    let ahead = opens[0] | opens[1] | zero.lt(I::V::narrow(alpha_h));
    let is_lit = met & ahead & zero.lt(I::V::narrow(end - start));
    let length = I::V::only(is_lit, length);

    let [[edge_a, rest_a], [edge_b, rest_b]] = [line.end_at(ray, edges[0] - rho), line.end_at(ray, edges[1] - rho)];
    let valid = line.valid
        & largest::<I>(spot.position).le(c(FARTHEST))
        & I::V::narrow(q).abs().le(c(TOLERANCE))
        & zero.le(cos_outer)
        & cos_outer.le(cos_inner)
        & cos_inner.le(c(1.0));
    let lit = Lit { a: I::V::select(clip_a, edge_a, ray.t_min), b: I::V::select(clip_b, edge_b, line.t_max), length };

    let no = none(isa);
    let scaled = Scaled { start, end, unit, over_r };
    // (8.8), (8.9)
    let before = scaled.ramp(isa, slopes[0], offsets[0], [clip_a, no]);
    let after = scaled.ramp(isa, -slopes[1], -offsets[1], [no, clip_b]);

    let beta_rounded = I::V::narrow(beta);
    let (m_a, m_b) = (I::V::narrow(beta.mul_add(start, alpha_h)), I::V::narrow(beta.mul_add(end, alpha_h)));
    let m_least = I::V::select(zero.le(beta_rounded), m_a, m_b).max(zero);
    let cosine = Cosine { m_least, beta: beta_rounded, has_normal: no };
    let foot = line.foot([I::V::narrow(start), I::V::narrow(end)]);
    let rests = Rests { a: I::V::only(clip_a, rest_a), b: I::V::only(clip_b, rest_b) };
    let fall = cos_inner - cos_outer;
    let (hard, inv_fall) = (fall.le(zero), c(1.0) / fall.max(c(LEAST_FALL)));
    let located = Located { lit, rests, cosine, foot, alpha_h: I::V::narrow(alpha_h), valid };
    (located, Cone { before, after, cos_outer, inv_fall, hard, is_spot: spot.is_spot(isa) })
}

/// Less than the difference of any two different f32 cosines.
const LEAST_FALL: f32 = 1e-8;

/// The lit interval in `t'`, and the units of ramps: slopes are in `unit`, offsets in its square.
struct Scaled<I: Isa> {
    start: I::Double,
    end: I::Double,
    unit: I::Double,
    /// `1/(unit R)`.
    over_r: I::Double,
}

impl<I: Isa> Scaled<I> {
    /// (8.8), (8.9): `(slope t' - offset)/R` from the end where it is smaller, exactly 0 at an end that is its edge.
    #[cfg_attr(optimized, inline(always))]
    fn ramp(&self, isa: I, slope: I::Double, offset: I::Double, [edge_a, edge_b]: [I::Mask; 2]) -> Ramp<I> {
        let zero = isa.splat(0.0);
        let per_length = I::V::narrow(slope * self.over_r);
        let rising = zero.le(per_length);
        let t_prime = select(isa, rising, self.start, self.end);
        let in_units = I::V::narrow(slope.mul_add(t_prime * self.unit, -offset) * self.over_r);
        let at_edge = (rising & edge_a) | (!rising & edge_b);
        let least = I::V::only(!at_edge, (in_units / I::V::narrow(self.unit)).max(zero));
        Ramp { least, slope: per_length.abs(), rising }
    }
}

/// `c^2 - beta^2`, given the unit vectors of which `beta` is the scalar product: from `1 - |beta|`, half the square of their
/// difference or sum, which keeps the digits that the angle between a ray and the side of a narrow cone needs.
#[cfg_attr(optimized, inline(always))]
fn difference_of_squares<I: Isa>(
    isa: I,
    a: [I::Double; 3],
    d: [I::Double; 3],
    outer: I::Double,
    beta: I::Double,
) -> I::Double {
    let one = isa.splat(1.0);
    let alike = isa.splat(0.0).le(I::V::narrow(beta));
    let sign = (I::V::only(alike, one + one) - one).widen();
    let apart = [(-sign).mul_add(d[0], a[0]), (-sign).mul_add(d[1], a[1]), (-sign).mul_add(d[2], a[2])];
    let to_one = dot(apart, apart) * isa.splat_double(0.5);
    let one = isa.splat_double(1.0);
    (to_one - (one - outer)) * (outer + (one - to_one))
}

/// `H_1` and `H_2`, the sum and the difference of `along` and `across`. The smaller one is computed from their product
/// `R^2 (c^2 - beta^2)`: next to a ray along the side of the cone the difference has no digits.
#[cfg_attr(optimized, inline(always))]
fn slopes<I: Isa>(isa: I, along: I::Double, across: I::Double, product: I::Double) -> [I::Double; 2] {
    let (zero, one) = (isa.splat(0.0), isa.splat(1.0));
    let alike = zero.le(I::V::narrow(along) * I::V::narrow(across));
    let sign = (I::V::only(alike, one + one) - one).widen();
    let large = sign.mul_add(across, along);
    let near = one / I::V::select(I::V::narrow(large).eq(zero), one, I::V::narrow(large));
    let small = product * reciprocal_near(isa, large, near.widen());
    [select(isa, alike, large, small), select(isa, alike, small, large)]
}

/// `t'` where a ramp is 0 \[m\], with a Newton step after the division, as a lit interval may be as short as the division's error;
/// clamped to [`FAR`].
#[cfg_attr(optimized, inline(always))]
fn edge<I: Isa>(isa: I, offset: I::Double, slope: I::Double, unit: I::Double) -> I::Double {
    let near = (isa.splat(1.0) / I::V::narrow(slope).max(isa.splat(1e-30))).widen();
    let over = reciprocal_near(isa, slope, near);
    let once = offset * over;
    let twice = once - slope.mul_add(once, -offset) * near;
    let over_unit = (isa.splat(1.0) / I::V::narrow(unit)).widen();
    (twice * over_unit).max(isa.splat_double(-FAR)).min(isa.splat_double(FAR))
}

/// Farther than any point of a ray from the foot of its perpendicular \[m\].
const FAR: f64 = 1e20;
