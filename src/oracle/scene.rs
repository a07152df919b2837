//! One ray, one emitter, one medium, and the light that is scattered once on the way.

use super::arc::{Arc, Normal, subtended};
use super::quadrature::integrate_pieces;
use crate::scene::{Emitter, FARTHEST, Medium, Ray};
use std::f64::consts::PI;

/// One ray, one emitter, one medium in f64.
///
/// - The direction is normalised in f64: distances are metres whatever the length of the ray's f32 direction.
/// - The normal is taken as it is: its length scales `N`.
/// - `mu_t` is the medium's f32 sum.
/// - `t_max` is at most [`FARTHEST`].
/// - `h` is at least 1e-18 m and at least 1e-12 `|t_min - t_h|`: an emitter on the ray's line is treated as one beside
///   it. `alpha h` stays what it is.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Scene {
    pub(super) t_min: f64,
    pub(super) t_max: f64,
    pub(super) h: f64,
    pub(super) t_h: f64,
    normal: Option<Normal>,
    mu_s: f64,
    pub(super) mu_t: f64,
    pub(super) g: f64,
    pub(super) arc: Option<Arc>,
}

impl Scene {
    /// The scene that the f32 values describe.
    #[must_use]
    pub fn new(ray: &Ray, emitter: &Emitter, medium: &Medium) -> Self {
        // Cross products of f32 values are as good as exact in f64. Of a rounded unit vector they would lose the small h.
        let d = ray.direction().as_dvec3();
        let w = ray.origin().as_dvec3() - emitter.position().as_dvec3();
        let w_cross_d = w.cross(d);
        let foot = d.cross(w_cross_d) / d.length_squared(); // seen from the emitter
        let (t_min, t_max) = (f64::from(ray.t_min()), f64::from(ray.t_max().min(FARTHEST)));
        let t_h = -w.dot(d) / d.length();
        let h = (w_cross_d.length() / d.length()).max(1e-18).max(1e-12 * (t_min - t_h).abs());
        let normal = emitter.normal().map(|n| {
            let n = n.as_dvec3();
            Normal { alpha_h: n.dot(foot), beta: n.dot(d) / d.length() }
        });
        Self {
            t_min,
            t_max,
            h,
            t_h,
            normal,
            mu_s: f64::from(medium.mu_s()),
            mu_t: f64::from(medium.mu_t()),
            g: f64::from(medium.g()),
            arc: Arc::new(h, t_h, (t_min, t_max), normal),
        }
    }

    /// The distance `h` from the emitter to the ray's line \[m\].
    #[must_use]
    pub fn h(&self) -> f64 {
        self.h
    }

    /// Where the ray's line is nearest to the emitter, `t_h` \[m\], signed.
    #[must_use]
    pub fn t_h(&self) -> f64 {
        self.t_h
    }

    /// `alpha = n.u` with `u` from the emitter straight to the ray's line; 0 without a normal.
    #[must_use]
    pub fn alpha(&self) -> f64 {
        self.normal.map_or(0.0, |n| n.alpha_h / self.h)
    }

    /// `beta = n.d`; 0 without a normal.
    #[must_use]
    pub fn beta(&self) -> f64 {
        self.normal.map_or(0.0, |n| n.beta)
    }

    /// The extinction coefficient `mu_t` \[1/m\].
    #[must_use]
    pub fn mu_t(&self) -> f64 {
        self.mu_t
    }

    /// `[t_min, t_max]`, the part of the ray in the medium \[m\].
    #[must_use]
    pub fn interval(&self) -> (f64, f64) {
        (self.t_min, self.t_max)
    }

    /// The part of [`interval`](Self::interval) where `N > 0` \[m\], if there is one.
    #[must_use]
    pub fn lit(&self) -> Option<(f64, f64)> {
        self.arc.map(|arc| (arc.t_a, arc.t_b))
    }

    /// The distance `r` from the point at `t` \[m\] to the emitter \[m\].
    #[must_use]
    pub fn r(&self, t: f64) -> f64 {
        self.h.hypot(t - self.t_h)
    }

    /// The angle `theta` of the point at `t` \[m\], seen from the emitter \[rad\].
    #[must_use]
    pub fn theta(&self, t: f64) -> f64 {
        (t - self.t_h).atan2(self.h)
    }

    /// `theta(t1) - theta(t0)` \[rad\] with all its digits, `t0` and `t1` in metres.
    #[must_use]
    pub fn angle(&self, t0: f64, t1: f64) -> f64 {
        subtended(self.h, t1 - t0, t0 - self.t_h, t1 - self.t_h)
    }

    /// The transmittance `T = exp(-mu_t (t - t_min + r))` from the emitter to the point at `t` \[m\] and on to `t_min`.
    #[must_use]
    pub fn transmittance(&self, t: f64) -> f64 {
        (-self.mu_t * (t - self.t_min + self.r(t))).exp()
    }

    /// The phase function `rho` at `t` \[m\], in 1/sr; finite at `|g|` = 1 too, where it is 0 off its peak.
    #[must_use]
    pub fn phase(&self, t: f64) -> f64 {
        let (t_prime, r) = (t - self.t_h, self.r(t));
        let along = if self.g < 0.0 { -t_prime } else { t_prime };
        // 1 + along/r, but not as a difference of nearly equal numbers
        let one_plus_sin = if along < 0.0 { self.h * (self.h / r) / (r - along) } else { 1.0 + along / r };
        self.henyey_greenstein(one_plus_sin)
    }

    /// The emitter's cosine `N` at `t` \[m\]; 1 without a normal.
    #[must_use]
    pub fn cosine(&self, t: f64) -> f64 {
        self.normal.map_or(1.0, |n| ((n.alpha_h + n.beta * (t - self.t_h)) / self.r(t)).max(0.0))
    }

    /// What is scattered into the ray at `t` \[m\], `mu_s T rho N / r^2` \[1/m^3\], for unit intensity.
    #[must_use]
    pub fn integrand(&self, t: f64) -> f64 {
        self.mu_s * self.transmittance(t) * self.phase(t) * self.cosine(t) / self.r(t).powi(2)
    }

    /// The radiance scattered once, for unit intensity \[1/m^2\]: the integral of [`integrand`](Self::integrand) over
    /// [`lit`](Self::lit), to about 1e-12 of itself.
    #[must_use]
    pub fn radiance(&self) -> f64 {
        let Some(arc) = &self.arc else { return 0.0 };
        let sign = if self.g < 0.0 { -1.0 } else { 1.0 };
        // T, rho and N vary fastest towards the ends of the arc, over angles of any size. As a function of the logarithm of
        // the odds of the angle every such layer is as wide as any other. 1/r^2 goes, for dt/r^2 = dtheta/h.
        let integrand = |s: f64| {
            let angle = arc.at_odds(s);
            let path = arc.t(angle) - self.t_min + self.h / arc.cos_theta(angle);
            let rho = self.henyey_greenstein(arc.one_plus_sin_theta(sign, angle));
            (-self.mu_t * path).exp() * rho * arc.cosine(angle) * angle.from_a * angle.to_b
        };
        // exp(-64) of the arc is left out at each end.
        let ends: [f64; 9] = std::array::from_fn(|i| 16.0 * i as f64 - 64.0);
        self.mu_s / self.h * integrate_pieces(integrand, &ends, 1e-13) / arc.width()
    }

    /// (12), from `1 + sin theta` for `g >= 0` and from `1 - sin theta` for `g < 0`: the distance from the peak.
    fn henyey_greenstein(&self, one_plus_sin: f64) -> f64 {
        let g = self.g.abs();
        let s = (1.0 - g).powi(2) + 2.0 * g * one_plus_sin;
        (1.0 - g) * (1.0 + g) / (4.0 * PI * s * s.sqrt())
    }
}
