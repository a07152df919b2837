//! `p` nearly proportional to the whole integrand `T rho N / r^2`, without trigonometry and without iteration.
//!
//! The integrand is evaluated at K places of a variable `v` in `[0, 1]`, followed by a line with K knots, and inverted in
//! closed form. `v` is a Moebius map of `X = t' + r`, in which everything is algebraic (our derivation):
//!
//! - `T` is proportional to `exp(-mu_t X)`; `r = (X + h^2/X)/2`, `t' = (X - h^2/X)/2`, `dX/dt = X/r`.
//! - `1 + g^2 + 2 g sin theta = (A^2 X^2 + B^2 h^2)/(X^2 + h^2)` with `A = 1 + g`, `B = 1 - g`.
//! - `Y = X - X_a = Y_c v/(e + 1 - v)`, where `Y_c` is the length over which the integrand changes and `e = Y_c/Y_b`.
//! - A line's values at its inner knots are those of the integrand less a twelfth of `width^2 f''`, as least squares would
//!   have them. At an end, where the integrand may vanish over no length at all, it is drawn through a place inside.

pub(crate) mod along_v;
pub(crate) mod knots;

use along_v::{AlongV, At, ConeAlongV, Units, x_and_h_over_it};

use crate::density::{Density, Drawn, Pdf, SetUp};
use crate::geometry::{Extent, Geometry, Point, RayLanes};
use crate::integrand::{ChannelLanes, Lobe, MediumLanes};
use crate::simd::math::{one_minus_exp, reciprocal};
use crate::simd::{Isa, Lanes, Number, Records, none};

/// `0.65 x + 0.175 (1 - cos(pi x))` at `x = k/16`; with fewer knots every second, fourth or eighth.
const KNOTS: [f32; 17] = [
    0.0,
    0.043_987_576,
    0.094_571_084,
    0.151_367_81,
    0.213_756_31,
    0.280_900_2,
    0.351_780_38,
    0.425_234_2,
    0.5,
    0.574_765_8,
    0.648_219_6,
    0.719_099_8,
    0.786_243_7,
    0.848_632_16,
    0.905_428_95,
    0.956_012_4,
    1.0,
];

/// How far from an end the integrand is looked at in its stead, in widths of the segment.
const INSIDE: f32 = 0.125;
/// The least share of what is seen there that the line keeps at an end.
const LEAST_AT_END: f32 = 0.25;
/// An end with less than this share of the cosine is dark.
const DARK: f32 = 1.0 / 4096.0;
/// So much of the next knot the line counts against what is seen inside a dark end: more than a straight line would, which
/// ends at about 0 and is a difference without digits. The least share stands there.
const NEXT_TO_DARK: f32 = 0.25;
/// The least share of what is seen that the line keeps at a dark end.
const LEAST_IN_THE_DARK: f32 = 0.0625;
/// The least share of the integrand that it keeps between the ends.
const LEAST: f32 = 0.5;

/// No length is resolved below this \[m\].
const SHORTEST: f32 = 1e-18;

#[derive(Clone, Copy)]
pub(crate) struct Product<I: Isa, const K: usize> {
    /// `r` at the ends.
    r_a: I::V,
    r_b: I::V,
    /// `X` at the start.
    x_a: I::V,
    /// `h/X` there.
    h_x_a: I::V,
    h_x_b: I::V,
    /// The scale of the warp, and `e`; what is divided by.
    y_c: I::V,
    inv_y_c: I::V,
    e: I::V,
    inv_e: I::V,
    /// `1/(1 + e)`.
    w_0: I::V,
    /// The density over `v` at the knots; its integral is 1.
    f: [I::V; K],
}

/// Where a variate leads: `v`, `1 - v`, and the density over `v`.
#[derive(Clone, Copy)]
pub(crate) struct Place<I: Isa> {
    v: I::V,
    rest: I::V,
    p_v: I::V,
}

/// Where `v` lies between two knots.
struct Segment<I: Isa> {
    f_0: I::V,
    f_1: I::V,
    v_0: I::V,
    width: I::V,
}

/// Where a given point lies.
struct Found<I: Isa> {
    segment: Segment<I>,
    /// The CDF at the start of the segment.
    below: I::V,
    /// How far `v` is from the knots on both sides.
    from_0: I::V,
    to_1: I::V,
    /// `dv/dY`, `X` and `r`.
    over_y: I::Double,
    x: I::Double,
    r: I::Double,
}

impl<I: Isa, const K: usize> Product<I, K> {
    /// Whether coloured media have a mixture of their channels' densities, not the density of the mean: 3 knots follow none of
    /// them, and with 17 no variance is less than with 9.
    const MIXES: bool = K == 5 || K == 9;

    const V: [f32; K] = {
        let mut v = [0.0; K];
        let mut k = 0;
        while k < K {
            v[k] = KNOTS[k * 16 / (K - 1)];
            k += 1;
        }
        v
    };

    /// Where the integrand is looked at: at the knots, but inside the ends.
    const SEEN: [f32; K] = {
        let mut seen = Self::V;
        seen[0] = INSIDE * Self::V[1];
        seen[K - 1] = 1.0 - INSIDE * (1.0 - Self::V[K - 2]);
        seen
    };

    /// How far that is from 1.
    const TO_1: [f32; K] = {
        let mut to_1 = [0.0; K];
        let mut k = 0;
        while k < K {
            to_1[k] = 1.0 - Self::SEEN[k];
            k += 1;
        }
        to_1[K - 1] = INSIDE * (1.0 - Self::V[K - 2]);
        to_1
    };

    /// How much of `f_{i-1} - f_i` and of `f_{i+1} - f_i` the line is below `f_i` at an inner knot: together a
    /// twenty-fourth of the second derivative times the sum of the squares of both widths.
    const BEND: [[f32; 2]; K] = {
        let mut bend = [[0.0; 2]; K];
        let mut i = 1;
        while i + 1 < K {
            let [below, above] = [Self::V[i] - Self::V[i - 1], Self::V[i + 1] - Self::V[i]];
            let [seen_below, seen_above] = [Self::SEEN[i] - Self::SEEN[i - 1], Self::SEEN[i + 1] - Self::SEEN[i]];
            let share = (below * below + above * above) / (12.0 * (seen_below + seen_above));
            bend[i] = [share / seen_below, share / seen_above];
            i += 1;
        }
        bend
    };

    /// The line's values at the knots, of the integrand's where it is looked at.
    #[cfg_attr(optimized, inline(always))]
    fn line(isa: I, [dark_a, dark_b]: [I::Mask; 2], seen: &[I::V; K]) -> [I::V; K] {
        let c = |x| isa.splat(x);
        let mut f = *seen;
        f[0] = Self::extended(isa, dark_a, seen[0], seen[1]);
        f[K - 1] = Self::extended(isa, dark_b, seen[K - 1], seen[K - 2]);
        let mut i = 1;
        while i + 1 < K {
            let [below, above] = Self::BEND[i];
            let own = seen[i] * c(1.0 + below + above);
            let line = seen[i - 1].mul_add(c(-below), seen[i + 1].mul_add(c(-above), own));
            f[i] = line.max(c(LEAST) * seen[i]);
            i += 1;
        }
        f
    }

    /// The line over its integral, or where that is nothing to go by, uniform in `v`.
    #[cfg_attr(optimized, inline(always))]
    fn normalized(isa: I, line: [I::V; K]) -> [I::V; K] {
        let c = |x| isa.splat(x);
        let (mut f, mut mass, one) = (line, c(0.0), c(1.0));
        let mut k = 1;
        while k < K {
            mass = (f[k - 1] + f[k]).mul_add(c(0.5 * (Self::V[k] - Self::V[k - 1])), mass);
            k += 1;
        }
        let usable = c(1e-30).lt(mass) & mass.le(c(1e36));
        let norm = one / mass;
        let mut k = 0;
        while k < K {
            f[k] = I::V::select(usable, f[k] * norm, one);
            k += 1;
        }
        f
    }

    /// The mean of the densities of the channels that scatter, or of all if none does: no channel's variance is above
    /// `C (1 + V_c) - 1`, with `V_c` that of its own density. `ways` are the `Y` of the knots.
    #[cfg_attr(optimized, inline(always))]
    fn mixture(
        isa: I,
        dark: [I::Mask; 2],
        seen: &[I::V; K],
        ways: &[I::V; K],
        channels: &ChannelLanes<I>,
    ) -> [I::V; K] {
        let (zero, one) = (isa.splat(0.0), isa.splat(1.0));
        let mut most = zero;
        for mu_s in &channels.mu_s[..channels.count] {
            most = most.max(*mu_s);
        }
        let none_scatters = most.le(zero);
        let (mut sum, mut parts) = ([zero; K], zero);
        for (mu_t, mu_s) in channels.mu_t.iter().zip(&channels.mu_s).take(channels.count) {
            let part = I::V::only(none_scatters | zero.lt(*mu_s), one);
            let mut of_channel = *seen;
            let mut k = 0;
            while k < K {
                let (_, transmittance) = one_minus_exp(isa, *mu_t * ways[k]);
                of_channel[k] = transmittance * seen[k];
                k += 1;
            }
            let f = Self::normalized(isa, Self::line(isa, dark, &of_channel));
            let mut k = 0;
            while k < K {
                sum[k] = part.mul_add(f[k], sum[k]);
                k += 1;
            }
            parts = parts + part;
        }
        let share = one / parts;
        let mut k = 0;
        while k < K {
            sum[k] = sum[k] * share;
            k += 1;
        }
        sum
    }

    /// The line's value at an end, straight on from the next knot through what is seen inside, or lower.
    #[cfg_attr(optimized, inline(always))]
    fn extended(isa: I, dark: I::Mask, seen: I::V, next: I::V) -> I::V {
        let c = |x| isa.splat(x);
        let beyond = INSIDE / (1.0 - INSIDE);
        let of_next = I::V::select(dark, c(NEXT_TO_DARK), c(beyond));
        let least = I::V::select(dark, c(LEAST_IN_THE_DARK), c(LEAST_AT_END));
        (-next).mul_add(of_next, seen * c(1.0 + beyond)).max(least * seen)
    }

    /// The segment for which `beyond(i, C_i)` holds for all `i` up to its start, where `C_i` is the CDF at knot `i`.
    #[cfg_attr(optimized, inline(always))]
    fn segment(&self, isa: I, beyond: impl Fn(usize, I::V) -> I::Mask) -> (Segment<I>, I::V) {
        let mut below = isa.splat(0.0);
        let mut cdf = below;
        let [f_0, f_1] = [self.f[0], self.f[1]];
        let mut s = Segment { f_0, f_1, v_0: isa.splat(Self::V[0]), width: isa.splat(Self::V[1] - Self::V[0]) };
        let mut i = 1;
        while i + 1 < K {
            let half_width = isa.splat(0.5 * (Self::V[i] - Self::V[i - 1]));
            cdf = (self.f[i - 1] + self.f[i]).mul_add(half_width, cdf);
            let here = beyond(i, cdf);
            s.f_0 = I::V::select(here, self.f[i], s.f_0);
            s.f_1 = I::V::select(here, self.f[i + 1], s.f_1);
            s.v_0 = I::V::select(here, isa.splat(Self::V[i]), s.v_0);
            s.width = I::V::select(here, isa.splat(Self::V[i + 1] - Self::V[i]), s.width);
            below = I::V::select(here, cdf, below);
            i += 1;
        }
        (s, below)
    }

    /// From a density over `v` where `Y + Y_c = Y_c/s`: `dv/dt = (dv/dY) X/r`.
    #[cfg_attr(optimized, inline(always))]
    fn pdf_over_v(&self, isa: I, p_v: I::V, s: I::V, x: I::V, r: I::V) -> Pdf<I> {
        // In this order no part of it leaves f32 before the whole does.
        let over_y = (p_v * s) * (s * ((isa.splat(1.0) + self.e) * self.inv_y_c));
        Pdf { over_t: over_y * (x / r), times_r2: over_y * (x * r) }
    }
}

impl<I: Isa, const K: usize> Density<I> for Product<I, K> {
    const EXTENT: Extent = Extent::Cosine;
    type Place = Place<I>;
    type SetUps = Records<SetUp<I, Self>>;

    #[cfg_attr(optimized, inline(always))]
    fn new(
        isa: I,
        _: &RayLanes<I>,
        geometry: Geometry<'_, I>,
        medium: &MediumLanes<I>,
        channels: Option<&ChannelLanes<I>>,
    ) -> (Self, I::Mask) {
        let c = |x| isa.splat(x);
        let (g, one) = (geometry, c(1.0));
        let Lobe { a2, b2, b_over_a, .. } = medium.lobe;

        let (ends, h) = (g.ends(isa), g.foot.h);
        let [r_a, r_b] = ends.r;
        let inv_h = one / h;
        let (x_a, h_x_a) = x_and_h_over_it(isa, h, inv_h, g.foot.a, r_a);
        let (x_b, h_x_b) = x_and_h_over_it(isa, h, inv_h, g.foot.b, r_b);
        let y_b = g.lit.length * ((x_a + x_b) / (r_a + r_b));
        let reach = x_a.mul_add(c(1.5), c(1.25) * h * b_over_a);
        let inv_y_c = medium.mu_t.mul_add(c(0.45), one / reach).min(c(1.0 / SHORTEST));
        let y_c = one / inv_y_c;
        let e = y_c / y_b;
        let inv_e = y_b * inv_y_c;
        let w_0 = one / (one + e);

        // At a knot P, Q stand for h, X, in a scale of their own that keeps their powers within f32.
        let (h_c, x_c) = (h * inv_y_c, x_a * inv_y_c);
        let scale = one / h_c.max(x_c).max(one);
        let (h_c, x_c) = (h_c * scale, x_c * scale);
        let (h_c, x_c, y_c_c) = (w_0 * h_c, w_0 * x_c, w_0 * scale);
        let units = Units { of_v: w_0, of_to_1: inv_e, h_x_a, h_x_b };
        let m_along = AlongV::new(isa, &g.cosine.ramp(isa), w_0 * g.cosine.m_least * inv_y_c, &units);
        let cone = ConeAlongV::new(isa, g, w_0 * inv_y_c, scale, &units);

        let channels = channels.filter(|_| Self::MIXES);
        // What is seen: as a whole, or of coloured media without the transmittance, which each channel has of its own.
        let mut seen = [one; K];
        let mut ways = [one; K];
        let mut k = 0;
        while k < K {
            let v = c(Self::SEEN[k]);
            let to_1 = c(Self::TO_1[k]);
            let rest = e + to_1;
            let transmittance = if channels.is_some() {
                ways[k] = y_c * (v / rest);
                one
            } else {
                one_minus_exp(isa, medium.mu_t * y_c * (v / rest)).1
            };

            let p = h_c * rest;
            let q = x_c.mul_add(rest, y_c_c * v);
            let at = At { v, to_1, scale: rest, p, q };
            let m = m_along.at(&at);
            let p2 = p * p;
            let s_1 = q.mul_add(q, p2).max(c(1e-18));
            let s_2 = (a2 * q).mul_add(q, b2 * p2).max(c(1e-18));
            let mut numerator = I::V::select(g.cosine.has_normal, m.max(c(0.0)), s_1);
            if let Some(cone) = &cone {
                numerator = numerator * cone.at(isa, &at, m, s_1);
            }
            seen[k] = transmittance * numerator / (s_2 * (s_1 * s_2).sqrt());
            k += 1;
        }
        let dark = g.dark_ends(isa, &ends, DARK);
        let f = match channels {
            None => Self::normalized(isa, Self::line(isa, dark, &seen)),
            Some(channels) => Self::mixture(isa, dark, &seen, &ways, channels),
        };
        let density = Self { r_a, r_b, x_a, h_x_a, h_x_b, y_c, inv_y_c, e, inv_e, w_0, f };
        (density, g.lit(isa) & g.bright(isa, &ends))
    }

    #[cfg_attr(optimized, inline(always))]
    fn draw(&self, isa: I, _: Geometry<'_, I>, u: I::V) -> Place<I> {
        let c = |x| isa.splat(x);
        let one = c(1.0);
        let (segment, below) = self.segment(isa, |_, cdf| cdf.le(u));
        let Segment { f_0, f_1, v_0, width } = segment;
        let (g_0, g_1, area) = (width * f_0, width * f_1, u - below);
        let root = g_0.mul_add(g_0, (g_1 - g_0) * (area + area)).max(c(0.0)).sqrt();
        // Off the knots, where the density may be 0.
        let tau = ((area + area) / (g_0 + root).max(c(1e-37))).max(c(1e-7)).min(c(1.0 - f32::EPSILON));
        // What is left of tau, and of v, is never 0.
        let left = one - tau;
        let p_v = tau.mul_add(f_1, left * f_0);
        let v = tau.mul_add(width, v_0);
        Place { v, rest: left.mul_add(width, one - (v_0 + width)), p_v }
    }

    #[cfg_attr(optimized, inline(always))]
    fn point(&self, isa: I, geometry: Geometry<'_, I>, place: &Place<I>) -> Drawn<I> {
        let c = |x| isa.splat(x);
        let (g, h, one) = (geometry, geometry.foot.h, c(1.0));
        let Place { v, rest, p_v } = *place;
        let y_rest = self.y_c / (self.e + rest);
        let y = y_rest * v;
        let to_y_b = y_rest * rest * (one + self.inv_e);
        let x = self.x_a + y;
        let h_x = h / x;
        let half = c(0.5);
        let from_a = (half * y * self.h_x_a.mul_add(h_x, one)).min(g.lit.length);
        let to_b = (half * to_y_b * self.h_x_b.mul_add(h_x, one)).min(g.lit.length);
        let r = half * h.mul_add(h_x, x);
        // t' from where the least cancels: X, or an end.
        let (scale_a, scale_b) = (g.foot.a.abs() + from_a, g.foot.b.abs() + to_b);
        let by_end = I::V::select(scale_a.lt(scale_b), g.foot.a + from_a, g.foot.b - to_b);
        let by_x = half * (x - h * h_x);
        let near_end = scale_a.min(scale_b).lt(r);
        let t_prime = I::V::select(near_end, by_end, by_x).max(g.foot.a).min(g.foot.b);
        let point = g.as_rounded(g.point_between(isa, from_a, to_b, t_prime), r);
        let s = (self.e + rest) * self.w_0;
        let pdf = self.pdf_over_v(isa, p_v, s, x, r);
        Drawn { point, pdf, bisected: none(isa) }
    }

    #[cfg_attr(optimized, inline(always))]
    fn pdf(&self, isa: I, geometry: Geometry<'_, I>, point: &Point<I>) -> Pdf<I> {
        let Found { segment, from_0, to_1, over_y, x, r, .. } = self.find(isa, geometry, point);
        let p_v = segment.f_1.mul_add(from_0, segment.f_0 * to_1) / segment.width;
        // dY/dt = X/r.
        let over_y = (p_v.widen() * x) * over_y;
        Pdf { over_t: I::V::narrow(over_y * reciprocal(isa, r)), times_r2: I::V::narrow(over_y * r) }
    }

    #[cfg_attr(optimized, inline(always))]
    fn cdf(&self, isa: I, geometry: Geometry<'_, I>, point: &Point<I>) -> I::V {
        let Found { segment, below, from_0, to_1, .. } = self.find(isa, geometry, point);
        // The line is `p_v` here.
        let p_v = segment.f_1.mul_add(from_0, segment.f_0 * to_1) / segment.width;
        (segment.f_0 + p_v).mul_add(from_0 * isa.splat(0.5), below)
    }
}

impl<I: Isa, const K: usize> Product<I, K> {
    /// In f64, from the geometry to the place between two knots and back: a dozen roundings, which the slope of the density
    /// multiplies, would be most of the error.
    #[cfg_attr(optimized, inline(always))]
    fn find(&self, isa: I, geometry: Geometry<'_, I>, point: &Point<I>) -> Found<I> {
        let c = |x| isa.splat(x);
        let g = geometry;
        let (x, r) = g.foot.exact_x_and_r(isa, point);
        let [(x_a, r_a), (x_b, r_b)] = g.exact_ends(isa, [self.r_a, self.r_b]);
        let over_a = reciprocal(isa, r_a + r);
        let over_b = reciprocal(isa, r_b + r);
        let y = g.way_from_a(isa, point.t).widen() * ((x_a + x) * over_a);
        let to_y_b = g.way_to_b(isa, point.t).widen() * ((x_b + x) * over_b);
        let (y_c, e) = (self.y_c.widen(), self.e.widen());
        let over_sum = reciprocal(isa, y + y_c);
        let turn = (e + isa.splat_double(1.0)) * over_sum;
        let v = y * turn;
        let rest = to_y_b * (e * over_sum);
        let (segment, below) = self.segment(isa, |i, _| c(Self::V[i]).le(I::V::narrow(v)));
        // By v or by 1 - v, whichever has the smaller error: a segment is narrow, and the density may vanish within it.
        let near_0 = I::V::narrow(v - rest).lt(c(0.0));
        let (v_0, v_1) = (segment.v_0, segment.v_0 + segment.width);
        let (left, right) = (c(1.0) - v_0, c(1.0) - v_1);
        let from_0 = I::V::select(near_0, I::V::narrow(v - v_0.widen()), I::V::narrow(left.widen() - rest));
        let to_1 = I::V::select(near_0, I::V::narrow(v_1.widen() - v), I::V::narrow(rest - right.widen()));
        let (from_0, to_1) = (from_0.max(c(0.0)), to_1.max(c(0.0)));
        // dv/dY = Y_c (1 + e)/(Y + Y_c)^2.
        Found { segment, below, from_0, to_1, over_y: turn * (y_c * over_sum), x, r }
    }
}
