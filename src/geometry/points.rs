//! Points of the ray: at an angle from an end, between the ends, at a distance; and what the emitter sends there.
//!
//! A point is known by its distances from both ends of the lit interval and by `t' = t - t_h`, each from where it does not
//! cancel; `t` is rounded from the nearest of these places.

use super::{Angle, Geometry, Point};
use crate::simd::{Isa, Lanes, Number};

/// The largest `|t'|` of an end next to the foot, as a share of `t`.
const NEXT_TO_FOOT: f32 = 1.0 / (1 << 24) as f32;

impl<I: Isa> Geometry<'_, I> {
    /// (2.8), (2.9): the point at an angle from an end. If not `exact`, `t` is computed from the place that `t'` is
    /// computed from.
    #[cfg_attr(optimized, inline(always))]
    pub(crate) fn point_at_angle(&self, isa: I, angle: &Angle<I>, exact: bool) -> Point<I> {
        let c = |x| isa.splat(x);
        let Angle { from_a, tan_half: tau } = *angle;
        let (h, h_squared) = (self.foot.h, self.foot.h_squared);
        let of_end = |a: I::V, b: I::V| I::V::select(from_a, a, b);
        // t'_e counted towards the interval, and 1/q.
        let sign = of_end(c(1.0), c(-1.0));
        let te = sign * of_end(self.foot.a, self.foot.b);
        let re_squared = te.mul_add(te, h_squared);
        let scale = c(1.0) / (-tau).mul_add(h.mul_add(tau, te + te), h);
        // (2.8), (2.9)
        let offset = ((tau + tau) * (re_squared * scale)).min(self.lit.length);
        let by_angle = (h * scale) * tau.mul_add((-te).mul_add(tau, h + h), te);
        // Near the end, t' is more exact as the end's plus the offset.
        let by_end = (offset + offset).lt(te.abs());
        let towards = I::V::select(by_end, te + offset, by_angle);
        // t from the end or from the foot, of `exact` from the nearer one.
        let near_end = if exact { offset.lt(towards.abs()) } else { by_end };
        let way = I::V::select(near_end, offset, towards);
        let base = I::V::select(near_end, of_end(self.lit.a, self.lit.b), self.foot.t_h);
        let low = I::V::select(near_end, of_end(self.rests.a, self.rests.b), self.foot.t_h_low);
        let t = self.within(base + sign.mul_add(way, low));
        let t_prime = sign * towards;

        let rest = self.rest(isa, offset, t_prime, of_end(self.foot.b, self.foot.a));
        let r = self.foot.r(t_prime);
        let m = self.m_between(isa, of_end(offset, rest), of_end(rest, offset), r);
        Point { t, t_prime, t_prime_low: c(0.0), r, m }
    }

    /// The point with these distances from the ends and from the foot of the perpendicular.
    #[cfg_attr(optimized, inline(always))]
    pub(crate) fn point_between(&self, isa: I, from_a: I::V, to_b: I::V, t_prime: I::V) -> Point<I> {
        let r = self.foot.r(t_prime);
        let m = self.m_between(isa, from_a, to_b, r);
        let t = self.distance(t_prime, from_a, to_b);
        Point { t, t_prime, t_prime_low: isa.splat(0.0), r, m }
    }

    /// (2.5): `m`, from the end where it is smaller; of a spot `S r`.
    #[cfg_attr(optimized, inline(always))]
    fn m_between(&self, isa: I, from_a: I::V, to_b: I::V, r: I::V) -> I::V {
        let m = self.cosine.ramp(isa).between(from_a, to_b);
        let Some(cone) = self.cone else { return m };
        let [before, after] = [cone.before.between(from_a, to_b) / r, cone.after.between(from_a, to_b) / r];
        I::V::select(cone.is_spot, cone.falloff(isa, before, after, m / r) * r, m)
    }

    /// The same for a point that may lie outside the lit interval: 0 outside the cone of a spot, also if its edge is hard.
    #[cfg_attr(optimized, inline(always))]
    fn m_inside(&self, isa: I, from_a: I::V, to_b: I::V, r: I::V) -> I::V {
        let zero = isa.splat(0.0);
        let m = self.m_between(isa, from_a.max(zero), to_b.max(zero), r);
        let Some(cone) = self.cone else { return m };
        I::V::only(!cone.is_spot | (zero.le(from_a) & zero.le(to_b)), m)
    }

    /// `m` at the ends of the lit interval.
    #[cfg_attr(optimized, inline(always))]
    pub(super) fn m_at_ends(&self, isa: I) -> [I::V; 2] {
        let (rising, least) = (self.cosine.rising(isa), self.cosine.m_least);
        let most = self.cosine.beta.abs().mul_add(self.lit.length, least);
        [I::V::select(rising, least, most), I::V::select(rising, most, least)]
    }

    /// `point` with the `t'` and `r` of the rounded `t`, where `t` is smaller than about `r` and so resolves `r`.
    #[cfg_attr(optimized, inline(always))]
    pub(crate) fn as_rounded(&self, point: Point<I>, about_r: I::V) -> Point<I> {
        let t_prime = I::V::select(point.t.lt(about_r), self.foot.t_prime(point.t)[0], point.t_prime);
        Point { t_prime, r: self.foot.r(t_prime), ..point }
    }

    /// The point of the ray at the given distance, which may lie outside the lit interval.
    #[cfg_attr(optimized, inline(always))]
    pub(crate) fn point_at_distance(&self, isa: I, t: I::V) -> Point<I> {
        let [t_prime, t_prime_low] = self.foot.t_prime(t);
        let t_prime_low = t_prime_low - self.refined.t_h;
        let r = self.foot.r(t_prime);
        let m = self.m_inside(isa, (t - self.lit.a) - self.rests.a, (self.lit.b - t) + self.rests.b, r);
        Point { t, t_prime, t_prime_low, r, m }
    }

    /// The point at the distance `s` from the start of the ray, no farther than its end.
    #[cfg_attr(optimized, inline(always))]
    pub(crate) fn point_beyond(&self, isa: I, t_min: I::V, s: I::V, t_max: I::V) -> Point<I> {
        let t_64 = t_min.widen() + s.widen();
        let exact = t_64 - self.exact_t_h();
        let t_prime = I::V::narrow(exact);
        let t_prime_low = I::V::narrow(exact - t_prime.widen());
        let from_a = I::V::narrow((t_64 - self.lit.a.widen()) - self.rests.a.widen());
        let to_b = I::V::narrow((self.lit.b.widen() - t_64) + self.rests.b.widen());
        let r = self.foot.r(t_prime);
        let m = self.m_inside(isa, from_a, to_b, r);
        let t = (t_min + s).min(t_max);
        Point { t, t_prime, t_prime_low, r, m }
    }

    /// The point at the start of the lit interval, given `r` there.
    #[cfg_attr(optimized, inline(always))]
    pub(crate) fn start(&self, isa: I, r_a: I::V) -> Point<I> {
        let [m, _] = self.m_at_ends(isa);
        Point { t: self.lit.a, t_prime: self.foot.a, t_prime_low: isa.splat(0.0), r: r_a, m }
    }

    /// `X` and `r` \[m\] in f64 at the ends of the lit interval.
    #[cfg_attr(optimized, inline(always))]
    pub(crate) fn exact_ends(&self, isa: I) -> [(I::Double, I::Double); 2] {
        let [a, b] = [self.foot.a, self.foot.b];
        [self.exact_end(isa, self.lit.a, self.rests.a, a), self.exact_end(isa, self.lit.b, self.rests.b, b)]
    }

    /// Of the end at `t` with the remainder `rest`, given `t'` as rounded. `t'` is `t + rest - t_h`; next to the foot it is the
    /// rounded one, as the error of `rest` is 2^-48 of `t`.
    #[cfg_attr(optimized, inline(always))]
    fn exact_end(&self, isa: I, t: I::V, rest: I::V, rounded: I::V) -> (I::Double, I::Double) {
        let exact = (t.widen() + rest.widen()) - self.exact_t_h();
        let next_to_foot = rounded.abs().lt(t * isa.splat(NEXT_TO_FOOT));
        let t_prime = I::V::select(next_to_foot, rounded, I::V::narrow(exact));
        let t_prime_low = I::V::only(!next_to_foot, I::V::narrow(exact - t_prime.widen()));
        let r = self.foot.r(rounded);
        self.exact_x_and_r(isa, &Point { t, t_prime, t_prime_low, r, m: isa.splat(0.0) })
    }

    /// The distance of `t` from the start of the lit interval \[m\], 0 before it.
    #[cfg_attr(optimized, inline(always))]
    pub(crate) fn way_from_a(&self, isa: I, t: I::V) -> I::V {
        ((t - self.lit.a) - self.rests.a).max(isa.splat(0.0))
    }

    /// The distance of `t` from the end of the lit interval \[m\], 0 beyond it.
    #[cfg_attr(optimized, inline(always))]
    pub(crate) fn way_to_b(&self, isa: I, t: I::V) -> I::V {
        ((self.lit.b - t) + self.rests.b).max(isa.splat(0.0))
    }

    /// The distance to the other end, of a point `offset` from one end: from `l`, or from `t'` where that is smaller.
    #[cfg_attr(optimized, inline(always))]
    fn rest(&self, isa: I, offset: I::V, t_prime: I::V, far_t_prime: I::V) -> I::V {
        let by_length = (self.lit.length - offset).max(isa.splat(0.0));
        let size = t_prime.abs().max(far_t_prime.abs());
        I::V::select(self.lit.length.lt(size), by_length, (t_prime - far_t_prime).abs())
    }

    /// `t` from the nearest of `t_a`, `t_b` and `t_h`.
    #[cfg_attr(optimized, inline(always))]
    fn distance(&self, t_prime: I::V, from_a: I::V, to_b: I::V) -> I::V {
        let at_b = to_b.lt(from_a);
        let by_foot = t_prime.abs().lt(from_a.min(to_b));
        let pick = |foot: I::V, a: I::V, b: I::V| I::V::select(by_foot, foot, I::V::select(at_b, b, a));
        let base = pick(self.foot.t_h, self.lit.a, self.lit.b);
        let low = pick(self.foot.t_h_low, self.rests.a, self.rests.b);
        self.within(base + (low + pick(t_prime, from_a, -to_b)))
    }

    /// `t`, clamped to the lit interval.
    #[cfg_attr(optimized, inline(always))]
    fn within(&self, t: I::V) -> I::V {
        t.max(self.lit.a).min(self.lit.b)
    }

    /// The cosine `N` at a point; 1 for spots.
    #[cfg_attr(optimized, inline(always))]
    pub(crate) fn cosine(&self, isa: I, point: &Point<I>) -> I::V {
        I::V::select(self.cosine.has_normal, point.m / point.r, isa.splat(1.0))
    }

    /// The relative intensity at a point: the cosine `N`, or the falloff `S` of a spot.
    #[cfg_attr(optimized, inline(always))]
    pub(crate) fn intensity(&self, isa: I, point: &Point<I>) -> I::V {
        let varies = match self.cone {
            Some(cone) => self.cosine.has_normal | cone.is_spot,
            None => self.cosine.has_normal,
        };
        I::V::select(varies, point.m / point.r, isa.splat(1.0))
    }
}

impl<I: Isa> Point<I> {
    #[cfg_attr(optimized, inline(always))]
    pub(super) fn exact_t_prime(&self) -> I::Double {
        self.t_prime.widen() + self.t_prime_low.widen()
    }
}
