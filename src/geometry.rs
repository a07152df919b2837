//! The geometry of a ray and an emitter: the foot of the perpendicular, the cosine, and the lit interval.
//!
//! Equations of `docs/mathematics.md`, section 2:
//!
//! ```text
//! t_h = (y - o).d,   h = |o + t_h d - y|                                   (2.1), (2.2)
//! t' = t - t_h,   r = sqrt(h^2 + t'^2)                                     (2.3)
//! m(t) = n.(x - y) = N r = alpha h + beta t'                               (2.4)
//! lit: the part [t_a, t_b] of [t_min, t_max] with m > 0, l = t_b - t_a
//! Theta = atan2(h l, h^2 + t'_a t'_b)                                      (2.7)
//! a point at the angle delta from an end e, tau = tan(delta/2):
//!     q = h (1 - tau^2) - 2 tau t'_e
//!     distance from e = 2 tau (h^2 + t'_e^2) / q                           (2.8)
//!     t' = h (t'_e (1 - tau^2) + 2 tau h) / q                              (2.9)
//! ```
//!
//! `t_h`, `h` and `m` are computed in `single` (f32) and, for rays for which that is not enough, in `double` (f64), those of spots
//! in `cone`. This file has what follows from them.
//!
//! Departures from the plain formulas, and why:
//!
//! 1. `t_a`, `t_b`, `t_h` and a point's `t'` are an f32 and the remainder of its rounding, for paths `h^2` too; `t` is computed from
//!    the nearest of `t_a`, `t_b` and `t_h`.
//! 2. `m` is computed from the end where it is smaller (2.5): both terms are positive, and it is exactly 0 where the interval
//!    ends at `m` = 0.
//! 3. Angles are those between two points of the ray (2.6), never differences of angles, which would lose all digits of a short
//!    interval.
//! 4. `t'` of (2.9) is the end's plus (2.8) where the point is near the end.
//! 5. Intervals and cosines below what f32 can tell from none count as dark: see [`Geometry::lit`] and [`Geometry::bright`].

mod cone;
mod double;
mod points;
mod single;

pub(crate) use cone::{Cone, Ramp, SpotLanes, locate as in_cone};
pub(crate) use double::refine;
pub(crate) use single::locate as in_f32;

use crate::scene::{FARTHEST, UNIT_TOLERANCE};
use crate::simd::math::{angle_of, reciprocal};
use crate::simd::{Double, Isa, Lanes, Number, none};

/// The part of the geometry that is computed: each variant includes those before it.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd)]
pub(crate) enum Extent {
    /// Whether anything is lit.
    Lit,
    /// The lit interval, and the foot of the perpendicular.
    Foot,
    /// The emitter's cosine.
    Cosine,
    /// In exact precision also [`Refined`]: a transmittance multiplies an error of the path by the optical depth.
    Path,
}

/// The rays of a lane group.
pub(crate) struct RayLanes<I: Isa> {
    pub(crate) origin: [I::V; 3],
    pub(crate) direction: [I::V; 3],
    pub(crate) t_min: I::V,
    pub(crate) t_max: I::V,
}

impl<I: Isa> RayLanes<I> {
    /// The end of the ray \[m\], at most [`FARTHEST`]; NaN stays NaN.
    #[cfg_attr(optimized, inline(always))]
    pub(crate) fn end(&self, isa: I) -> I::V {
        isa.splat(FARTHEST).min(self.t_max)
    }
}

/// The emitters of a lane group.
#[derive(Clone, Copy)]
pub(crate) struct EmitterLanes<I: Isa> {
    position: [I::V; 3],
    normal: [I::V; 3],
    has_normal: I::Mask,
    valid: I::Mask,
    /// Which lanes have a normal of length 1, or none, and are not very far away.
    plain: I::Mask,
    /// `n.(x - y)` in the emitter's plane: 0; without a normal larger than any `m`.
    in_plane: I::V,
}

impl<I: Isa> EmitterLanes<I> {
    /// The normal (0, 0, 0) means none.
    #[cfg_attr(optimized, inline(always))]
    pub(crate) fn new(isa: I, position: [I::V; 3], normal: [I::V; 3]) -> Self {
        let size = normal[0].abs() + normal[1].abs() + normal[2].abs();
        let none = size.eq(isa.splat(0.0));
        let far = largest::<I>(position);
        let excess = dot(normal, normal) - isa.splat(1.0);
        let valid = far.le(isa.splat(FARTHEST)) & (excess.abs().le(isa.splat(TOLERANCE)) | none);
        let plain = far.le(isa.splat(PLAIN)) & (excess.abs().le(isa.splat(single::UNIT)) | none);
        let in_plane = I::V::only(none, isa.splat(single::NO_NORMAL));
        Self { position, normal, has_normal: !none, valid, plain, in_plane }
    }
}

/// The largest `||v|^2 - 1|` of a unit vector `v`.
const TOLERANCE: f32 = 2.001 * UNIT_TOLERANCE;

/// The largest coordinate \[m\] with products that stay within f32.
const PLAIN: f32 = 1e15;

/// The length of a lit interval that counts as none \[m\].
const LEAST_LENGTH: f32 = 1e-18;

/// The share of the variates, beyond those of half of the angle, of which a point is still measured from the end that is nearer to
/// the foot of the perpendicular. From the other end the way is long, and the short rest to the near end would have its error.
pub(crate) const BIAS: f32 = 0.05;

/// The part of the ray that the emitter faces.
#[derive(Clone, Copy)]
pub(crate) struct Lit<I: Isa> {
    /// The distances of its ends along the ray \[m\], rounded: `t_a` and `t_b`.
    pub(crate) a: I::V,
    pub(crate) b: I::V,
    /// `t_b - t_a` \[m\]; 0 where nothing is lit. It is NaN if, besides, the ray is parallel to the emitter's plane: `x < length`
    /// is then false.
    pub(crate) length: I::V,
}

/// The remainders of roundings: the exact value is the rounded one plus this. They are 0 where f32 is exact enough for the
/// precision.
#[derive(Clone, Copy)]
pub(crate) struct Rests<I: Isa> {
    /// Of `t_a` and `t_b` \[m\]: 0 where the ray itself ends.
    pub(crate) a: I::V,
    pub(crate) b: I::V,
}

impl<I: Isa> Rests<I> {
    #[cfg_attr(optimized, inline(always))]
    pub(crate) fn none(isa: I) -> Self {
        let zero = isa.splat(0.0);
        Self { a: zero, b: zero }
    }
}

/// The emitter's cosine `N` along the ray, as `m = n.(x - y) = N r` \[m\] (2.4).
#[derive(Clone, Copy)]
pub(crate) struct Cosine<I: Isa> {
    /// `m` at the end of the lit interval where it is smaller: `a` where `beta >= 0`, else `b`. It is exactly 0 where the interval
    /// was clipped, and means nothing without a normal.
    pub(crate) m_least: I::V,
    /// `beta = n.d`, the slope of `m` along the ray.
    pub(crate) beta: I::V,
    /// Which lanes have an emitter with a normal.
    pub(crate) has_normal: I::Mask,
}

impl<I: Isa> Cosine<I> {
    /// For emitters without a normal.
    #[cfg_attr(optimized, inline(always))]
    pub(crate) fn none(isa: I) -> Self {
        let zero = isa.splat(0.0);
        Self { m_least: zero, beta: zero, has_normal: none(isa) }
    }

    /// `m` as a function along the ray.
    #[cfg_attr(optimized, inline(always))]
    pub(crate) fn ramp(&self, isa: I) -> Ramp<I> {
        Ramp { least: self.m_least, slope: self.beta.abs(), rising: self.rising(isa) }
    }

    /// Which lanes have an `m` that grows along the ray, or stays.
    #[cfg_attr(optimized, inline(always))]
    pub(crate) fn rising(&self, isa: I) -> I::Mask {
        isa.splat(0.0).le(self.beta)
    }
}

/// The foot of the perpendicular from the emitter to the ray's line, and the ends of the lit interval as seen from there.
#[derive(Clone, Copy)]
pub(crate) struct Foot<I: Isa> {
    /// Distance from the emitter \[m\], and its square.
    pub(crate) h: I::V,
    pub(crate) h_squared: I::V,
    /// Distance along the ray \[m\], rounded, and a correction: their sum has an error of a few 2^-24 of `h`.
    t_h: I::V,
    t_h_low: I::V,
    /// `t' = t - t_h` at the ends of the lit interval \[m\].
    pub(crate) a: I::V,
    pub(crate) b: I::V,
}

/// What a [`Foot`] lacks: the exact values are its own plus these.
#[derive(Clone, Copy)]
pub(crate) struct Refined<I: Isa> {
    /// Of `t_h` \[m\] and of `h^2` \[m^2\].
    t_h: I::V,
    h_squared: I::V,
}

impl<I: Isa> Refined<I> {
    /// A placeholder where f32 is enough.
    #[cfg_attr(optimized, inline(always))]
    pub(crate) fn none(isa: I) -> Self {
        let zero = isa.splat(0.0);
        Self { t_h: zero, h_squared: zero }
    }
}

/// The geometry of a lane group.
#[derive(Clone, Copy)]
pub(crate) struct Geometry<'g, I: Isa> {
    pub(crate) lit: &'g Lit<I>,
    pub(crate) cosine: &'g Cosine<I>,
    pub(crate) foot: &'g Foot<I>,
    pub(crate) refined: &'g Refined<I>,
    /// `alpha h`, which is `m` at the foot \[m\] (2.4).
    pub(crate) alpha_h: I::V,
    pub(crate) rests: &'g Rests<I>,
    /// Which lanes hold a valid ray and emitter; of `single` which of them need no f64.
    pub(crate) valid: I::Mask,
    /// The cones of a group with spots; its other lanes have `is_spot` false.
    pub(crate) cone: Option<&'g Cone<I>>,
}

/// The ends `a` and `b` of the lit interval as seen from the emitter.
#[derive(Clone, Copy)]
pub(crate) struct Ends<I: Isa> {
    /// Distance to the emitter \[m\].
    pub(crate) r: [I::V; 2],
    /// The cosine `N`; 1 without a normal.
    pub(crate) n: [I::V; 2],
}

/// A direction from the emitter within the lit interval.
#[derive(Clone, Copy)]
pub(crate) struct Angle<I: Isa> {
    /// Which lanes measure the angle from `a`; the others measure it from `b`.
    pub(crate) from_a: I::Mask,
    /// `tau = tan(delta/2)`, at most 1, of the angle `delta` from that end.
    pub(crate) tan_half: I::V,
}

/// A point of the ray.
#[derive(Clone, Copy)]
pub(crate) struct Point<I: Isa> {
    /// Distance along the ray \[m\], rounded.
    pub(crate) t: I::V,
    /// `t - t_h` \[m\], exact to a few ulp also where `t` cannot resolve it.
    pub(crate) t_prime: I::V,
    /// The remainder of its rounding, as far as known.
    t_prime_low: I::V,
    /// Distance to the emitter \[m\].
    pub(crate) r: I::V,
    /// `n.(x - y) = N r` \[m\], of a spot `S r`; not negative. It means nothing for other emitters.
    pub(crate) m: I::V,
}

/// The geometry of a lane group, owned.
#[derive(Clone, Copy)]
pub(crate) struct Located<I: Isa> {
    pub(crate) lit: Lit<I>,
    pub(crate) rests: Rests<I>,
    pub(crate) cosine: Cosine<I>,
    pub(crate) foot: Foot<I>,
    pub(crate) alpha_h: I::V,
    pub(crate) valid: I::Mask,
}

/// The geometry of a lane group in f64.
#[cfg_attr(optimized, inline(always))]
pub(crate) fn in_f64<I: Isa>(isa: I, ray: &RayLanes<I>, emitter: &EmitterLanes<I>) -> Located<I> {
    double::locate(isa, ray, emitter)
}

impl<I: Isa> Located<I> {
    /// Of a lit interval alone.
    #[cfg_attr(optimized, inline(always))]
    fn of(isa: I, lit: Lit<I>, valid: I::Mask) -> Self {
        let (rests, cosine, foot) = (Rests::none(isa), Cosine::none(isa), Foot::none(isa));
        Self { lit, rests, cosine, foot, alpha_h: isa.splat(0.0), valid }
    }

    /// This in the lanes of `hard`, `other` in the others.
    #[cfg_attr(optimized, inline(always))]
    pub(crate) fn or(&self, hard: I::Mask, other: Geometry<'_, I>) -> Self {
        let Self { lit, rests, cosine, foot, alpha_h, valid } = self;
        let pick = |yes, no| I::V::select(hard, yes, no);
        let pick_mask = |yes, no| (hard & yes) | (!hard & no);
        Self {
            lit: Lit {
                a: pick(lit.a, other.lit.a),
                b: pick(lit.b, other.lit.b),
                length: pick(lit.length, other.lit.length),
            },
            rests: Rests { a: pick(rests.a, other.rests.a), b: pick(rests.b, other.rests.b) },
            cosine: Cosine {
                m_least: pick(cosine.m_least, other.cosine.m_least),
                beta: pick(cosine.beta, other.cosine.beta),
                has_normal: pick_mask(cosine.has_normal, other.cosine.has_normal),
            },
            foot: Foot {
                h: pick(foot.h, other.foot.h),
                h_squared: pick(foot.h_squared, other.foot.h_squared),
                t_h: pick(foot.t_h, other.foot.t_h),
                t_h_low: pick(foot.t_h_low, other.foot.t_h_low),
                a: pick(foot.a, other.foot.a),
                b: pick(foot.b, other.foot.b),
            },
            alpha_h: pick(*alpha_h, other.alpha_h),
            valid: pick_mask(*valid, other.valid),
        }
    }
}

impl<I: Isa> Geometry<'_, I> {
    /// Which lanes have a lit interval.
    #[cfg_attr(optimized, inline(always))]
    pub(crate) fn faced(&self, isa: I) -> I::Mask {
        isa.splat(LEAST_LENGTH).lt(self.lit.length)
    }

    /// Which lanes have a lit interval that f32 can tell from none: it subtends more than 1e-30 rad, and is longer than 1e-36 of
    /// `r^2`.
    #[cfg_attr(optimized, inline(always))]
    pub(crate) fn lit(&self, isa: I) -> I::Mask {
        // Without a root: (|t'| + h)/1.42 is r or up to 1.42 times less.
        let h = self.foot.h;
        let rr = (self.foot.a.abs() + h) * (self.foot.b.abs() + h) * isa.splat(0.5);
        let wide = (rr * isa.splat(1e-30)).lt(h * self.lit.length) & (rr * isa.splat(1e-36)).lt(self.lit.length);
        self.faced(isa) & wide
    }

    /// The same, [`faced`](Self::faced) included, given `Theta`.
    #[cfg_attr(optimized, inline(always))]
    pub(crate) fn lit_by_angle(&self, isa: I, subtended: I::V) -> I::Mask {
        // r_a r_b, where the interval is short against r.
        let rr = self.dot_of_ends().abs();
        isa.splat(1e-30).lt(subtended) & isa.splat(LEAST_LENGTH).max(rr * isa.splat(1e-36)).lt(self.lit.length)
    }

    /// The ends as seen from the emitter (2.3), (2.4).
    #[cfg_attr(optimized, inline(always))]
    pub(crate) fn ends(&self, isa: I) -> Ends<I> {
        let (ends, _) = self.ends_and_antiderivatives(isa);
        ends
    }

    /// The same, with the antiderivative `alpha sin theta - beta cos theta` of `N` over `theta` there: `M` of section 3.3.
    #[cfg_attr(optimized, inline(always))]
    pub(crate) fn ends_and_antiderivatives(&self, isa: I) -> (Ends<I>, [I::V; 2]) {
        let (one, has_normal) = (isa.splat(1.0), self.cosine.has_normal);
        let [r_a, r_b] = [self.foot.r(self.foot.a), self.foot.r(self.foot.b)];
        let [m_a, m_b] = self.m_at_ends(isa);
        let n = [I::V::select(has_normal, m_a / r_a, one), I::V::select(has_normal, m_b / r_b, one)];
        let [s_a, s_b] = [self.antiderivative_r(self.foot.a), self.antiderivative_r(self.foot.b)];
        (Ends { r: [r_a, r_b], n }, [s_a / r_a, s_b / r_b])
    }

    /// Which lanes have more than 1e-25 of the light of an emitter faced squarely: f32 cannot resolve `N` below that.
    #[cfg_attr(optimized, inline(always))]
    pub(crate) fn bright(&self, isa: I, ends: &Ends<I>) -> I::Mask {
        let least = isa.splat(1e-25);
        let h = self.foot.h;
        let rr = ends.r[0] * ends.r[1];
        let light = (h * self.lit.length) * (ends.n[0] + ends.n[1]);
        (self.wide(isa) & (h * least).lt(self.greatest_cosine_h())) | (rr * least).lt(light)
    }

    /// Which lanes have an interval that subtends more than a right angle.
    #[cfg_attr(optimized, inline(always))]
    pub(crate) fn wide(&self, isa: I) -> I::Mask {
        self.dot_of_ends().lt(isa.splat(0.0))
    }

    /// `h (|alpha| + |beta|)` \[m\]: at least `h` times the largest cosine, and at most 1.5 times that.
    #[cfg_attr(optimized, inline(always))]
    fn greatest_cosine_h(&self) -> I::V {
        self.cosine.beta.abs().mul_add(self.foot.h, self.alpha_h.abs())
    }

    /// Which ends are dark: their cosine is less than `share` of `|alpha| + |beta|`, or of `N_a + N_b` where the interval subtends
    /// less than a right angle. The end of a spot is dark if its falloff is less than `share`.
    #[cfg_attr(optimized, inline(always))]
    pub(crate) fn dark_ends(&self, isa: I, ends: &Ends<I>, share: f32) -> [I::Mask; 2] {
        let (n_a, n_b) = (ends.n[0] * self.foot.h, ends.n[1] * self.foot.h);
        let least = I::V::select(self.wide(isa), self.greatest_cosine_h(), n_a + n_b) * isa.splat(share);
        let dark = [n_a.lt(least), n_b.lt(least)];
        let Some(cone) = self.cone else { return dark };
        let [s_a, s_b] = self.falloff_at_ends(isa, cone, ends);
        let share = isa.splat(share);
        [
            (!cone.is_spot & dark[0]) | (cone.is_spot & s_a.lt(share)),
            (!cone.is_spot & dark[1]) | (cone.is_spot & s_b.lt(share)),
        ]
    }

    /// The falloff `S` at the ends.
    #[cfg_attr(optimized, inline(always))]
    fn falloff_at_ends(&self, isa: I, cone: &Cone<I>, ends: &Ends<I>) -> [I::V; 2] {
        let (zero, length, [r_a, r_b], [m_a, m_b]) = (isa.splat(0.0), self.lit.length, ends.r, self.m_at_ends(isa));
        let [before_a, after_a] = [cone.before.between(zero, length), cone.after.between(zero, length)];
        let [before_b, after_b] = [cone.before.between(length, zero), cone.after.between(length, zero)];
        [
            cone.falloff(isa, before_a / r_a, after_a / r_a, m_a / r_a),
            cone.falloff(isa, before_b / r_b, after_b / r_b, m_b / r_b),
        ]
    }

    /// (2.7): the angle `Theta` that the lit interval subtends at the emitter, in `(0, pi]` \[rad\].
    #[cfg_attr(optimized, inline(always))]
    pub(crate) fn subtended(&self, isa: I, exact: bool) -> I::V {
        angle_of(isa, self.foot.h * self.lit.length, self.dot_of_ends(), exact)
    }

    /// [`BIAS`] where `a` is the end nearer to the foot of the perpendicular, else `-BIAS`.
    #[cfg_attr(optimized, inline(always))]
    pub(crate) fn bias_to_a(&self, isa: I) -> I::V {
        let near_a = self.foot.a.abs().lt(self.foot.b.abs());
        I::V::select(near_a, isa.splat(BIAS), isa.splat(-BIAS))
    }

    /// `r_a r_b cos Theta` \[m^2\].
    #[cfg_attr(optimized, inline(always))]
    pub(crate) fn dot_of_ends(&self) -> I::V {
        self.foot.a.mul_add(self.foot.b, self.foot.h_squared)
    }

    /// The antiderivative of `N` over `theta` at a point.
    #[cfg_attr(optimized, inline(always))]
    pub(crate) fn antiderivative(&self, t_prime: I::V, r: I::V) -> I::V {
        self.antiderivative_r(t_prime) / r
    }

    /// The same times `r` \[m\].
    #[cfg_attr(optimized, inline(always))]
    fn antiderivative_r(&self, t_prime: I::V) -> I::V {
        let (alpha, beta_h) = (self.alpha_h / self.foot.h, self.cosine.beta * self.foot.h);
        alpha.mul_add(t_prime, -beta_h)
    }

    /// The arguments of `atan2` in (2.6) for the angle between an end and a point of the lit interval \[m^2\]: `h` times the way
    /// between them, and `r_e r` times the cosine of the angle. The end is `a` in the lanes of `from_a`, else `b`.
    #[cfg_attr(optimized, inline(always))]
    pub(crate) fn seen_from(&self, isa: I, from_a: I::Mask, point: &Point<I>) -> [I::V; 2] {
        let way = I::V::select(from_a, self.way_from_a(isa, point.t), self.way_to_b(isa, point.t));
        let end = I::V::select(from_a, self.foot.a, self.foot.b);
        [self.foot.h * way, end.mul_add(point.t_prime, self.foot.h_squared)]
    }

    /// `t_h` \[m\].
    #[cfg_attr(optimized, inline(always))]
    fn exact_t_h(&self) -> I::Double {
        self.foot.t_h.widen() + (self.foot.t_h_low.widen() + self.refined.t_h.widen())
    }

    /// `h^2` \[m^2\].
    #[cfg_attr(optimized, inline(always))]
    fn exact_h_squared(&self) -> I::Double {
        self.foot.h_squared.widen() + self.refined.h_squared.widen()
    }

    /// (1.13): the length of the path from `t_min` over the point to the emitter \[m\].
    #[cfg_attr(optimized, inline(always))]
    pub(crate) fn path(&self, isa: I, t_min: I::V, point: &Point<I>) -> I::Double {
        (point.exact_t_prime() - (t_min.widen() - self.exact_t_h())) + self.exact_r(isa, point)
    }

    /// (5.7): `X = t' + r`, and `r` \[m\], in f64.
    #[cfg_attr(optimized, inline(always))]
    pub(crate) fn exact_x_and_r(&self, isa: I, point: &Point<I>) -> (I::Double, I::Double) {
        let (t_prime, r) = (point.exact_t_prime(), self.exact_r(isa, point));
        let long = r + t_prime.max(-t_prime);
        let short = self.exact_h_squared() * reciprocal(isa, long);
        // r + t' where t' > 0, else h^2/(r - t'); f64 lanes have no select.
        let sign = I::V::only(isa.splat(0.0).lt(point.t_prime), isa.splat(1.0)).widen();
        (sign.mul_add(long - short, short), r)
    }

    /// `r` in f64, by a Newton step of the root.
    #[cfg_attr(optimized, inline(always))]
    fn exact_r(&self, isa: I, point: &Point<I>) -> I::Double {
        let (t_prime, r) = (point.t_prime.widen(), point.r.widen());
        let high = I::V::narrow((-r).mul_add(r, t_prime.mul_add(t_prime, self.foot.h_squared.widen())));
        let low = (point.t_prime + point.t_prime).mul_add(point.t_prime_low, self.refined.h_squared);
        let step = (high + low) * isa.splat(0.5) / point.r;
        r + step.widen()
    }
}

impl<I: Isa> Foot<I> {
    /// A placeholder where the foot is not needed.
    #[cfg_attr(optimized, inline(always))]
    pub(crate) fn none(isa: I) -> Self {
        let zero = isa.splat(0.0);
        Self { h: zero, h_squared: zero, t_h: zero, t_h_low: zero, a: zero, b: zero }
    }

    /// (2.3): the distance to the emitter \[m\].
    #[cfg_attr(optimized, inline(always))]
    pub(crate) fn r(&self, t_prime: I::V) -> I::V {
        self.r_squared(t_prime).sqrt()
    }

    /// `r^2` \[m^2\].
    #[cfg_attr(optimized, inline(always))]
    pub(crate) fn r_squared(&self, t_prime: I::V) -> I::V {
        t_prime.mul_add(t_prime, self.h_squared)
    }

    /// `t - t_h` \[m\], rounded, and the remainder.
    #[cfg_attr(optimized, inline(always))]
    fn t_prime(&self, t: I::V) -> [I::V; 2] {
        let [difference, left] = two_difference(t, self.t_h);
        let low = left - self.t_h_low;
        let t_prime = difference + low;
        [t_prime, low - (t_prime - difference)]
    }

    /// (1.13) in f32. No term is larger than the path, so that the error is a few roundings of the path.
    #[cfg_attr(optimized, inline(always))]
    pub(crate) fn rounded_path(&self, t_min: I::V, point: &Point<I>) -> I::V {
        (point.t_prime - ((t_min - self.t_h) - self.t_h_low)) + point.r
    }
}

/// `a - b` rounded, and the remainder: their sum is exact.
#[cfg_attr(optimized, inline(always))]
fn two_difference<V: Number>(a: V, b: V) -> [V; 2] {
    let difference = a - b;
    let of_b = a - difference;
    [difference, (a - (difference + of_b)) + (of_b - b)]
}

/// The largest absolute value of a component.
#[cfg_attr(optimized, inline(always))]
fn largest<I: Isa>([x, y, z]: [I::V; 3]) -> I::V {
    x.abs().max(y.abs()).max(z.abs())
}

#[cfg_attr(optimized, inline(always))]
fn dot<N: Number>(a: [N; 3], b: [N; 3]) -> N {
    a[2].mul_add(b[2], a[1].mul_add(b[1], a[0] * b[0]))
}

// No closure in kernels: one that is not inlined is a call, which costs more than the kernel.
#[cfg_attr(optimized, inline(always))]
fn widen<I: Isa>([x, y, z]: [I::V; 3]) -> [I::Double; 3] {
    [x.widen(), y.widen(), z.widen()]
}
