//! The integrand, times `r^2`: with it `1/r^2` of integrand and density cancel before they overflow.
//!
//! Equations of `docs/mathematics.md`, section 1:
//!
//! ```text
//! f r^2 = mu_s T rho N                                                     (1.2)
//! T = exp(-mu_t (t - t_min + r))                                           (1.3)
//! rho = (1 - g^2) / (4 pi (1 + g^2 + 2 g sin theta)^(3/2))                 (1.4)
//! ```
//!
//! Departures from this, and why:
//!
//! 1. With `EXACT` the path `t - t_min + r` is in f64 (1.13): the exponential multiplies its relative error by the optical depth.
//! 2. Where a part of the product (1.2) or of the density leaves f32, exact precision has their quotient in f64: it may be in the
//!    range of f32 all the same.
//! 3. The denominator of `rho` is (1.11), `(1 - |g|)^2 + 2 |g| (1 + s)` with `s = sin theta sign g` and `1 + s` by (1.12): nothing
//!    cancels.
//! 4. That denominator is at least 1e-24, for `|g|` = 1 alone, where `rho` is 0.

use crate::expansion::Expanded;
use crate::geometry::{Geometry, Point, RayLanes};
use crate::scene::MOST_CHANNELS;
use crate::simd::math::{exp, one_minus_exp};
use crate::simd::{Isa, Lanes, Number};

/// The media of a lane group.
#[derive(Clone, Copy)]
pub(crate) struct MediumLanes<I: Isa> {
    pub(crate) mu_s: I::V,
    pub(crate) mu_t: I::V,
    pub(crate) g: I::V,
    // Computed once for all rays of a medium.
    pub(crate) phase: Expanded<I>,
    pub(crate) lobe: Lobe<I>,
    pub(crate) valid: I::Mask,
}

/// The channels of coloured media of a lane group.
#[derive(Clone, Copy)]
pub(crate) struct ChannelLanes<I: Isa> {
    /// Values beyond `count` mean nothing.
    pub(crate) mu_t: [I::V; MOST_CHANNELS],
    pub(crate) mu_s: [I::V; MOST_CHANNELS],
    pub(crate) count: usize,
}

/// The constants of the phase function in (5.12), (6.1): `A^2`, `B^2` and `B/A`, with `A = 1 + g` and `B = 1 - g`.
#[derive(Clone, Copy)]
pub(crate) struct Lobe<I: Isa> {
    pub(crate) a2: I::V,
    pub(crate) b2: I::V,
    pub(crate) b_over_a: I::V,
    /// `(1 - g^2)/(4 pi)`, 0 where `|g|` is 1.
    pub(crate) height: I::V,
}

/// The f32 next below 1: the largest `|g|` of a lobe, as a phase function without width is no density.
const MOST_FORWARD: f32 = 1.0 - f32::EPSILON / 2.0;

impl<I: Isa> Lobe<I> {
    #[cfg_attr(optimized, inline(always))]
    fn new(isa: I, g: I::V) -> Self {
        let one = isa.splat(1.0);
        let height = (one + g) * (one - g) * isa.splat(0.25 * core::f32::consts::FRAC_1_PI);
        let g = g.max(isa.splat(-MOST_FORWARD)).min(isa.splat(MOST_FORWARD));
        let (a, b) = (one + g, one - g);
        Self { a2: a * a, b2: b * b, b_over_a: b / a, height }
    }
}

impl<I: Isa> MediumLanes<I> {
    #[cfg_attr(optimized, inline(always))]
    pub(crate) fn new(isa: I, mu_a: I::V, mu_s: I::V, g: I::V) -> Self {
        let (zero, mu_t) = (isa.splat(0.0), mu_a + mu_s);
        let valid = zero.le(mu_a) & zero.le(mu_s) & mu_t.le(isa.splat(f32::MAX)) & g.abs().le(isa.splat(1.0));
        Self { mu_s, mu_t, g, phase: Expanded::of_phase(isa, g), lobe: Lobe::new(isa, g), valid }
    }
}

/// The factors of (1.2), with the falloff `S` of a spot in place of `N`.
pub(crate) struct Factors<I: Isa> {
    mu_s: I::V,
    transmittance: I::V,
    phase: I::V,
    intensity: I::V,
}

impl<I: Isa> Factors<I> {
    #[cfg_attr(optimized, inline(always))]
    pub(crate) fn new<const EXACT: bool>(
        isa: I,
        ray: &RayLanes<I>,
        geometry: Geometry<'_, I>,
        medium: &MediumLanes<I>,
        point: &Point<I>,
    ) -> Self {
        Self {
            mu_s: medium.mu_s,
            transmittance: transmittance::<I, EXACT>(isa, ray, geometry, medium, point),
            phase: phase(isa, geometry, medium.g, point),
            intensity: geometry.intensity(isa, point),
        }
    }

    /// The product over a divisor, and the lanes where the result may have too few digits, because the divisor or a part of the
    /// product leaves f32. Lanes without light or transmittance are not among them: their product is 0.
    #[cfg_attr(optimized, inline(always))]
    pub(crate) fn over(&self, isa: I, divisor: I::V) -> (I::V, I::Mask) {
        let (scattered, light) = (self.mu_s * self.transmittance, self.phase * self.intensity);
        let product = scattered * light;
        let least = scattered.min(light).min(product).min(divisor);
        let in_range = isa.splat(f32::MIN_POSITIVE).le(least) & product.le(isa.splat(f32::MAX));
        (product / divisor, !in_range & isa.splat(0.0).lt(self.transmittance.min(self.intensity)))
    }

    /// The integrand (1.1) over a density in f64, given the reciprocals of `r` and of the density.
    #[cfg_attr(optimized, inline(always))]
    pub(crate) fn in_f64(&self, inv_r: I::V, inv_density: I::V) -> I::V {
        let product = (self.mu_s.widen() * self.transmittance.widen()) * (self.phase.widen() * self.intensity.widen());
        let inv_r = inv_r.widen();
        I::V::narrow((product * (inv_r * inv_r)) * inv_density.widen())
    }
}

/// (1.3): the transmittance from `t_min` over the point to the emitter.
#[cfg_attr(optimized, inline(always))]
pub(crate) fn transmittance<I: Isa, const EXACT: bool>(
    isa: I,
    ray: &RayLanes<I>,
    geometry: Geometry<'_, I>,
    medium: &MediumLanes<I>,
    point: &Point<I>,
) -> I::V {
    if EXACT {
        exp(isa, -(medium.mu_t.widen() * geometry.path(isa, ray.t_min, point)))
    } else {
        let (_, transmittance) = one_minus_exp(isa, medium.mu_t * geometry.foot.rounded_path(ray.t_min, point));
        transmittance
    }
}

/// (1.4), by (1.11) and (1.12): the phase function of Henyey and Greenstein \[1/sr\].
#[cfg_attr(optimized, inline(always))]
fn phase<I: Isa>(isa: I, geometry: Geometry<'_, I>, g: I::V, point: &Point<I>) -> I::V {
    let c = |x| isa.splat(x);
    let (h, r) = (geometry.foot.h, point.r);
    let size = g.abs();
    let forward = c(0.0).le(g * point.t_prime);
    let long = r + point.t_prime.abs();
    // (1.12)
    let one_plus_sin = I::V::select(forward, long * long, h * h) / (r * long);
    let away = c(1.0) - size;
    // (1.11); the floor matters for |g| = 1 alone, where h^2/r^2 may leave f32.
    let d = away.mul_add(away, (size + size) * one_plus_sin).max(c(1e-24));
    (away * (c(1.0) + size)) * c(0.25 * core::f32::consts::FRAC_1_PI) / (d * d.sqrt())
}
