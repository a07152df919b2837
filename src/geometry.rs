//! A ray and an emitter as the kernels see them: distances from the foot of the perpendicular, clipped to the lit side.
//!
//! All of it rests on three numbers computed in double precision and rounded once: `t_h` (where the ray passes the
//! emitter), `h` (at what distance) and `t' = t - t_h`. With them nothing below cancels, however far the emitter, short
//! the interval or small `h`: angles are taken between two points of the ray, distances from one of its ends.

use crate::scene::{FARTHEST, UNIT_TOLERANCE};
use crate::simd::math::{angle_of, reciprocal, reciprocal_near};
use crate::simd::{Double, Isa, Lanes, Number};

/// The rays of a lane group.
pub(crate) struct RayLanes<I: Isa> {
    pub(crate) origin: [I::V; 3],
    pub(crate) direction: [I::V; 3],
    pub(crate) t_min: I::V,
    pub(crate) t_max: I::V,
}

/// Their emitters.
#[derive(Clone, Copy)]
pub(crate) struct EmitterLanes<I: Isa> {
    position: [I::Double; 3],
    normal: [I::Double; 3],
    has_normal: I::Mask,
    valid: I::Mask,
}

impl<I: Isa> EmitterLanes<I> {
    /// The normal (0, 0, 0) stands for none.
    #[cfg_attr(optimized, inline(always))]
    pub(crate) fn new(isa: I, position: [I::V; 3], normal: [I::V; 3]) -> Self {
        let size = normal[0].abs() + normal[1].abs() + normal[2].abs();
        let none = size.eq(isa.splat(0.0));
        let farthest = largest::<I>(position).le(isa.splat(FARTHEST));
        let (position, normal) = (widen::<I>(position), widen::<I>(normal));
        let excess = I::V::narrow(dot(normal, normal) - isa.splat_double(1.0));
        let valid = farthest & (excess.abs().le(isa.splat(TOLERANCE)) | none);
        Self { position, normal, has_normal: !none, valid }
    }
}

/// By how much the square of a unit vector's length may differ from 1.
const TOLERANCE: f32 = 2.001 * UNIT_TOLERANCE;

/// Sine of the least angle between a ray and the emitter's plane of which it is known where they meet.
const FLATTEST: f32 = 1e-30;

/// For how much of the variates beyond those of half of the angle a point is still measured from the end that is nearer to
/// the foot of the perpendicular. From the other end the way to it is long, and what it leaves to the near end would have
/// the error of all of it.
pub(crate) const BIAS: f32 = 0.05;

/// One end of the lit interval.
#[derive(Clone, Copy)]
pub(crate) struct End<I: Isa> {
    /// Distance along the ray \[m\], rounded.
    pub(crate) t: I::V,
    /// What the rounding left: 0 where the ray itself ends.
    t_low: I::V,
    /// `t - t_h` \[m\].
    pub(crate) t_prime: I::V,
    /// Distance to the emitter \[m\].
    pub(crate) r: I::V,
    /// `n.(x - y) = N r` there \[m\], whatever it is without a normal: exactly 0 where the interval was clipped.
    pub(crate) m: I::V,
    /// The cosine `N`; 1 without a normal.
    pub(crate) n: I::V,
}

/// A point of the ray.
#[derive(Clone, Copy)]
pub(crate) struct Point<I: Isa> {
    /// Distance along the ray \[m\], rounded.
    pub(crate) t: I::V,
    /// `t - t_h` \[m\], exact to a few ulp also where `t` cannot resolve it.
    pub(crate) t_prime: I::V,
    /// The same where it is known better, as at a given `t`.
    exact_t_prime: I::Double,
    /// Distance to the emitter \[m\].
    pub(crate) r: I::V,
    /// `n.(x - y) = N r` \[m\], whatever it is without a normal; not negative where the point is lit.
    m: I::V,
}

/// The geometry of a lane group.
pub(crate) struct Geometry<I: Isa> {
    /// Distance from the emitter to the ray's line \[m\].
    pub(crate) h: I::V,
    /// Its square, rounded once.
    h_squared: I::V,
    /// `alpha = n.u`: with `beta`, the cosine is `N = alpha cos theta + beta sin theta`, (21).
    pub(crate) alpha: I::V,
    /// `beta = n.d`.
    pub(crate) beta: I::V,
    /// Start of the lit interval.
    pub(crate) a: End<I>,
    /// Its end.
    pub(crate) b: End<I>,
    /// `t_b - t_a` \[m\].
    pub(crate) length: I::V,
    /// Ends of the ray itself \[m\].
    pub(crate) t_min: I::V,
    pub(crate) t_max: I::V,
    /// `h^2` in f64 where it is not below the square of `least_h`.
    foot_squared: I::Double,
    /// The least `h` that f64 tells from none at this distance \[m\].
    least_h: I::V,
    t_h: I::Double,
    t_prime_min: I::Double,
    /// `n.(x - y) = alpha_h + beta_exact t'`.
    alpha_h: I::Double,
    beta_exact: I::Double,
    /// Which lanes have an emitter with a normal.
    pub(crate) has_normal: I::Mask,
    /// Which lanes have a part that the emitter faces.
    pub(crate) faced: I::Mask,
    /// Which of these have an interval whose angle and length f32 can tell from none.
    pub(crate) lit: I::Mask,
    /// Which lanes hold a ray and an emitter at all.
    pub(crate) valid: I::Mask,
}

impl<I: Isa> Geometry<I> {
    #[cfg_attr(optimized, inline(always))]
    pub(crate) fn new(isa: I, ray: &RayLanes<I>, emitter: &EmitterLanes<I>) -> Self {
        let c = |x| isa.splat(x);
        let d = widen::<I>(ray.direction);
        let o = widen::<I>(ray.origin);
        let (y, n) = (emitter.position, emitter.normal);
        let e = [y[0] - o[0], y[1] - o[1], y[2] - o[2]];

        // 1/|d| by its series about |d| = 1: distances are in metres also where d is not quite a unit vector.
        let q = d[2].mul_add(d[2], d[1].mul_add(d[1], d[0].mul_add(d[0], isa.splat_double(-1.0))));
        let unit = q
            .mul_add(isa.splat_double(0.273_437_5), isa.splat_double(-0.3125))
            .mul_add(q, isa.splat_double(0.375))
            .mul_add(q * q, q.mul_add(isa.splat_double(-0.5), isa.splat_double(1.0)));
        let t_h = dot(e, d) * unit;
        let beta_exact = dot(n, d) * unit;
        let along = t_h * unit;
        let foot = [along.mul_add(d[0], -e[0]), along.mul_add(d[1], -e[1]), along.mul_add(d[2], -e[2])];
        let alpha_h = dot(n, foot);

        let t_max = ray.t_max.min(c(FARTHEST));
        let t_prime_min = ray.t_min.widen() - t_h;
        let t_prime_max = t_max.widen() - t_h;
        let (ta, tb) = (I::V::narrow(t_prime_min), I::V::narrow(t_prime_max));
        let least_h = (ta.abs().max((ray.t_min - ta).abs()) * c(1e-9)).max(c(1e-18));
        let foot_squared = dot(foot, foot);
        let size_squared = I::V::narrow(foot_squared);
        let h_squared = (least_h * least_h).max(size_squared);
        let h = h_squared.sqrt();
        let length = t_max - ray.t_min;

        // The sign of m = n.(x - y) at the ends decides what is lit.
        let has_normal = emitter.has_normal;
        let m_a = I::V::narrow(beta_exact.mul_add(t_prime_min, alpha_h));
        let m_b = I::V::narrow(beta_exact.mul_add(t_prime_max, alpha_h));
        let dark_a = has_normal & m_a.le(c(0.0));
        let dark_b = has_normal & m_b.le(c(0.0));
        let beta = I::V::narrow(beta_exact);
        // A ray so flat against the emitter's plane is not cut there: with one end it is dark as a whole.
        let flat = beta.abs().lt(c(FLATTEST));
        let both = (dark_a & dark_b) | (flat & (dark_a | dark_b));
        let (clip_a, clip_b) = (dark_a & !dark_b, dark_b & !dark_a);

        // Where N = 0: a Newton step after the division, as what is lit may be as short as what it leaves.
        let inv_beta = c(1.0) / beta;
        let near = inv_beta.widen();
        let once = -(alpha_h * reciprocal_near(isa, beta_exact, near));
        let t_prime_n = once - beta_exact.mul_add(once, alpha_h) * near;
        let tn = I::V::narrow(t_prime_n).max(ta).min(tb);
        let lit_length = (m_a.max(m_b) * inv_beta.abs()).min(length);
        let length = I::V::select(clip_a | clip_b, lit_length, length);
        let exact_t_n = t_h + t_prime_n;
        let t_n = I::V::narrow(exact_t_n).max(ray.t_min).min(t_max);
        let t_n_low = I::V::narrow(exact_t_n - t_n.widen());

        let (ta, tb) = (I::V::select(clip_a, tn, ta), I::V::select(clip_b, tn, tb));
        let (ra, rb) = (ta.mul_add(ta, h_squared).sqrt(), tb.mul_add(tb, h_squared).sqrt());
        let (m_a, m_b) = (m_a.max(c(0.0)), m_b.max(c(0.0)));
        let a = End {
            t: I::V::select(clip_a, t_n, ray.t_min),
            t_low: I::V::select(clip_a, t_n_low, c(0.0)),
            t_prime: ta,
            r: ra,
            m: m_a,
            n: I::V::select(has_normal, m_a / ra, c(1.0)),
        };
        let b = End {
            t: I::V::select(clip_b, t_n, t_max),
            t_low: I::V::select(clip_b, t_n_low, c(0.0)),
            t_prime: tb,
            r: rb,
            m: m_b,
            n: I::V::select(has_normal, m_b / rb, c(1.0)),
        };

        // Below these f32 has no more to say about an interval: it subtends 1e-30 rad, or is 1e-36 of r^2. Without a root:
        // (|t'| + h)/1.42 is r or up to 1.42 times less.
        let faced = c(1e-18).lt(length) & !both;
        let rr = (ta.abs() + h) * (tb.abs() + h) * c(0.5);
        let wide = (rr * c(1e-30)).lt(h * length) & (rr * c(1e-36)).lt(length);
        let valid = emitter.valid
            & I::V::narrow(q).abs().le(c(TOLERANCE))
            & largest::<I>(ray.origin).le(c(FARTHEST))
            & c(0.0).le(ray.t_min)
            & ray.t_min.le(c(FARTHEST))
            & ray.t_min.le(ray.t_max)
            // No number where one of the coordinates is none.
            & size_squared.le(c(16.0 * FARTHEST * FARTHEST));

        Self {
            h,
            h_squared,
            alpha: I::V::narrow(alpha_h) / h,
            beta,
            a,
            b,
            length,
            t_min: ray.t_min,
            t_max,
            foot_squared,
            least_h,
            t_h,
            t_prime_min,
            alpha_h,
            beta_exact,
            has_normal,
            faced,
            lit: faced & wide,
            valid,
        }
    }

    /// Which lanes have more than 1e-25 of the light that an emitter faced squarely would give: below that N has no more
    /// to say in f32.
    #[cfg_attr(optimized, inline(always))]
    pub(crate) fn bright(&self, isa: I) -> I::Mask {
        let least = isa.splat(1e-25);
        let rr = self.a.r * self.b.r;
        let light = (self.h * self.length) * (self.a.n + self.b.n);
        (self.wide(isa) & (self.h * least).lt(self.greatest_cosine_h())) | (rr * least).lt(light)
    }

    /// Which lanes have an interval that subtends more than a right angle.
    #[cfg_attr(optimized, inline(always))]
    pub(crate) fn wide(&self, isa: I) -> I::Mask {
        self.dot_of_ends().lt(isa.splat(0.0))
    }

    /// `h (|alpha| + |beta|)` \[m\]: no cosine is larger, nor the largest one less than two thirds of it.
    #[cfg_attr(optimized, inline(always))]
    fn greatest_cosine_h(&self) -> I::V {
        self.beta.abs().mul_add(self.h, I::V::narrow(self.alpha_h).abs())
    }

    /// Which ends have less than `share` of `|alpha| + |beta|`, the size of the cosine, or where the interval subtends less
    /// than a right angle, of the sum of those at the ends.
    #[cfg_attr(optimized, inline(always))]
    pub(crate) fn dark_ends(&self, isa: I, share: f32) -> [I::Mask; 2] {
        let (n_a, n_b) = (self.a.n * self.h, self.b.n * self.h);
        let least = I::V::select(self.wide(isa), self.greatest_cosine_h(), n_a + n_b) * isa.splat(share);
        [n_a.lt(least), n_b.lt(least)]
    }

    /// The angle `Theta` that the lit interval subtends at the emitter, in `(0, pi]` \[rad\].
    #[cfg_attr(optimized, inline(always))]
    pub(crate) fn subtended(&self, isa: I) -> I::V {
        angle_of(isa, self.h * self.length, self.dot_of_ends())
    }

    /// `BIAS` where `a` is the end nearer to the foot of the perpendicular, else minus that.
    #[cfg_attr(optimized, inline(always))]
    pub(crate) fn bias_to_a(&self, isa: I) -> I::V {
        let near_a = self.a.t_prime.abs().lt(self.b.t_prime.abs());
        I::V::select(near_a, isa.splat(BIAS), isa.splat(-BIAS))
    }

    /// `r_a r_b cos Theta` \[m^2\].
    #[cfg_attr(optimized, inline(always))]
    pub(crate) fn dot_of_ends(&self) -> I::V {
        self.a.t_prime.mul_add(self.b.t_prime, self.h_squared)
    }

    /// `S = alpha sin theta - beta cos theta` at an end: `dS/dtheta = N`.
    #[cfg_attr(optimized, inline(always))]
    pub(crate) fn antiderivative(&self, end: &End<I>) -> I::V {
        self.alpha.mul_add(end.t_prime, -(self.beta * self.h)) / end.r
    }

    /// The point at the angle `delta` from an end (`a` where `from_a`), given `tau = tan(delta/2) <= 1`.
    ///
    /// With `t'_e` counted towards the interval, its distance from the end is `2 tau r_e^2 / D` and its `t'` is
    /// `h (t'_e (1 - tau^2) + 2 tau h) / D`, where `D = h (1 - tau^2) - 2 tau t'_e`.
    #[cfg_attr(optimized, inline(always))]
    pub(crate) fn point_at_angle(&self, isa: I, from_a: I::Mask, tau: I::V) -> Point<I> {
        let c = |x| isa.splat(x);
        let toward = |a: I::V, b: I::V| I::V::select(from_a, a, -b);
        let te = toward(self.a.t_prime, self.b.t_prime);
        let re_squared = te.mul_add(te, self.h_squared);
        let two_tau = tau + tau;
        let scale = c(1.0) / (-tau).mul_add(self.h.mul_add(tau, te + te), self.h);
        let offset = (two_tau * (re_squared * scale)).min(self.length);
        // Not far from the end it is known better by that.
        let by_end = te + offset;
        let by_angle = (self.h * scale) * tau.mul_add((-te).mul_add(tau, self.h + self.h), te);
        let t_prime = I::V::select((offset + offset).lt(te.abs()), by_end, by_angle);
        let t_prime = toward(t_prime, t_prime).max(self.a.t_prime).min(self.b.t_prime);

        let rest = self.rest(isa, offset, t_prime, I::V::select(from_a, self.b.t_prime, self.a.t_prime));
        let (from_start, to_end) = (I::V::select(from_a, offset, rest), I::V::select(from_a, rest, offset));
        self.point_between(isa, from_start, to_end, t_prime)
    }

    /// The point at these distances from the ends and from the foot of the perpendicular.
    #[cfg_attr(optimized, inline(always))]
    pub(crate) fn point_between(&self, isa: I, from_a: I::V, to_b: I::V, t_prime: I::V) -> Point<I> {
        // m from the end where N is smaller: both terms are positive.
        let rising = isa.splat(0.0).le(self.beta);
        let m_end = I::V::select(rising, self.a.m, self.b.m);
        let m = self.beta.abs().mul_add(I::V::select(rising, from_a, to_b), m_end);
        let t = self.distance(t_prime, from_a, to_b);
        Point { t, t_prime, exact_t_prime: t_prime.widen(), r: self.r(t_prime), m }
    }

    /// The same with the `t'` and the `r` of what was rounded to `t`, where `t` is smaller than about `r` and so resolves
    /// it: they are exact then.
    #[cfg_attr(optimized, inline(always))]
    pub(crate) fn as_rounded(&self, point: Point<I>, about_r: I::V) -> Point<I> {
        let exact = point.t.widen() - self.t_h;
        let t_prime = I::V::select(point.t.lt(about_r), I::V::narrow(exact), point.t_prime);
        Point { t_prime, exact_t_prime: t_prime.widen(), r: self.r(t_prime), ..point }
    }

    /// The point of the ray at the given distance, which may lie outside the lit interval.
    #[cfg_attr(optimized, inline(always))]
    pub(crate) fn point_at_distance(&self, isa: I, t: I::V) -> Point<I> {
        self.point(isa, t, t.widen() - self.t_h)
    }

    /// The point at the distance `s` from `t_min`.
    #[cfg_attr(optimized, inline(always))]
    pub(crate) fn point_from_t_min(&self, isa: I, s: I::V) -> Point<I> {
        self.point(isa, (self.t_min + s).min(self.t_max), self.t_prime_min + s.widen())
    }

    #[cfg_attr(optimized, inline(always))]
    fn point(&self, isa: I, t: I::V, exact_t_prime: I::Double) -> Point<I> {
        let m = I::V::narrow(self.beta_exact.mul_add(exact_t_prime, self.alpha_h));
        let t_prime = I::V::narrow(exact_t_prime);
        Point { t, t_prime, exact_t_prime, r: self.r(t_prime), m: m.max(isa.splat(0.0)) }
    }

    /// The start of the lit interval.
    #[cfg_attr(optimized, inline(always))]
    pub(crate) fn start(&self) -> Point<I> {
        let End { t, t_prime, r, m, .. } = self.a;
        Point { t, t_prime, exact_t_prime: t_prime.widen(), r, m }
    }

    /// The distance of a point of the lit interval from its start \[m\].
    #[cfg_attr(optimized, inline(always))]
    pub(crate) fn way_from_a(&self, isa: I, point: &Point<I>) -> I::V {
        ((point.t - self.a.t) - self.a.t_low).max(isa.splat(0.0))
    }

    /// And from its end.
    #[cfg_attr(optimized, inline(always))]
    pub(crate) fn way_to_b(&self, isa: I, point: &Point<I>) -> I::V {
        ((self.b.t - point.t) + self.b.t_low).max(isa.splat(0.0))
    }

    /// What is left of the interval beyond `offset` from one end: by the length, or by `t'` where that is smaller.
    #[cfg_attr(optimized, inline(always))]
    fn rest(&self, isa: I, offset: I::V, t_prime: I::V, far_t_prime: I::V) -> I::V {
        let by_length = (self.length - offset).max(isa.splat(0.0));
        let size = t_prime.abs().max(far_t_prime.abs());
        I::V::select(self.length.lt(size), by_length, (t_prime - far_t_prime).abs())
    }

    /// `t` from the nearest of the places that are known exactly: the ends, and `t_h`.
    #[cfg_attr(optimized, inline(always))]
    fn distance(&self, t_prime: I::V, from_a: I::V, to_b: I::V) -> I::V {
        let by_a = self.a.t + (self.a.t_low + from_a);
        let by_b = self.b.t + (self.b.t_low - to_b);
        let by_end = I::V::select(to_b.lt(from_a), by_b, by_a);
        let by_foot = I::V::narrow(self.t_h + t_prime.widen());
        let t = I::V::select(t_prime.abs().lt(from_a.min(to_b)), by_foot, by_end);
        t.max(self.a.t).min(self.b.t)
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

    /// The cosine `N` at a point.
    #[cfg_attr(optimized, inline(always))]
    pub(crate) fn cosine(&self, isa: I, point: &Point<I>) -> I::V {
        I::V::select(self.has_normal, point.m / point.r, isa.splat(1.0))
    }

    /// The length of the path from `t_min` over the point to the emitter \[m\].
    #[cfg_attr(optimized, inline(always))]
    pub(crate) fn path(&self, isa: I, point: &Point<I>) -> I::Double {
        let (_, r) = self.exact_r(isa, point);
        (point.exact_t_prime - self.t_prime_min) + r
    }

    /// `X = t' + r` and `r` \[m\] in f64: `exp(-mu_t X)` is the transmittance but for a constant.
    #[cfg_attr(optimized, inline(always))]
    pub(crate) fn exact_x_and_r(&self, isa: I, point: &Point<I>) -> (I::Double, I::Double) {
        let (h_squared, r) = self.exact_r(isa, point);
        let t_prime = point.exact_t_prime;
        let long = r + t_prime.max(-t_prime);
        let short = h_squared * reciprocal(isa, long);
        // r + t' where t' > 0, else h^2/(r - t'): there is no select of doubles.
        let sign = I::V::select(isa.splat(0.0).lt(point.t_prime), isa.splat(1.0), isa.splat(0.0)).widen();
        (sign.mul_add(long - short, short), r)
    }

    /// `h^2`, and `r` by a Newton step of its root: the exponential multiplies an error of the optical depth by the depth.
    #[cfg_attr(optimized, inline(always))]
    fn exact_r(&self, isa: I, point: &Point<I>) -> (I::Double, I::Double) {
        let (t_prime, r) = (point.exact_t_prime, point.r.widen());
        let least = self.least_h.widen();
        let h_squared = self.foot_squared.max(least * least);
        let residual = I::V::narrow(t_prime.mul_add(t_prime, h_squared) - r * r);
        let step = residual * isa.splat(0.5) / point.r;
        (h_squared, r + step.widen())
    }
}

// Spelt out, as all of the kernels: a closure that is not inlined is a call, and a call costs more than the kernel.
#[cfg_attr(optimized, inline(always))]
fn widen<I: Isa>([x, y, z]: [I::V; 3]) -> [I::Double; 3] {
    [x.widen(), y.widen(), z.widen()]
}

/// The size of the largest component.
#[cfg_attr(optimized, inline(always))]
fn largest<I: Isa>([x, y, z]: [I::V; 3]) -> I::V {
    x.abs().max(y.abs()).max(z.abs())
}

#[cfg_attr(optimized, inline(always))]
fn dot<D: Double>(a: [D; 3], b: [D; 3]) -> D {
    a[2].mul_add(b[2], a[1].mul_add(b[1], a[0] * b[0]))
}
