//! A ray and an emitter as the densities see them: distances from the foot of the perpendicular, clipped to the lit side.
//!
//! All of it rests on three numbers: `t_h` (where the ray passes the emitter), `h` (at what distance) and `t' = t - t_h`.
//! With them nothing below cancels, however far the emitter, short the interval or small `h`: angles are taken between two
//! points of the ray, distances from one of its ends or from the foot.
//!
//! They are found in f32, with what roundings leave where that matters (`single`), and in f64 (`double`) for the rays for
//! which this is not enough.

mod cone;
mod double;
mod single;

pub(crate) use cone::{Cone, Ramp, SpotLanes, locate as in_cone};
pub(crate) use single::{clip, find_foot};

use crate::scene::{FARTHEST, UNIT_TOLERANCE};
use crate::simd::math::{angle_of, reciprocal};
use crate::simd::{Double, Isa, Lanes, Number, none};

/// How much of the geometry is asked for: each has what those before it have.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(crate) enum Extent {
    /// Whether anything is lit.
    Lit,
    /// What is lit, and the foot of the perpendicular.
    Foot,
    /// The emitter's cosine.
    Cosine,
}

/// The rays of a lane group.
pub(crate) struct RayLanes<I: Isa> {
    pub(crate) origin: [I::V; 3],
    pub(crate) direction: [I::V; 3],
    pub(crate) t_min: I::V,
    pub(crate) t_max: I::V,
}

impl<I: Isa> RayLanes<I> {
    /// Where the ray ends \[m\]: no farther than [`FARTHEST`]; NaN stays NaN.
    #[cfg_attr(optimized, inline(always))]
    pub(crate) fn end(&self, isa: I) -> I::V {
        isa.splat(FARTHEST).min(self.t_max)
    }
}

/// Their emitters.
#[derive(Clone, Copy)]
pub(crate) struct EmitterLanes<I: Isa> {
    position: [I::V; 3],
    normal: [I::V; 3],
    has_normal: I::Mask,
    valid: I::Mask,
    /// Which lanes have a normal of length 1, or none, and are not very far away.
    plain: I::Mask,
    /// `n.(x - y)` in the emitter's plane: 0, but without a normal it is larger than anything.
    in_plane: I::V,
}

impl<I: Isa> EmitterLanes<I> {
    /// The normal (0, 0, 0) stands for none.
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

/// By how much the square of a unit vector's length may differ from 1.
const TOLERANCE: f32 = 2.001 * UNIT_TOLERANCE;

/// Coordinates up to this leave room for products of them in f32 \[m\].
const PLAIN: f32 = 1e15;

/// For how much of the variates beyond those of half of the angle a point is still measured from the end that is nearer to
/// the foot of the perpendicular. From the other end the way to it is long, and what it leaves to the near end would have
/// the error of all of it.
pub(crate) const BIAS: f32 = 0.05;

/// The part of the ray that the emitter faces.
#[derive(Clone, Copy)]
pub(crate) struct Lit<I: Isa> {
    /// Its start.
    pub(crate) a: End<I>,
    /// Its end.
    pub(crate) b: End<I>,
    /// `t_b - t_a` \[m\]; 0 where nothing is lit.
    pub(crate) length: I::V,
    /// Which lanes hold a ray and an emitter at all; in f32 which of them need no f64.
    pub(crate) valid: I::Mask,
}

/// The emitter's cosine N along the ray, as `m = n.(x - y) = N r` \[m\].
#[derive(Clone, Copy)]
pub(crate) struct Cosine<I: Isa> {
    /// `m` at the end of the lit interval where it is smaller, `a` where `beta >= 0`, else `b`; whatever it is without a
    /// normal, and exactly 0 where the interval was clipped.
    pub(crate) m_least: I::V,
    /// `beta = n.d`, by which `m` grows along the ray.
    pub(crate) beta: I::V,
    /// Which lanes have an emitter with a normal.
    pub(crate) has_normal: I::Mask,
}

impl<I: Isa> Cosine<I> {
    /// That of emitters without a normal.
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

    /// Where `m` grows along the ray, or stays.
    #[cfg_attr(optimized, inline(always))]
    pub(crate) fn rising(&self, isa: I) -> I::Mask {
        isa.splat(0.0).le(self.beta)
    }
}

/// One end of the lit interval.
#[derive(Clone, Copy)]
pub(crate) struct End<I: Isa> {
    /// Distance along the ray \[m\], rounded.
    pub(crate) t: I::V,
    /// What the rounding left: 0 where the ray itself ends.
    t_low: I::V,
}

/// The foot of the perpendicular from the emitter to the ray's line, and where the lit interval lies from there.
#[derive(Clone, Copy)]
pub(crate) struct Foot<I: Isa> {
    /// Distance from the emitter \[m\], its square, and what the rounding of that left.
    pub(crate) h: I::V,
    pub(crate) h_squared: I::V,
    h_squared_low: I::V,
    /// A number near the distance along the ray \[m\], and what it lacks.
    t_h: I::V,
    t_h_low: I::V,
    /// `t' = t - t_h` at the ends of the lit interval \[m\].
    pub(crate) a: I::V,
    pub(crate) b: I::V,
    /// `m` at the foot \[m\]: with `beta`, `m = alpha_h + beta t'`, (21).
    pub(crate) alpha_h: I::V,
}

/// The geometry of a lane group.
#[derive(Clone, Copy)]
pub(crate) struct Geometry<'g, I: Isa> {
    pub(crate) lit: &'g Lit<I>,
    pub(crate) cosine: &'g Cosine<I>,
    pub(crate) foot: &'g Foot<I>,
    /// Where there are spots; other lanes have `is_spot` false.
    pub(crate) cone: Option<&'g Cone<I>>,
}

/// The ends of the lit interval as the emitter sees them: at `a` and at `b`.
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
    /// Which lanes measure it from the direction of `a`, the others from that of `b`.
    pub(crate) from_a: I::Mask,
    /// `tan(delta/2) <= 1` of the angle `delta` from there.
    pub(crate) tan_half: I::V,
}

/// A point of the ray.
#[derive(Clone, Copy)]
pub(crate) struct Point<I: Isa> {
    /// Distance along the ray \[m\], rounded.
    pub(crate) t: I::V,
    /// `t - t_h` \[m\], exact to a few ulp also where `t` cannot resolve it.
    pub(crate) t_prime: I::V,
    /// What is known of it beyond its rounding.
    t_prime_low: I::V,
    /// Distance to the emitter \[m\].
    pub(crate) r: I::V,
    /// `n.(x - y) = N r` \[m\], of a spot `S r`, whatever it is without either; not negative.
    m: I::V,
}

/// The records of a lane group by themselves.
pub(crate) type Located<I> = (Lit<I>, Cosine<I>, Foot<I>);

/// The geometry of a lane group in f64.
#[cfg_attr(optimized, inline(always))]
pub(crate) fn in_f64<I: Isa>(isa: I, ray: &RayLanes<I>, emitter: &EmitterLanes<I>) -> Located<I> {
    double::locate(isa, ray, emitter)
}

/// `yes` in `hard` lanes, `no` in the others.
#[cfg_attr(optimized, inline(always))]
pub(crate) fn pick<I: Isa>(hard: I::Mask, yes: &Located<I>, no: Geometry<'_, I>) -> Located<I> {
    let (lit, cosine, foot) = yes;
    let end = |yes: &End<I>, no: &End<I>| End {
        t: I::V::select(hard, yes.t, no.t),
        t_low: I::V::select(hard, yes.t_low, no.t_low),
    };
    (
        Lit {
            a: end(&lit.a, &no.lit.a),
            b: end(&lit.b, &no.lit.b),
            length: I::V::select(hard, lit.length, no.lit.length),
            valid: (hard & lit.valid) | (!hard & no.lit.valid),
        },
        Cosine {
            m_least: I::V::select(hard, cosine.m_least, no.cosine.m_least),
            beta: I::V::select(hard, cosine.beta, no.cosine.beta),
            has_normal: (hard & cosine.has_normal) | (!hard & no.cosine.has_normal),
        },
        Foot {
            h: I::V::select(hard, foot.h, no.foot.h),
            h_squared: I::V::select(hard, foot.h_squared, no.foot.h_squared),
            h_squared_low: I::V::select(hard, foot.h_squared_low, no.foot.h_squared_low),
            t_h: I::V::select(hard, foot.t_h, no.foot.t_h),
            t_h_low: I::V::select(hard, foot.t_h_low, no.foot.t_h_low),
            a: I::V::select(hard, foot.a, no.foot.a),
            b: I::V::select(hard, foot.b, no.foot.b),
            alpha_h: I::V::select(hard, foot.alpha_h, no.foot.alpha_h),
        },
    )
}

impl<I: Isa> Geometry<'_, I> {
    /// Which lanes have a part that the emitter faces.
    #[cfg_attr(optimized, inline(always))]
    pub(crate) fn faced(&self, isa: I) -> I::Mask {
        isa.splat(1e-18).lt(self.lit.length)
    }

    /// Which of these have an interval whose angle and length f32 can tell from none: it subtends more than 1e-30 rad, and is
    /// longer than 1e-36 of `r^2`.
    #[cfg_attr(optimized, inline(always))]
    pub(crate) fn lit(&self, isa: I) -> I::Mask {
        // Without a root: (|t'| + h)/1.42 is r or up to 1.42 times less.
        let h = self.foot.h;
        let rr = (self.foot.a.abs() + h) * (self.foot.b.abs() + h) * isa.splat(0.5);
        let wide = (rr * isa.splat(1e-30)).lt(h * self.lit.length) & (rr * isa.splat(1e-36)).lt(self.lit.length);
        self.faced(isa) & wide
    }

    /// The same, given the angle that the lit interval subtends.
    #[cfg_attr(optimized, inline(always))]
    pub(crate) fn lit_by_angle(&self, isa: I, subtended: I::V) -> I::Mask {
        // Of an interval that is short against r, it is r_a r_b.
        let rr = self.dot_of_ends().abs();
        self.faced(isa) & isa.splat(1e-30).lt(subtended) & (rr * isa.splat(1e-36)).lt(self.lit.length)
    }

    /// The ends as the emitter sees them.
    #[cfg_attr(optimized, inline(always))]
    pub(crate) fn ends(&self, isa: I) -> Ends<I> {
        let r = [self.foot.r(self.foot.a), self.foot.r(self.foot.b)];
        let cosine = |m: I::V, r: I::V| I::V::select(self.cosine.has_normal, m / r, isa.splat(1.0));
        let [m_a, m_b] = self.m_at_ends(isa);
        Ends { r, n: [cosine(m_a, r[0]), cosine(m_b, r[1])] }
    }

    /// Which lanes have more than 1e-25 of the light that an emitter faced squarely would give: below that N has no more
    /// to say in f32.
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

    /// `h (|alpha| + |beta|)` \[m\]: no cosine is larger, nor the largest one less than two thirds of it.
    #[cfg_attr(optimized, inline(always))]
    fn greatest_cosine_h(&self) -> I::V {
        self.cosine.beta.abs().mul_add(self.foot.h, self.foot.alpha_h.abs())
    }

    /// Which ends have less than `share` of `|alpha| + |beta|`, the size of the cosine, or where the interval subtends less
    /// than a right angle, of the sum of those at the ends; of a spot, of its full intensity.
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

    /// The falloff at the ends.
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

    /// The angle `Theta` that the lit interval subtends at the emitter, in `(0, pi]` \[rad\].
    #[cfg_attr(optimized, inline(always))]
    pub(crate) fn subtended(&self, isa: I) -> I::V {
        angle_of(isa, self.foot.h * self.lit.length, self.dot_of_ends())
    }

    /// `BIAS` where `a` is the end nearer to the foot of the perpendicular, else minus that.
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

    /// `S = alpha sin theta - beta cos theta` at the ends: `dS/dtheta = N`.
    #[cfg_attr(optimized, inline(always))]
    pub(crate) fn antiderivatives(&self, ends: &Ends<I>) -> [I::V; 2] {
        [self.antiderivative(self.foot.a, ends.r[0]), self.antiderivative(self.foot.b, ends.r[1])]
    }

    /// The same at a point.
    #[cfg_attr(optimized, inline(always))]
    pub(crate) fn antiderivative(&self, t_prime: I::V, r: I::V) -> I::V {
        let (alpha, beta_h) = (self.foot.alpha_h / self.foot.h, self.cosine.beta * self.foot.h);
        alpha.mul_add(t_prime, -beta_h) / r
    }

    /// `h` times the way from `a` to a point of the lit interval, and `r_a r` times the cosine of the angle between them
    /// \[m^2\]; or from `b`.
    #[cfg_attr(optimized, inline(always))]
    pub(crate) fn seen_from(&self, isa: I, from_a: I::Mask, point: &Point<I>) -> [I::V; 2] {
        let way = I::V::select(from_a, self.way_from_a(isa, point.t), self.way_to_b(isa, point.t));
        let end = I::V::select(from_a, self.foot.a, self.foot.b);
        [self.foot.h * way, end.mul_add(point.t_prime, self.foot.h_squared)]
    }

    /// The point at an angle `delta` from an end, with `tau = tan(delta/2)`.
    ///
    /// With `t'_e` counted towards the interval, its distance from the end is `2 tau r_e^2 / D` and its `t'` is
    /// `h (t'_e (1 - tau^2) + 2 tau h) / D`, where `D = h (1 - tau^2) - 2 tau t'_e`.
    #[cfg_attr(optimized, inline(always))]
    pub(crate) fn point_at_angle(&self, isa: I, angle: &Angle<I>) -> Point<I> {
        let c = |x| isa.splat(x);
        let Angle { from_a, tan_half: tau } = *angle;
        let (h, h_squared) = (self.foot.h, self.foot.h_squared);
        let of_end = |a: I::V, b: I::V| I::V::select(from_a, a, b);
        // Distances towards b, or towards a.
        let sign = of_end(c(1.0), c(-1.0));
        let te = sign * of_end(self.foot.a, self.foot.b);
        let re_squared = te.mul_add(te, h_squared);
        let scale = c(1.0) / (-tau).mul_add(h.mul_add(tau, te + te), h);
        let offset = ((tau + tau) * (re_squared * scale)).min(self.lit.length);
        let by_angle = (h * scale) * tau.mul_add((-te).mul_add(tau, h + h), te);
        // Not far from the end it is known better by that.
        let t_prime = I::V::select((offset + offset).lt(te.abs()), te + offset, by_angle);
        // t from the end or from the foot, whichever is nearer.
        let near_end = offset.lt(t_prime.abs());
        let way = I::V::select(near_end, offset, t_prime);
        let base = I::V::select(near_end, of_end(self.lit.a.t, self.lit.b.t), self.foot.t_h);
        let low = I::V::select(near_end, of_end(self.lit.a.t_low, self.lit.b.t_low), self.foot.t_h_low);
        let t = self.within(base + sign.mul_add(way, low));
        let t_prime = sign * t_prime;

        let rest = self.rest(isa, offset, t_prime, of_end(self.foot.b, self.foot.a));
        let r = self.foot.r(t_prime);
        let m = self.m_between(isa, of_end(offset, rest), of_end(rest, offset), r);
        Point { t, t_prime, t_prime_low: c(0.0), r, m }
    }

    /// The point at these distances from the ends and from the foot of the perpendicular.
    #[cfg_attr(optimized, inline(always))]
    pub(crate) fn point_between(&self, isa: I, from_a: I::V, to_b: I::V, t_prime: I::V) -> Point<I> {
        let r = self.foot.r(t_prime);
        let m = self.m_between(isa, from_a, to_b, r);
        let t = self.distance(t_prime, from_a, to_b);
        Point { t, t_prime, t_prime_low: isa.splat(0.0), r, m }
    }

    /// `m` from the end where it is smaller: both terms are positive. Of a spot it is `S r`.
    #[cfg_attr(optimized, inline(always))]
    fn m_between(&self, isa: I, from_a: I::V, to_b: I::V, r: I::V) -> I::V {
        let m = self.cosine.ramp(isa).between(from_a, to_b);
        let Some(cone) = self.cone else { return m };
        let [before, after] = [cone.before.between(from_a, to_b) / r, cone.after.between(from_a, to_b) / r];
        I::V::select(cone.is_spot, cone.falloff(isa, before, after, m / r) * r, m)
    }

    /// `m` of a point on the ray: 0 outside the cone of a spot, also if its edge is hard.
    #[cfg_attr(optimized, inline(always))]
    fn m_inside(&self, isa: I, from_a: I::V, to_b: I::V, r: I::V) -> I::V {
        let zero = isa.splat(0.0);
        let m = self.m_between(isa, from_a.max(zero), to_b.max(zero), r);
        let Some(cone) = self.cone else { return m };
        I::V::only(!cone.is_spot | (zero.le(from_a) & zero.le(to_b)), m)
    }

    /// `m` at the ends of the lit interval.
    #[cfg_attr(optimized, inline(always))]
    fn m_at_ends(&self, isa: I) -> [I::V; 2] {
        let (rising, least) = (self.cosine.rising(isa), self.cosine.m_least);
        let most = self.cosine.beta.abs().mul_add(self.lit.length, least);
        [I::V::select(rising, least, most), I::V::select(rising, most, least)]
    }

    /// The same with the `t'` and the `r` of what was rounded to `t`, where `t` is smaller than about `r` and so resolves
    /// it: they are exact then.
    #[cfg_attr(optimized, inline(always))]
    pub(crate) fn as_rounded(&self, point: Point<I>, about_r: I::V) -> Point<I> {
        let t_prime = I::V::select(point.t.lt(about_r), self.foot.t_prime(point.t)[0], point.t_prime);
        Point { t_prime, r: self.foot.r(t_prime), ..point }
    }

    /// The point of the ray at the given distance, which may lie outside the lit interval.
    #[cfg_attr(optimized, inline(always))]
    pub(crate) fn point_at_distance(&self, isa: I, t: I::V) -> Point<I> {
        let [t_prime, t_prime_low] = self.foot.t_prime(t);
        let r = self.foot.r(t_prime);
        let m = self.m_inside(isa, (t - self.lit.a.t) - self.lit.a.t_low, (self.lit.b.t - t) + self.lit.b.t_low, r);
        Point { t, t_prime, t_prime_low, r, m }
    }

    /// The point at the distance `s` from the start of the ray, no farther than its end.
    #[cfg_attr(optimized, inline(always))]
    pub(crate) fn point_beyond(&self, isa: I, t_min: I::V, s: I::V, t_max: I::V) -> Point<I> {
        let t = t_min.widen() + s.widen();
        let exact = t - self.foot.exact_t_h();
        let t_prime = I::V::narrow(exact);
        let t_prime_low = I::V::narrow(exact - t_prime.widen());
        let from_a = I::V::narrow((t - self.lit.a.t.widen()) - self.lit.a.t_low.widen());
        let to_b = I::V::narrow((self.lit.b.t.widen() - t) + self.lit.b.t_low.widen());
        let r = self.foot.r(t_prime);
        let m = self.m_inside(isa, from_a, to_b, r);
        let t = (t_min + s).min(t_max);
        Point { t, t_prime, t_prime_low, r, m }
    }

    /// The start of the lit interval, given `r` there.
    #[cfg_attr(optimized, inline(always))]
    pub(crate) fn start(&self, isa: I, r_a: I::V) -> Point<I> {
        let [m, _] = self.m_at_ends(isa);
        Point { t: self.lit.a.t, t_prime: self.foot.a, t_prime_low: isa.splat(0.0), r: r_a, m }
    }

    /// `X` and `r` \[m\] in f64 at the ends of the lit interval, given `r` there as rounded.
    #[cfg_attr(optimized, inline(always))]
    pub(crate) fn exact_ends(&self, isa: I, [r_a, r_b]: [I::V; 2]) -> [(I::Double, I::Double); 2] {
        [self.exact_end(isa, &self.lit.a, r_a), self.exact_end(isa, &self.lit.b, r_b)]
    }

    #[cfg_attr(optimized, inline(always))]
    fn exact_end(&self, isa: I, end: &End<I>, r: I::V) -> (I::Double, I::Double) {
        let exact = (end.t.widen() + end.t_low.widen()) - self.foot.exact_t_h();
        let t_prime = I::V::narrow(exact);
        let t_prime_low = I::V::narrow(exact - t_prime.widen());
        self.foot.exact_x_and_r(isa, &Point { t: end.t, t_prime, t_prime_low, r, m: isa.splat(0.0) })
    }

    /// The distance of `t` from the start of the lit interval \[m\], 0 before it.
    #[cfg_attr(optimized, inline(always))]
    pub(crate) fn way_from_a(&self, isa: I, t: I::V) -> I::V {
        ((t - self.lit.a.t) - self.lit.a.t_low).max(isa.splat(0.0))
    }

    /// And from its end.
    #[cfg_attr(optimized, inline(always))]
    pub(crate) fn way_to_b(&self, isa: I, t: I::V) -> I::V {
        ((self.lit.b.t - t) + self.lit.b.t_low).max(isa.splat(0.0))
    }

    /// What is left of the interval beyond `offset` from one end: by the length, or by `t'` where that is smaller.
    #[cfg_attr(optimized, inline(always))]
    fn rest(&self, isa: I, offset: I::V, t_prime: I::V, far_t_prime: I::V) -> I::V {
        let by_length = (self.lit.length - offset).max(isa.splat(0.0));
        let size = t_prime.abs().max(far_t_prime.abs());
        I::V::select(self.lit.length.lt(size), by_length, (t_prime - far_t_prime).abs())
    }

    /// `t` from the nearest of the places that are known exactly: the ends, and `t_h`.
    #[cfg_attr(optimized, inline(always))]
    fn distance(&self, t_prime: I::V, from_a: I::V, to_b: I::V) -> I::V {
        let at_b = to_b.lt(from_a);
        let by_foot = t_prime.abs().lt(from_a.min(to_b));
        let pick = |foot: I::V, a: I::V, b: I::V| I::V::select(by_foot, foot, I::V::select(at_b, b, a));
        let base = pick(self.foot.t_h, self.lit.a.t, self.lit.b.t);
        let low = pick(self.foot.t_h_low, self.lit.a.t_low, self.lit.b.t_low);
        self.within(base + (low + pick(t_prime, from_a, -to_b)))
    }

    /// `t`, or the nearer end of the lit interval.
    #[cfg_attr(optimized, inline(always))]
    fn within(&self, t: I::V) -> I::V {
        t.max(self.lit.a.t).min(self.lit.b.t)
    }

    /// The cosine `N` at a point; 1 of a spot.
    #[cfg_attr(optimized, inline(always))]
    pub(crate) fn cosine(&self, isa: I, point: &Point<I>) -> I::V {
        I::V::select(self.cosine.has_normal, point.m / point.r, isa.splat(1.0))
    }

    /// The intensity at a point: the cosine `N`, or the falloff `S` of a spot.
    #[cfg_attr(optimized, inline(always))]
    pub(crate) fn intensity(&self, isa: I, point: &Point<I>) -> I::V {
        let varies = match self.cone {
            Some(cone) => self.cosine.has_normal | cone.is_spot,
            None => self.cosine.has_normal,
        };
        I::V::select(varies, point.m / point.r, isa.splat(1.0))
    }
}

impl<I: Isa> Foot<I> {
    /// One that nothing asks for.
    #[cfg_attr(optimized, inline(always))]
    pub(crate) fn none(isa: I) -> Self {
        let zero = isa.splat(0.0);
        let (t_h, t_h_low, h_squared_low) = (zero, zero, zero);
        Self { h: zero, h_squared: zero, h_squared_low, t_h, t_h_low, a: zero, b: zero, alpha_h: zero }
    }

    /// The distance to the emitter \[m\].
    #[cfg_attr(optimized, inline(always))]
    pub(crate) fn r(&self, t_prime: I::V) -> I::V {
        self.r_squared(t_prime).sqrt()
    }

    /// Its square.
    #[cfg_attr(optimized, inline(always))]
    pub(crate) fn r_squared(&self, t_prime: I::V) -> I::V {
        t_prime.mul_add(t_prime, self.h_squared)
    }

    /// `t - t_h` \[m\], rounded, and what the rounding left.
    #[cfg_attr(optimized, inline(always))]
    fn t_prime(&self, t: I::V) -> [I::V; 2] {
        let [difference, left] = two_difference(t, self.t_h);
        let low = left - self.t_h_low;
        let t_prime = difference + low;
        [t_prime, low - (t_prime - difference)]
    }

    /// `t_h` \[m\].
    #[cfg_attr(optimized, inline(always))]
    fn exact_t_h(&self) -> I::Double {
        self.t_h.widen() + self.t_h_low.widen()
    }

    /// `h^2` \[m^2\].
    #[cfg_attr(optimized, inline(always))]
    fn exact_h_squared(&self) -> I::Double {
        self.h_squared.widen() + self.h_squared_low.widen()
    }

    /// The length of the path from `t_min` over the point to the emitter \[m\].
    #[cfg_attr(optimized, inline(always))]
    pub(crate) fn path(&self, isa: I, t_min: I::V, point: &Point<I>) -> I::Double {
        (point.exact_t_prime() - (t_min.widen() - self.exact_t_h())) + self.exact_r(isa, point)
    }

    /// `X = t' + r` and `r` \[m\] in f64: `exp(-mu_t X)` is the transmittance but for a constant.
    #[cfg_attr(optimized, inline(always))]
    pub(crate) fn exact_x_and_r(&self, isa: I, point: &Point<I>) -> (I::Double, I::Double) {
        let (t_prime, r) = (point.exact_t_prime(), self.exact_r(isa, point));
        let long = r + t_prime.max(-t_prime);
        let short = self.exact_h_squared() * reciprocal(isa, long);
        // r + t' where t' > 0, else h^2/(r - t'): there is no select of doubles.
        let sign = I::V::only(isa.splat(0.0).lt(point.t_prime), isa.splat(1.0)).widen();
        (sign.mul_add(long - short, short), r)
    }

    /// `r` by a Newton step of its root: the exponential multiplies an error of the optical depth by the depth.
    #[cfg_attr(optimized, inline(always))]
    fn exact_r(&self, isa: I, point: &Point<I>) -> I::Double {
        let (t_prime, r) = (point.t_prime.widen(), point.r.widen());
        let high = I::V::narrow((-r).mul_add(r, t_prime.mul_add(t_prime, self.h_squared.widen())));
        let low = (point.t_prime + point.t_prime).mul_add(point.t_prime_low, self.h_squared_low);
        let step = (high + low) * isa.splat(0.5) / point.r;
        r + step.widen()
    }
}

impl<I: Isa> Point<I> {
    #[cfg_attr(optimized, inline(always))]
    fn exact_t_prime(&self) -> I::Double {
        self.t_prime.widen() + self.t_prime_low.widen()
    }
}

/// `a - b` rounded, and what the rounding left: together exact.
#[cfg_attr(optimized, inline(always))]
fn two_difference<V: Number>(a: V, b: V) -> [V; 2] {
    let difference = a - b;
    let of_b = a - difference;
    [difference, (a - (difference + of_b)) + (of_b - b)]
}

/// The size of the largest component.
#[cfg_attr(optimized, inline(always))]
fn largest<I: Isa>([x, y, z]: [I::V; 3]) -> I::V {
    x.abs().max(y.abs()).max(z.abs())
}

#[cfg_attr(optimized, inline(always))]
fn dot<N: Number>(a: [N; 3], b: [N; 3]) -> N {
    a[2].mul_add(b[2], a[1].mul_add(b[1], a[0] * b[0]))
}

// Spelt out, as all of the kernels: a closure that is not inlined is a call, and a call costs more than the kernel.
#[cfg_attr(optimized, inline(always))]
fn widen<I: Isa>([x, y, z]: [I::V; 3]) -> [I::Double; 3] {
    [x.widen(), y.widen(), z.widen()]
}
