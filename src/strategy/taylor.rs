//! The Taylor densities: the cosine `N` times a Taylor polynomial of the transmittance or of the phase function.
//!
//! Equations of `docs/mathematics.md`, section 4:
//!
//! ```text
//! p_theta proportional to N(theta) P(min(theta, theta_c))                  (4.5)
//!
//! new    first piece, theta up to theta_c: its middle and half width, x = (theta - middle)/half
//!        P(middle + half x), by synthetic division
//!        N(x) = N_m cos(half x) - S_m sin(half x), by its series           (4.6)
//!        P N, and its antiderivative over x
//!        second piece, beyond theta_c: P(theta_c) times the mass of N      (3.6)
//! draw   in the first piece solve CDF(x) = u (inversion.rs)
//!        in the second piece as the point-normal density                   (3.7)-(3.9)
//! point  t, t' from tan(delta/2)                                           (2.8), (2.9)
//! pdf    P(min(theta, theta_c)) N h / (mass r^2)                           (1.8)
//! ```
//!
//! `S` is the antiderivative `M` of `N` of section 3.3. For backward scattering, `g < 0`, the angle is mirrored: `theta` then runs
//! from `b` to `a`.
//!
//! Departures from the paper, and why:
//!
//! 1. The polynomial is trusted up to `theta_c`, and the density keeps the value `P(theta_c)` beyond. So it is positive for every
//!    input.
//! 2. The integral is that of the polynomial `P N` about the middle of the piece, not the closed form (22), which cancels
//!    catastrophically on short intervals. `oracle::paper` has (22).
//! 3. The inverse starts from the line through the density at -1, 0 and 1 and two Newton steps on a quintic, so that few steps
//!    are left. The pdf is that at the angle returned: a residual of the iteration is no bias.
//! 4. `P` and `theta` are in f64 where a density is evaluated: the logarithms of the polynomials have slopes up to 30.

use super::point_normal::{NEAREST, tan_half_at_mass};
use crate::Precision;
use crate::density::{Density, Drawn, Pdf, SetUp};
use crate::expansion::{Expanded, ORDER};
use crate::geometry::{Angle, Extent, Geometry, Point, RayLanes};
use crate::integrand::{ChannelLanes, MediumLanes};
use crate::inversion::{At, solve};
use crate::simd::math::{SIN, angle_of, horner, horner_lanes, sin_cos, tan};
use crate::simd::{Double, GROUPS, Isa, Lanes, Number, Records};
use core::marker::PhantomData;

/// The order of the series of N (4.6). It is odd, as the order of the product is: even and odd terms are summed in pairs.
const COSINE_ORDER: usize = 9;
/// The number of Newton steps on the quintic that starts the iteration.
const QUINTIC_STEPS: usize = 2;
/// The order of `P N`.
const PRODUCT_ORDER: usize = ORDER + COSINE_ORDER;
const _: () = assert!(COSINE_ORDER % 2 == 1 && PRODUCT_ORDER % 2 == 1);

/// A Taylor polynomial of one factor of the integrand.
pub(crate) trait Expansion<I: Isa>: Copy {
    /// The polynomial of a lane group's rays and media.
    fn expand(isa: I, geometry: Geometry<'_, I>, medium: &MediumLanes<I>) -> Expanded<I>;
}

#[derive(Clone, Copy)]
pub(crate) struct Taylor<I: Isa, E> {
    /// `P` over the (mirrored) angle `theta`; its terms cancel near `theta_c`.
    p: [I::Double; ORDER + 1],
    theta_c: I::Double,
    mirrored: I::Mask,
    /// `theta` at the start, and the angle to the end.
    theta_a: I::Double,
    subtended: I::V,
    /// Half the width of the first piece.
    half: I::V,
    /// `P N` on the first piece, in `x`, from degree 0 on.
    product: [I::V; PRODUCT_ORDER + 1],
    /// Its antiderivative over `x`, divided by `x`.
    integral: [I::V; PRODUCT_ORDER + 1],
    /// For the start of the iteration: `P N` at -1, 0 and 1, and the quintic.
    three: [I::V; 3],
    quintic: [I::V; 4],
    /// N at the ends of the second piece, and its antiderivative S, counted towards the piece.
    n_c: I::V,
    n_b: I::V,
    s_c: I::V,
    s_b: I::V,
    /// Integrals of `P N` over `x` from the middle to -1 and over all of it, and over `theta` on the pieces.
    below: I::V,
    scale: I::V,
    mass_1: I::V,
    mass_2: I::V,
    /// `P(theta_c)`, the constant of the second piece.
    p_c: I::V,
    /// Which lanes are worth the iteration.
    wanted: I::Mask,
    expansion: PhantomData<E>,
}

/// The place of a variate.
#[derive(Clone, Copy)]
pub(crate) struct Place<I: Isa> {
    angle: Angle<I>,
    /// The (mirrored) angle `theta`; any angle beyond `theta_c` stands for all of them.
    theta: I::Double,
    bisected: I::Mask,
}

impl<I: Isa, E: Expansion<I>> Density<I> for Taylor<I, E> {
    const EXTENT: Extent = Extent::Cosine;
    type Place = Place<I>;
    // 2, and 1 in an unoptimised build: fewer than the groups of a block, as they do not fit the nearest cache.
    type SetUps = Records<SetUp<I, Self>, { GROUPS.div_ceil(8) }>;

    #[cfg_attr(optimized, inline(always))]
    fn new(
        isa: I,
        _: Precision,
        _: &RayLanes<I>,
        geometry: Geometry<'_, I>,
        medium: &MediumLanes<I>,
        _: Option<&ChannelLanes<I>>,
    ) -> (Self, I::Mask) {
        let c = |x| isa.splat(x);
        let g = geometry;
        let Expanded { p, theta_c, p_c, mirrored } = E::expand(isa, g, medium);

        // The ends in the order of the angle that is expanded.
        let pick = |a: I::V, b: I::V| I::V::select(mirrored, b, a);
        let start_t_prime = pick(g.foot.a, -g.foot.b);
        let (ends, [s_a, s_b]) = g.ends_and_antiderivatives(isa);
        let [n_a, n_b] = ends.n;
        let (n_a, n_b, s_a, s_b) = (pick(n_a, n_b), pick(n_b, n_a), pick(s_a, -s_b), pick(-s_b, s_a));
        let theta_a = angle(isa, start_t_prime, g.foot.h);
        let subtended = g.subtended(isa, true);
        let width = I::V::narrow(theta_c - theta_a).max(c(0.0)).min(subtended);
        let half = width * c(0.5);
        let middle = theta_a + half.widen();

        // N and S at the middle of the first piece and at its end. N is concave and so at least half as large at the middle as at
        // the start: little cancels.
        let (sin, cos) = sin_cos(isa, half);
        let (n_m, s_m) = (n_a.mul_add(cos, -(s_a * sin)), n_a.mul_add(sin, s_a * cos));
        let (n_c, s_c) = (n_m.mul_add(cos, -(s_m * sin)), n_m.mul_add(sin, s_m * cos));
        let n_c = n_c.max(c(0.0));
        // N' = -S.
        let n_m = I::V::select(g.cosine.has_normal, n_m, c(1.0));
        let slope_m = I::V::only(g.cosine.has_normal, -s_m);
        let wave = I::V::only(g.cosine.has_normal, half);

        // P N (4.6) and its antiderivative.
        let product = I::V::multiply(&shift::<I>(p, middle, half), &cosine_series(isa, n_m, slope_m, wave));
        let integral = integrate(isa, &product);
        // The antiderivative, x times `integral`, is the sum of the even and the odd terms at 1, and odd less even at -1.
        let integrals = halves_at_1(&integral);
        let below = integrals[1] - integrals[0];
        let scale = integrals[0] + integrals[0];
        let mass_1 = scale * half;

        let values = halves_at_1(&product);
        let (f_a, f_b) = (values[0] - values[1], values[0] + values[1]);
        let three = [f_a.max(c(0.0)), product[0], f_b.max(c(0.0))];
        let quintic = quintic(isa, product[0], values, integrals);

        // The second piece (3.6), less than a right angle: it starts beyond the foot of the perpendicular, as `theta_c > 0`.
        let rest = subtended - width;
        let cosines = (n_c + n_b) * tan(isa, rest.min(c(core::f32::consts::FRAC_PI_2)) * c(0.5), true);
        let mass_2 = p_c * I::V::select(g.cosine.has_normal, cosines, rest);

        let lit = g.lit(isa) & g.bright(isa, &ends);
        let density = Self {
            p,
            theta_c,
            mirrored,
            theta_a,
            subtended,
            half,
            product,
            integral,
            three,
            quintic,
            n_c,
            n_b,
            s_c,
            s_b,
            below,
            scale,
            mass_1,
            mass_2,
            p_c,
            wanted: lit & g.valid,
            expansion: PhantomData,
        };
        (density, lit)
    }

    #[cfg_attr(optimized, inline(always))]
    fn draw(&self, isa: I, geometry: Geometry<'_, I>, u: I::V) -> Place<I> {
        let c = |x| isa.splat(x);
        let g = geometry;
        let rest = c(1.0) - u;
        let (u, rest) = (I::V::select(self.mirrored, rest, u), I::V::select(self.mirrored, u, rest));
        let total = self.mass_1 + self.mass_2;
        let target = u * total;
        // Without a second piece, u = 1 is the end of the first.
        let width = self.half + self.half;
        let below = target.lt(self.mass_1);
        let first = below | self.subtended.le(width);

        // First piece: the angle from its middle, in units of its half width.
        let share = target / self.mass_1;
        let value = share.mul_add(self.scale, self.below);
        let start = self.first_guess(isa, share, value);
        let start = I::V::select(below, start, c(1.0));
        let wanted = below & self.wanted;
        let root = solve(
            isa,
            #[cfg_attr(optimized, inline(always))]
            |x: I::V| {
                let z = x * x;
                At {
                    value: x.mul_add(by_halves(x, z, &self.integral), -value),
                    slope: by_halves(x, z, &self.product),
                    curvature: self.curvature(isa, x),
                }
            },
            [c(-1.0), c(1.0)],
            start,
            self.scale * c(1.2e-7),
            wanted,
        );
        // Away from the ends, where N may be 0.
        let off = self.subtended * c(1e-8);
        let delta = self.half.mul_add(root.x, self.half).max(off);

        // Second piece: from its end, or from its start where that is near the start of the interval. Its mass may be less than
        // the rounding of the target. (3.7)-(3.9)
        let (from_c, from_b) = (target - self.mass_1, (rest * total).min(self.mass_2));
        let by_start = !first & from_c.lt(from_b) & width.lt(self.subtended * c(0.25));
        let cosines = I::V::select(by_start, from_c, from_b).max(total * c(NEAREST)) / self.p_c;
        let n_end = I::V::select(by_start, self.n_c, self.n_b);
        let s_end = I::V::select(by_start, self.s_c, self.s_b);
        let by_cosines = tan_half_at_mass(isa, n_end, s_end, cosines);
        // From the start of the interval: the tangent of a sum, with the angle of the first piece.
        let before = I::V::only(by_start, tan(isa, self.half, true));
        let by_cosines = (by_cosines + before) / (c(1.0) - by_cosines * before);

        let to_end = self.subtended - delta;
        let near_start = (first & delta.lt(to_end)) | by_start;
        let uniform = cosines + I::V::only(by_start, width);
        let nearest = I::V::select(first, delta.min(to_end), uniform).max(off).min(self.subtended);
        let right_angle = c(core::f32::consts::FRAC_PI_2);
        let by_angle = tan(isa, nearest.min(right_angle) * c(0.5), true);
        let tan_half = I::V::select(first | !g.cosine.has_normal, by_angle, by_cosines);
        let from_a = (near_start & !self.mirrored) | (!near_start & self.mirrored);
        let theta = self.theta_a + I::V::select(first, delta, self.subtended).widen();
        Place { angle: Angle { from_a, tan_half }, theta, bisected: root.bisected }
    }

    #[cfg_attr(optimized, inline(always))]
    fn point(&self, isa: I, geometry: Geometry<'_, I>, place: &Place<I>) -> Drawn<I> {
        let point = geometry.point_at_angle(isa, &place.angle, true);
        Drawn { point, pdf: self.at(isa, geometry, &point, place.theta), bisected: place.bisected }
    }

    #[cfg_attr(optimized, inline(always))]
    fn pdf(&self, isa: I, geometry: Geometry<'_, I>, point: &Point<I>) -> Pdf<I> {
        let t_prime = I::V::select(self.mirrored, -point.t_prime, point.t_prime);
        self.at(isa, geometry, point, angle(isa, t_prime, geometry.foot.h))
    }

    /// From the start in the first piece, from the end in the second.
    #[cfg_attr(optimized, inline(always))]
    fn cdf(&self, isa: I, geometry: Geometry<'_, I>, point: &Point<I>) -> I::V {
        let (c, g) = (|x| isa.splat(x), geometry);
        let [across, along] = g.seen_from(isa, !self.mirrored, point);
        let delta = angle_of(isa, across, along, true);
        let width = self.half + self.half;
        let first = delta.lt(width) | self.subtended.le(width);
        let x = I::V::select(first, delta / self.half - c(1.0), c(1.0));
        let below = (x.mul_add(by_halves(x, x * x, &self.integral), -self.below) / self.scale) * self.mass_1;

        let [across, along] = g.seen_from(isa, self.mirrored, point);
        let rest = angle_of(isa, across, along, true);
        let tan_half = tan(isa, rest.min(c(core::f32::consts::FRAC_PI_2)) * c(0.5), true);
        let cosines = (g.cosine(isa, point) + self.n_b) * tan_half;
        let above = self.p_c * I::V::select(g.cosine.has_normal, cosines, rest);

        let (total, mass) = (self.mass_1 + self.mass_2, I::V::select(first, below, above));
        let cdf = mass / total;
        I::V::select(!first & !self.mirrored | first & self.mirrored, c(1.0) - cdf, cdf)
    }
}

impl<I: Isa, E> Taylor<I, E> {
    /// The `x` where the CDF of the first piece is about `share`, and the integral from its middle about `value`: the inverse for a
    /// density that is linear between -1, 0 and 1, then Newton's method for the quintic.
    #[cfg_attr(optimized, inline(always))]
    fn first_guess(&self, isa: I, share: I::V, value: I::V) -> I::V {
        let c = |x| isa.splat(x);
        let [f_a, f_m, f_b] = self.three;
        let twice_below = f_a + f_m;
        let twice = share * (twice_below + f_m + f_b);
        let above = twice_below.lt(twice);
        let (f_0, f_1) = (I::V::select(above, f_m, f_a), I::V::select(above, f_b, f_m));
        let twice = I::V::select(above, twice - twice_below, twice);
        let root = f_0.mul_add(f_0, (f_1 - f_0) * twice).max(c(0.0)).sqrt();
        let x = twice / (f_0 + root).max(c(1e-37));
        let mut x = I::V::select(above, x, x - c(1.0));
        let [a_2, a_3, a_4, a_5] = self.quintic;
        let mut step = 0;
        while step < QUINTIC_STEPS {
            let q = a_5.mul_add(x, a_4).mul_add(x, a_3).mul_add(x, a_2).mul_add(x, f_m);
            let [b_4, b_3, b_2, b_1] = [a_5 * c(5.0), a_4 * c(4.0), a_3 * c(3.0), a_2 + a_2];
            let slope = b_4.mul_add(x, b_3).mul_add(x, b_2).mul_add(x, b_1).mul_add(x, f_m);
            // The floor keeps a step finite where the density vanishes.
            x = x - x.mul_add(q, -value) / slope.max(self.scale * c(1e-4));
            x = x.max(c(-1.0)).min(c(1.0));
            step += 1;
        }
        x
    }

    /// An approximate derivative of `P N` at `x`: the second derivative of the quintic.
    #[cfg_attr(optimized, inline(always))]
    fn curvature(&self, isa: I, x: I::V) -> I::V {
        let c = |x| isa.splat(x);
        let [a_2, a_3, a_4, a_5] = self.quintic;
        (a_5 * c(20.0)).mul_add(x, a_4 * c(12.0)).mul_add(x, a_3 * c(6.0)).mul_add(x, a_2 + a_2)
    }

    /// (4.5), (1.8): the density at a point whose (mirrored) angle is `theta`.
    #[cfg_attr(optimized, inline(always))]
    fn at(&self, isa: I, geometry: Geometry<'_, I>, point: &Point<I>, theta: I::Double) -> Pdf<I> {
        let p = I::V::narrow(horner_lanes(theta.min(self.theta_c), self.p));
        Pdf::over_angle(p * geometry.cosine(isa, point), self.mass_1 + self.mass_2, geometry, point)
    }
}

/// `theta = atan(t'/h)` \[rad\].
///
/// - Types: f32 to f64.
/// - Max error: 1.7e-8, absolute, for the given `t'` and `h`: a third of half an ulp of f32.
/// - Range: `h > 0`.
#[cfg_attr(optimized, inline(always))]
fn angle<I: Isa>(isa: I, t_prime: I::V, h: I::V) -> I::Double {
    let (c, d) = (|x| isa.splat(x), |x| isa.splat_double(x));
    let size = t_prime.abs();
    let (less, more) = (size.min(h), size.max(h));
    let one_over = c(1.0) / more;
    // Beyond 45 degrees theta is a right angle less the angle of the reciprocal.
    let steep = h.lt(size);
    let sign = I::V::select(t_prime.lt(c(0.0)), c(-1.0), c(1.0));
    let less = less * I::V::select(steep, -sign, sign);
    let quarter = I::V::only(steep, sign).widen();
    let q = (less * one_over).widen();
    // The remainder of the division.
    let rest = less.widen() - q * more.widen();
    let q = rest.mul_add(one_over.widen(), q);
    let z = q * q;
    let p = horner(isa, I::V::narrow(z), ATAN).widen().mul_add(z, d(0.199_976_2)).mul_add(z, d(-0.333_332_63));
    let atan = (q * z).mul_add(p, q);
    quarter.mul_add(d(core::f64::consts::FRAC_PI_2), atan)
}

/// Coefficients, highest degree first, of `(atan q / q - 1) / q^2` in `q^2` for `q` up to 1, without the last two, which are f64.
const ATAN: [f32; 7] =
    [-0.001_602_414, 0.010_025_549, -0.029_446_354, 0.056_127_183, -0.082_897_5, 0.109_102_75, -0.142_554_63];

/// One synthetic division by `theta - middle`, of the coefficients from `first` on.
#[cfg_attr(optimized, inline(always))]
fn divide<N: Number>(q: &mut [N; ORDER + 1], first: usize, middle: N) {
    let mut k = ORDER;
    while k > first {
        q[k - 1] = q[k].mul_add(middle, q[k - 1]);
        k -= 1;
    }
}

/// The coefficients of `p(middle + half x)`.
#[cfg_attr(optimized, inline(always))]
fn shift<I: Isa>(mut p: [I::Double; ORDER + 1], middle: I::Double, half: I::V) -> [I::V; ORDER + 1] {
    // Repeated synthetic division by (theta - middle) leaves the coefficients of P in theta - middle.
    divide(&mut p, 0, middle);
    let mut q = [I::V::narrow(p[0]); ORDER + 1];
    let mut k = 1;
    while k <= ORDER {
        q[k] = I::V::narrow(p[k]);
        k += 1;
    }
    let middle = I::V::narrow(middle);
    let mut first = 1;
    while first < ORDER {
        divide(&mut q, first, middle);
        first += 1;
    }
    let mut power = half;
    let mut k = 1;
    while k <= ORDER {
        q[k] = q[k] * power;
        power = power * half;
        k += 1;
    }
    q
}

/// Coefficients, highest degree first, of `(cos y - 1) / y^2` in `y^2`, for `|y| <= pi/2`: the error of the cosine is 7.3e-8, that
/// of its integral is smaller.
const COS: [f32; 4] = [2.319_438_7e-5, -1.385_592_7e-3, 4.166_399e-2, -0.499_999_3];

/// (4.6): the coefficients of `n cos(wave x) + slope sin(wave x)` for `|x| <= 1`, `wave <= pi/2`.
#[cfg_attr(optimized, inline(always))]
fn cosine_series<I: Isa>(isa: I, n: I::V, slope: I::V, wave: I::V) -> [I::V; COSINE_ORDER + 1] {
    let mut q = [n; COSINE_ORDER + 1];
    let z = wave * wave;
    q[1] = slope * wave;
    let (mut even, mut odd) = (n * z, q[1] * z);
    let mut k = 1;
    while k <= COSINE_ORDER / 2 {
        q[2 * k] = even * isa.splat(COS[COS.len() - k]);
        even = even * z;
        q[2 * k + 1] = odd * isa.splat(SIN[SIN.len() - k]);
        odd = odd * z;
        k += 1;
    }
    q
}

/// The sums of the even and of the odd coefficients.
#[cfg_attr(optimized, inline(always))]
fn halves_at_1<V: Lanes>(p: &[V; PRODUCT_ORDER + 1]) -> [V; 2] {
    let (mut even, mut odd) = (p[PRODUCT_ORDER - 1], p[PRODUCT_ORDER]);
    let mut k = PRODUCT_ORDER - 1;
    while k > 0 {
        k -= 2;
        even = even + p[k];
        odd = odd + p[k + 1];
    }
    [even, odd]
}

/// The polynomial of `x` with coefficients `p`, lowest degree first, given `z = x^2`: even and odd terms are summed apart, which
/// halves the latency.
#[cfg_attr(optimized, inline(always))]
fn by_halves<V: Lanes>(x: V, z: V, p: &[V; PRODUCT_ORDER + 1]) -> V {
    let (mut even, mut odd) = (p[PRODUCT_ORDER - 1], p[PRODUCT_ORDER]);
    let mut k = PRODUCT_ORDER - 1;
    while k > 0 {
        k -= 2;
        even = even.mul_add(z, p[k]);
        odd = odd.mul_add(z, p[k + 1]);
    }
    odd.mul_add(x, even)
}

/// The coefficients, from degree 2 on, of the quintic that agrees with an antiderivative and its slope at -1, 0 and 1. `f_m` is
/// the slope at 0; `values` and `integrals` are the sums at 1 of the even and of the odd terms of the slope, and of the
/// antiderivative over `x`.
#[cfg_attr(optimized, inline(always))]
fn quintic<I: Isa>(isa: I, f_m: I::V, values: [I::V; 2], integrals: [I::V; 2]) -> [I::V; 4] {
    let c = |x| isa.splat(x);
    let a_4 = values[1].mul_add(c(0.5), -integrals[1]);
    let a_5 = (values[0] - integrals[0]).mul_add(c(0.5), f_m - integrals[0]);
    [integrals[1] - a_4, (integrals[0] - f_m) - a_5, a_4, a_5]
}

/// The antiderivative that vanishes at 0, divided by `x`.
#[cfg_attr(optimized, inline(always))]
fn integrate<I: Isa>(isa: I, p: &[I::V; PRODUCT_ORDER + 1]) -> [I::V; PRODUCT_ORDER + 1] {
    let mut q = *p;
    let mut k = 1;
    while k <= PRODUCT_ORDER {
        q[k] = q[k] * isa.splat(1.0 / (k + 1) as f32);
        k += 1;
    }
    q
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::simd::Portable;

    #[test]
    fn the_angle_is_as_exact_as_stated() {
        // A prime, so that the low bits of the tangents are not all 0.
        let worst = (1..262_139).map(|i| i as f32 / 262_139.0).flat_map(|q| [(q, 1.0), (1.0, q), (-q, 1.0)]).fold(
            0.0f64,
            |worst, (t_prime, h): (f32, f32)| {
                let error = angle(Portable, Portable.splat(t_prime), Portable.splat(h))
                    - Portable.splat_double(f64::from(t_prime).atan2(h.into()));
                let scaled = <Portable as Isa>::V::narrow(error * Portable.splat_double(1e9));
                worst.max(scaled.to_array()[0].abs().into())
            },
        );
        assert!(worst <= 17.0, "{worst}e-9");
    }
}
