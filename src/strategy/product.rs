//! The product density: nearly proportional to the whole integrand `T rho N / r^2`, without trigonometry and without iteration.
//!
//! The integrand is evaluated at K places of a variable `v` in `[0, 1]`, replaced by a line with K knots, and inverted in closed
//! form. Equations are those of `docs/mathematics.md`, which also has a table of the names below.
//!
//! ```text
//! new    X = t' + r at both ends                                                   (5.7)
//!        Y_b = X_b - X_a = l (X_a + X_b)/(r_a + r_b)                               (5.8)
//!        1/Y_c = 0.45 mu_t + 1/(1.5 X_a + 1.25 h B/A),   e = Y_c/Y_b               (6.1), (6.2)
//!        for every knot, at z_k:   s = e + 1 - z,   P = h s,   Q = X_a s + Y_c z   (6.9)
//!            q_k = exp(-mu_t Y_c z/s) (m X s^2) (P^2 + Q^2)^(-1/2) (A^2 Q^2 + B^2 P^2)^(-3/2)   (6.10)
//!        f_k = q_k less a twelfth of width^2 q''; straight on to the ends          (6.11)-(6.14)
//!        f_k over the trapezoid sum of f
//! draw   the segment i with C_i <= u; tau by the quadratic formula                 (6.15)
//!        v = v_i + tau l,   p_v = f_i + tau (f_{i+1} - f_i)
//! point  Y = Y_c v/(e + 1 - v); t from Y                                           (6.3), (6.16)
//!        p_t = p_v (dv/dY) X/r                                                     (6.17), (6.18)
//! pdf    v = (1 + e) Y/(Y + Y_c); the same p_t                                     (6.4)
//! cdf    C_i + (f_i + p_v)/2 (v - v_i)                                             (6.19)
//! ```
//!
//! Departures from this, and why:
//!
//! 1. In exact precision, lengths at a knot are in units of the largest of `h`, `X_a`, `Y_c`, and times `1/(1 + e)`: no power of them leaves f32, for
//!    `e` of any size. Constant factors of `q` are left out, as the sum divides them out.
//! 2. Floors: `Y_c` is at least 1e-18 m; in exact precision `P^2 + Q^2` and `A^2 Q^2 + B^2 P^2` are at least 1e-18 of these units,
//!    `m` at least 0. They keep the quotient (6.10) finite where its terms vanish.
//! 3. If the sum is no usable number, the density is uniform in `v`: valid, if not good.
//! 4. `tau` stays within [1e-7, 1 - 2^-23], off the knots, where the density may be 0.
//! 5. `point` takes `t'` from where the least cancels, an end or `X`, and weights have the `r` of the rounded `t` where `t`
//!    resolves it.
//! 6. `pdf` and `cdf` compute `v` and `1 - v` of a given `t` in f64: a dozen roundings, multiplied by the slope of the density,
//!    would be most of their error.
//! 7. Fast precision has (6.20), (6.21) of `seen` in place of (6.9), (6.10), and a shorter exponential. There the denominator of `q`
//!    is at least 1e-30, `e` at most 1e30, and `mu_t Y_c` at most 2.25, which it exceeds only where `Y_c` is at its floor.
//! 8. In coloured media 5 and 9 knots have the mixture (9.1) of the channels' densities, other numbers the density of the mean.

pub(crate) mod along_v;
pub(crate) mod knots;
mod seen;

use along_v::x_and_h_over_it;
use seen::{Lengths, Scaled, Unscaled};

use crate::Precision;
use crate::density::{Density, Drawn, Pdf, SetUp};
use crate::geometry::{Extent, Geometry, Point, RayLanes};
use crate::integrand::{ChannelLanes, MediumLanes};
use crate::simd::math::{one_minus_exp, reciprocal};
use crate::simd::{Isa, Lanes, Number, Records, none};

/// `v_k` of (6.6), `0.65 x + 0.175 (1 - cos(pi x))` at `x = k/16`; with fewer knots every second, fourth or eighth of them.
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

/// The place where the integrand is evaluated instead of an end: its distance from the end, in widths of the segment (6.7).
const INSIDE: f32 = 0.125;
/// The least value of the line at an end, as a share of the integrand seen there (6.13).
const LEAST_AT_END: f32 = 0.25;
/// An end with less than this share of the cosine is dark.
const DARK: f32 = 1.0 / 4096.0;
/// The factor of the next knot at a dark end (6.14): more than the 1/7 of a straight line, which would end at about 0 as a
/// difference without digits. The least share decides there.
const NEXT_TO_DARK: f32 = 0.25;
/// The least value of the line at a dark end, as a share of the integrand seen there (6.14).
const LEAST_IN_THE_DARK: f32 = 0.0625;
/// The least value of the line at an inner knot, as a share of the integrand (6.11).
const LEAST: f32 = 0.5;

/// The least `Y_c` \[m\].
const SHORTEST: f32 = 1e-18;

#[derive(Clone, Copy)]
pub(crate) struct Product<I: Isa, const K: usize> {
    map: Map<I>,
    /// The density over `v` at the knots, `f_k`; its integral is 1.
    f: [I::V; K],
}

/// The map between `v` and the points of the lit interval.
#[derive(Clone, Copy)]
struct Map<I: Isa> {
    /// `X` at the start.
    x_a: I::V,
    /// `h/X` at the ends.
    h_x_a: I::V,
    h_x_b: I::V,
    /// `Y_c` and `e` of the variable `v`, and their reciprocals.
    y_c: I::V,
    inv_y_c: I::V,
    e: I::V,
    inv_e: I::V,
    /// `1/(1 + e)`.
    w_0: I::V,
}

/// The place of a variate: `v`, `1 - v` as `rest`, and the density over `v`.
#[derive(Clone, Copy)]
pub(crate) struct Place<I: Isa> {
    v: I::V,
    rest: I::V,
    p_v: I::V,
}

/// The segment that contains `v`: `f_i`, `f_{i+1}`, `v_i` and its width `l`.
struct Segment<I: Isa> {
    f_0: I::V,
    f_1: I::V,
    v_0: I::V,
    width: I::V,
}

/// The place of a given point.
struct Found<I: Isa> {
    segment: Segment<I>,
    /// The CDF at the start of the segment.
    below: I::V,
    /// The distances of `v` from the knots on both sides.
    from_0: I::V,
    to_1: I::V,
    /// `dv/dY`, `X` and `r`.
    over_y: I::Double,
    x: I::Double,
    r: I::Double,
}

impl<I: Isa, const K: usize> Product<I, K> {
    /// Whether coloured media have a mixture of the densities of their channels, not the density of the mean: each of the two
    /// that are most in use. More would take longer to compile than they are worth.
    const MIXES: bool = K == 5 || K == 9;

    /// `v_k` (6.6).
    const V: [f32; K] = {
        let mut v = [0.0; K];
        let mut k = 0;
        while k < K {
            v[k] = KNOTS[k * 16 / (K - 1)];
            k += 1;
        }
        v
    };

    /// `z_k`, where the integrand is evaluated: the knots, but places inside at the ends (6.7).
    const SEEN: [f32; K] = {
        let mut seen = Self::V;
        seen[0] = INSIDE * Self::V[1];
        seen[K - 1] = 1.0 - INSIDE * (1.0 - Self::V[K - 2]);
        seen
    };

    /// `1 - z_k`.
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

    /// The weights of `q_{i-1} - q_i` and of `q_{i+1} - q_i` by which the line is below `q_i` at an inner knot: together
    /// `q''_i (l_-^2 + l_+^2)/24` of (6.11), (6.12).
    const BEND: [[f32; 2]; K] = {
        let mut bend = [[0.0; 2]; K];
        let mut i = 1;
        while i + 1 < K {
            let [l_below, l_above] = [Self::V[i] - Self::V[i - 1], Self::V[i + 1] - Self::V[i]];
            let [z_below, z_above] = [Self::SEEN[i] - Self::SEEN[i - 1], Self::SEEN[i + 1] - Self::SEEN[i]];
            let share = (l_below * l_below + l_above * l_above) / (12.0 * (z_below + z_above));
            bend[i] = [share / z_below, share / z_above];
            i += 1;
        }
        bend
    };

    /// Calls `f` for each of at most 9 knots: compilers do not unroll a loop as long as this.
    #[cfg_attr(optimized, inline(always))]
    fn for_each_knot(mut f: impl FnMut(usize)) {
        const { assert!(K <= 9 || !<Self as Density<I>>::HAS_FAST_SET_UP) };
        f(0);
        f(1);
        f(2);
        if K > 3 {
            f(3);
            f(4);
        }
        if K > 5 {
            f(5);
            f(6);
            f(7);
            f(8);
        }
    }

    /// The line's values `f_k` at the knots, from the integrand's values `q_k` at the places `z_k`.
    #[cfg_attr(optimized, inline(always))]
    fn line(isa: I, [dark_a, dark_b]: [I::Mask; 2], seen: &[I::V; K]) -> [I::V; K] {
        let c = |x| isa.splat(x);
        let mut f = *seen;
        f[0] = Self::extended(isa, dark_a, seen[0], seen[1]);
        f[K - 1] = Self::extended(isa, dark_b, seen[K - 1], seen[K - 2]);
        let mut i = 1;
        while i + 1 < K {
            // (6.11), (6.12)
            let [of_below, of_above] = Self::BEND[i];
            let own = seen[i] * c(1.0 + of_below + of_above);
            let line = seen[i - 1].mul_add(c(-of_below), seen[i + 1].mul_add(c(-of_above), own));
            f[i] = line.max(c(LEAST) * seen[i]);
            i += 1;
        }
        f
    }

    /// The line over its integral, the trapezoid sum; uniform in `v` where the sum is too small, too large or no number.
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
            f[k] = f[k] * norm;
            k += 1;
        }
        if I::V::bits(!usable) != 0 {
            let mut k = 0;
            while k < K {
                f[k] = I::V::select(usable, f[k], one);
                k += 1;
            }
        }
        f
    }

    /// (9.1): the mean of the densities of the channels that scatter, or of all if none does. No channel's variance is above
    /// `C (1 + V_c) - 1`, with `V_c` that of its own density (9.2). `ways` are the `Y` of the knots.
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

    /// The line's value at an end: straight on from the next knot through the place inside (6.13), of a dark end lower (6.14).
    #[cfg_attr(optimized, inline(always))]
    fn extended(isa: I, dark: I::Mask, seen: I::V, next: I::V) -> I::V {
        let c = |x| isa.splat(x);
        // 1/7
        let beyond = INSIDE / (1.0 - INSIDE);
        let of_next = I::V::select(dark, c(NEXT_TO_DARK), c(beyond));
        let least = I::V::select(dark, c(LEAST_IN_THE_DARK), c(LEAST_AT_END));
        (-next).mul_add(of_next, seen * c(1.0 + beyond)).max(least * seen)
    }

    /// The segment for which `beyond(i, C_i)` holds for all `i` up to its start, and the CDF `C_i` there.
    #[cfg_attr(optimized, inline(always))]
    fn segment(&self, isa: I, beyond: impl Fn(usize, I::V) -> I::Mask) -> (Segment<I>, I::V) {
        let mut below = isa.splat(0.0);
        let mut cdf = below;
        let [f_0, f_1] = [self.f[0], self.f[1]];
        let mut found = Segment { f_0, f_1, v_0: isa.splat(Self::V[0]), width: isa.splat(Self::V[1] - Self::V[0]) };
        let mut i = 1;
        while i + 1 < K {
            let half_width = isa.splat(0.5 * (Self::V[i] - Self::V[i - 1]));
            cdf = (self.f[i - 1] + self.f[i]).mul_add(half_width, cdf);
            let here = beyond(i, cdf);
            found.f_0 = I::V::select(here, self.f[i], found.f_0);
            found.f_1 = I::V::select(here, self.f[i + 1], found.f_1);
            found.v_0 = I::V::select(here, isa.splat(Self::V[i]), found.v_0);
            found.width = I::V::select(here, isa.splat(Self::V[i + 1] - Self::V[i]), found.width);
            below = I::V::select(here, cdf, below);
            i += 1;
        }
        (found, below)
    }

    /// (6.17), (6.18), with `dv/dY = share^2 (1 + e)/Y_c` for `share = Y_c/(Y + Y_c) = s/(1 + e)`.
    #[cfg_attr(optimized, inline(always))]
    fn pdf_over_v(&self, isa: I, p_v: I::V, share: I::V, x: I::V, r: I::V) -> Pdf<I> {
        // In this order no intermediate result leaves f32 before the density does.
        let over_y = (p_v * share) * (share * ((isa.splat(1.0) + self.map.e) * self.map.inv_y_c));
        Pdf { over_t: over_y * (x / r), times_r2: (over_y * x) * r }
    }
}

impl<I: Isa, const K: usize> Density<I> for Product<I, K> {
    const EXTENT: Extent = Extent::Cosine;
    const EXTENT_AT_DISTANCE: Extent = Extent::Path;
    /// Of 3 and 17 knots it would gain less than a fifth.
    const HAS_FAST_SET_UP: bool = K == 5 || K == 9;
    type Place = Place<I>;
    type SetUps = Records<SetUp<I, Self>>;

    #[cfg_attr(optimized, inline(always))]
    fn new(
        isa: I,
        precision: Precision,
        _: &RayLanes<I>,
        geometry: Geometry<'_, I>,
        medium: &MediumLanes<I>,
        channels: Option<&ChannelLanes<I>>,
    ) -> (Self, I::Mask) {
        let c = |x| isa.splat(x);
        let (g, one) = (geometry, c(1.0));
        // X at the ends (5.7), Y_b (5.8), Y_c (6.1), e (6.2).
        let (ends, h) = (g.ends(isa), g.foot.h);
        let [r_a, r_b] = ends.r;
        let inv_h = one / h;
        let (x_a, h_x_a) = x_and_h_over_it(isa, h, inv_h, g.foot.a, r_a);
        let (x_b, h_x_b) = x_and_h_over_it(isa, h, inv_h, g.foot.b, r_b);
        let y_b = g.lit.length * ((x_a + x_b) / (r_a + r_b));
        let reach = x_a.mul_add(c(1.5), c(1.25) * h * medium.lobe.b_over_a);
        let inv_y_c = medium.mu_t.mul_add(c(0.45), one / reach).min(c(1.0 / SHORTEST));
        let y_c = one / inv_y_c;
        let e = y_c / y_b;
        let inv_e = y_b * inv_y_c;
        let w_0 = one / (one + e);

        // h, X_a and Y_c: over Y_c, and over the largest of them.
        let (h_over_y_c, x_over_y_c) = (h * inv_y_c, x_a * inv_y_c);
        let scale = one / h_over_y_c.max(x_over_y_c).max(one);
        let lengths =
            Lengths { h: h_over_y_c * scale, x_a: x_over_y_c * scale, y_c: scale, inv_largest: inv_y_c * scale };
        let map = Map { x_a, h_x_a, h_x_b, y_c, inv_y_c, e, inv_e, w_0 };

        let channels = channels.filter(|_| Self::MIXES);
        // q_k (6.10); of coloured media without the transmittance, which differs between channels.
        let mut seen = [one; K];
        if precision.is_exact::<I>() || !Self::HAS_FAST_SET_UP {
            let depth = if channels.is_some() { None } else { Some(medium.mu_t * y_c) };
            let integrand = Scaled::new(isa, g, &medium.lobe, &map, &lengths);
            let mut k = 0;
            while k < K {
                seen[k] = integrand.at(isa, depth, [Self::SEEN[k], Self::TO_1[k]]);
                k += 1;
            }
        } else {
            // 0 leaves the transmittance out: a branch at every knot would take longer than its exponential.
            let depth = if channels.is_some() { c(0.0) } else { medium.mu_t * y_c };
            let integrand = Unscaled::new(isa, g, &medium.lobe, depth, &map, &lengths);
            Self::for_each_knot(
                #[cfg_attr(optimized, inline(always))]
                |k| seen[k] = integrand.at(isa, [Self::SEEN[k], Self::TO_1[k]]),
            );
            if let Some(falloff) = integrand.falloff(isa, g, &map, &lengths) {
                let mut k = 0;
                while k < K {
                    seen[k] = seen[k] * falloff.at(isa, &integrand, [Self::SEEN[k], Self::TO_1[k]]);
                    k += 1;
                }
            }
        }
        let dark = g.dark_ends(isa, &ends, DARK);
        let f = match channels {
            None => Self::normalized(isa, Self::line(isa, dark, &seen)),
            Some(channels) => {
                let mut ways = [one; K];
                let mut k = 0;
                while k < K {
                    ways[k] = y_c * (c(Self::SEEN[k]) / (e + c(Self::TO_1[k])));
                    k += 1;
                }
                Self::mixture(isa, dark, &seen, &ways, channels)
            }
        };
        (Self { map, f }, g.lit(isa) & g.bright(isa, &ends))
    }

    #[cfg_attr(optimized, inline(always))]
    fn draw(&self, isa: I, _: Geometry<'_, I>, u: I::V) -> Place<I> {
        let c = |x| isa.splat(x);
        let one = c(1.0);
        // (6.15), g = l f
        let (segment, below) = self.segment(isa, |_, cdf| cdf.le(u));
        let Segment { f_0, f_1, v_0, width } = segment;
        let (g_0, g_1, area) = (width * f_0, width * f_1, u - below);
        let root = g_0.mul_add(g_0, (g_1 - g_0) * (area + area)).max(c(0.0)).sqrt();
        // Off the knots, where the density may be 0.
        let tau = ((area + area) / (g_0 + root).max(c(1e-37))).max(c(1e-7)).min(c(1.0 - f32::EPSILON));
        // 1 - tau, and so 1 - v, is never 0.
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
        // Y and Y_b - Y (6.3), X, and h/X.
        let y_rest = self.map.y_c / (self.map.e + rest);
        let y = y_rest * v;
        let to_y_b = y_rest * rest * (one + self.map.inv_e);
        let x = self.map.x_a + y;
        let h_x = h / x;
        // (5.9), (5.10), and r (5.3)
        let half = c(0.5);
        let from_a = (half * y * self.map.h_x_a.mul_add(h_x, one)).min(g.lit.length);
        let to_b = (half * to_y_b * self.map.h_x_b.mul_add(h_x, one)).min(g.lit.length);
        let r = half * h.mul_add(h_x, x);
        // t' from where the least cancels: X (5.3), or an end.
        let (scale_a, scale_b) = (g.foot.a.abs() + from_a, g.foot.b.abs() + to_b);
        let by_end = I::V::select(scale_a.lt(scale_b), g.foot.a + from_a, g.foot.b - to_b);
        let by_x = half * (x - h * h_x);
        let near_end = scale_a.min(scale_b).lt(r);
        let t_prime = I::V::select(near_end, by_end, by_x).max(g.foot.a).min(g.foot.b);
        let point = g.as_rounded(g.point_between(isa, from_a, to_b, t_prime), r);
        let share = (self.map.e + rest) * self.map.w_0;
        let pdf = self.pdf_over_v(isa, p_v, share, x, r);
        Drawn { point, pdf, bisected: none(isa) }
    }

    #[cfg_attr(optimized, inline(always))]
    fn pdf(&self, isa: I, geometry: Geometry<'_, I>, point: &Point<I>) -> Pdf<I> {
        let Found { segment, from_0, to_1, over_y, x, r, .. } = self.find(isa, geometry, point);
        let p_v = segment.f_1.mul_add(from_0, segment.f_0 * to_1) / segment.width;
        // (6.17), (6.18)
        let over_y = (p_v.widen() * x) * over_y;
        Pdf { over_t: I::V::narrow(over_y * reciprocal(isa, r)), times_r2: I::V::narrow(over_y * r) }
    }

    #[cfg_attr(optimized, inline(always))]
    fn cdf(&self, isa: I, geometry: Geometry<'_, I>, point: &Point<I>) -> I::V {
        let Found { segment, below, from_0, to_1, .. } = self.find(isa, geometry, point);
        // (6.19)
        let p_v = segment.f_1.mul_add(from_0, segment.f_0 * to_1) / segment.width;
        (segment.f_0 + p_v).mul_add(from_0 * isa.splat(0.5), below)
    }
}

impl<I: Isa, const K: usize> Product<I, K> {
    /// `v`, `1 - v`, their segment and `dv/dY` of a given point, in f64: (6.4), (6.5).
    #[cfg_attr(optimized, inline(always))]
    fn find(&self, isa: I, geometry: Geometry<'_, I>, point: &Point<I>) -> Found<I> {
        let c = |x| isa.splat(x);
        let g = geometry;
        let (x, r) = g.exact_x_and_r(isa, point);
        let [(x_a, r_a), (x_b, r_b)] = g.exact_ends(isa);
        // Y and Y_b - Y by (5.8)
        let over_a = reciprocal(isa, r_a + r);
        let over_b = reciprocal(isa, r_b + r);
        let y = g.way_from_a(isa, point.t).widen() * ((x_a + x) * over_a);
        let to_y_b = g.way_to_b(isa, point.t).widen() * ((x_b + x) * over_b);
        // (6.4); turn = (1 + e)/(Y + Y_c)
        let (y_c, e) = (self.map.y_c.widen(), self.map.e.widen());
        let over_sum = reciprocal(isa, y + y_c);
        let turn = (e + isa.splat_double(1.0)) * over_sum;
        let v = y * turn;
        let rest = to_y_b * (e * over_sum);
        let (segment, below) = self.segment(isa, |i, _| c(Self::V[i]).le(I::V::narrow(v)));
        // From v or from 1 - v, whichever has the smaller error: a segment is narrow, and the density may vanish within it.
        let near_0 = I::V::narrow(v - rest).lt(c(0.0));
        let (v_0, v_1) = (segment.v_0, segment.v_0 + segment.width);
        let (left, right) = (c(1.0) - v_0, c(1.0) - v_1);
        let from_0 = I::V::select(near_0, I::V::narrow(v - v_0.widen()), I::V::narrow(left.widen() - rest));
        let to_1 = I::V::select(near_0, I::V::narrow(v_1.widen() - v), I::V::narrow(rest - right.widen()));
        let (from_0, to_1) = (from_0.max(c(0.0)), to_1.max(c(0.0)));
        // dv/dY (6.5)
        Found { segment, below, from_0, to_1, over_y: turn * (y_c * over_sum), x, r }
    }
}
