//! A ray, an emitter and a medium, and the light scattered once: sections 1 and 2 of `docs/mathematics.md`.

use super::arc::{Angle, Arc, Normal, subtended};
use super::cone::{Cone, Line};
use super::quadrature::integrate_pieces;
use super::twofold::Vector;
use crate::scene::{Emitter, FARTHEST, Medium, Ray};
use std::f64::consts::PI;

/// A ray, an emitter and a medium in f64.
///
/// - The direction is normalised in f64: distances are metres whatever the length of the ray's f32 direction.
/// - The normal is not normalised: its length scales `N`. The axis of a spot is normalised in f64.
/// - `mu_t` is the medium's f32 sum; `mu_s` and `mu_t` of a coloured medium are the [means](Medium::mean).
/// - `t_max` is at most [`FARTHEST`].
/// - `h` is at least 1e-18 m and at least 1e-9 of `|t_h|` and of `|t_min - t_h|`: an emitter on the ray's line is
///   treated as one beside it. `alpha h` is unchanged, and `cos phi` is `a.(x - y)` over the resulting `r`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Scene {
    pub(super) t_min: f64,
    pub(super) t_max: f64,
    pub(super) h: f64,
    pub(super) t_h: f64,
    emission: Emission,
    mu_s: f64,
    pub(super) mu_t: f64,
    pub(super) g: f64,
    pub(super) arc: Option<Arc>,
}

/// The dependence of the emitter's intensity on the direction.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Emission {
    /// Constant.
    Even,
    /// `N`
    Normal(Normal),
    /// `S`; `None` if the line of the ray misses the cone.
    Spot(Option<Cone>),
}

impl Emission {
    /// The lit part of an interval.
    fn lit(&self, h: f64, t_h: f64, interval: (f64, f64)) -> Option<Arc> {
        match *self {
            Self::Even => Arc::new(h, t_h, interval, None),
            Self::Normal(normal) => Arc::new(h, t_h, interval, Some(normal)),
            Self::Spot(cone) => Arc::in_cone(h, t_h, interval, cone?),
        }
    }
}

impl Scene {
    /// The scene that the f32 values describe.
    #[must_use]
    pub fn new(ray: &Ray, emitter: &Emitter, medium: &Medium) -> Self {
        // A direction rounded to a unit vector would lose the digits of a small h, and so would products rounded to f64.
        let d = Vector::from(ray.direction());
        let w = Vector::difference(ray.origin(), emitter.position());
        let w_cross_d = w.cross(d);
        let (t_min, t_max) = (f64::from(ray.t_min()), f64::from(ray.t_max().min(FARTHEST)));
        let t_h = -w.dot(d) / d.length();
        let scale = t_h.abs().max((t_min - t_h).abs());
        let h = (w_cross_d.length() / d.length()).max(1e-18).max(1e-9 * scale);
        let normal = |n| {
            let n = Vector::from(n);
            Normal { alpha_h: n.cross(d).dot(w_cross_d) / d.dot(d), beta: n.dot(d) / d.length(), at_0: n.dot(w) }
        };
        let emission = match (emitter.normal(), emitter.cone()) {
            (Some(n), _) => Emission::Normal(normal(n)),
            (None, Some(cone)) => Emission::Spot(Cone::new(&cone, &Line { d, w, w_cross_d, h })),
            (None, None) => Emission::Even,
        };
        Self {
            t_min,
            t_max,
            h,
            t_h,
            emission,
            mu_s: f64::from(medium.mu_s()),
            mu_t: f64::from(medium.mu_t()),
            g: f64::from(medium.g()),
            arc: emission.lit(h, t_h, (t_min, t_max)),
        }
    }

    /// The same scene with other values of `h` and `t_h` \[m\], such as the rounded ones of the kernels. The lit part, and `N r` along
    /// the ray, are unchanged.
    #[must_use]
    pub fn with_foot(&self, h: f64, t_h: f64) -> Self {
        let emission = match self.emission {
            Emission::Even => Emission::Even,
            Emission::Normal(n) => Emission::Normal(Normal { alpha_h: n.alpha_h + n.beta * (t_h - self.t_h), ..n }),
            Emission::Spot(cone) => Emission::Spot(cone.map(|cone| cone.with_foot(self.t_h - t_h))),
        };
        Self { h, t_h, emission, arc: emission.lit(h, t_h, (self.t_min, self.t_max)), ..*self }
    }

    /// The same scene with another medium.
    pub(super) fn with_medium(&self, medium: &Medium) -> Self {
        let [mu_s, mu_t, g] = [medium.mu_s(), medium.mu_t(), medium.g()].map(f64::from);
        Self { mu_s, mu_t, g, ..*self }
    }

    pub(super) fn scatters(&self) -> bool {
        self.mu_s > 0.0
    }

    #[cfg(test)]
    pub(super) fn is_spot(&self) -> bool {
        matches!(self.emission, Emission::Spot(_))
    }

    fn normal(&self) -> Option<Normal> {
        if let Emission::Normal(normal) = self.emission { Some(normal) } else { None }
    }

    /// The distance `h` from the emitter to the ray's line \[m\].
    #[must_use]
    pub fn h(&self) -> f64 {
        self.h
    }

    /// The distance `t_h` along the ray of the point nearest to the emitter \[m\], signed.
    #[must_use]
    pub fn t_h(&self) -> f64 {
        self.t_h
    }

    /// `alpha = n.w`, with the unit vector `w` from the emitter to the foot of the perpendicular; 0 without a normal.
    #[must_use]
    pub fn alpha(&self) -> f64 {
        self.normal().map_or(0.0, |n| n.alpha_h / self.h)
    }

    /// `beta = n.d`; 0 without a normal.
    #[must_use]
    pub fn beta(&self) -> f64 {
        self.normal().map_or(0.0, |n| n.beta)
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

    /// The part of [`interval`](Self::interval) where `N > 0`, or inside the outer cone of a spot \[m\], if there is one.
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

    /// `theta(t1) - theta(t0)` \[rad\] without cancellation, `t0` and `t1` in metres.
    #[must_use]
    pub fn angle(&self, t0: f64, t1: f64) -> f64 {
        subtended(self.h, t1 - t0, t0 - self.t_h, t1 - self.t_h)
    }

    /// The transmittance `T = exp(-mu_t (t - t_min + r))` from the emitter to the point at `t` \[m\] and on to `t_min`.
    #[must_use]
    pub fn transmittance(&self, t: f64) -> f64 {
        (-self.mu_t * (t - self.t_min + self.r(t))).exp()
    }

    /// The phase function `rho` at `t` \[m\], in 1/sr; also finite at `|g|` = 1, where it is 0 off its peak.
    #[must_use]
    pub fn phase(&self, t: f64) -> f64 {
        let (t_prime, r) = (t - self.t_h, self.r(t));
        let along = if self.g < 0.0 { -t_prime } else { t_prime };
        // 1 + along/r, but not as a difference of nearly equal numbers
        let one_plus_sin = if along < 0.0 { self.h * (self.h / r) / (r - along) } else { 1.0 + along / r };
        henyey_greenstein(self.g, one_plus_sin)
    }

    /// The emitter's cosine `N` at `t` \[m\]; 1 without a normal.
    #[must_use]
    pub fn cosine(&self, t: f64) -> f64 {
        self.normal().map_or(1.0, |n| (n.height(t, t - self.t_h) / self.r(t)).max(0.0))
    }

    /// The falloff `S` of a spot at `t` \[m\]; 1 for other emitters.
    #[must_use]
    pub fn falloff(&self, t: f64) -> f64 {
        match self.emission {
            Emission::Spot(cone) => cone.map_or(0.0, |cone| cone.falloff_at(self.h, (t, t - self.t_h))),
            _ => 1.0,
        }
    }

    /// The integrand `mu_s T rho N S / r^2` at `t` \[m\], in 1/m^3.
    #[must_use]
    pub fn integrand(&self, t: f64) -> f64 {
        let emitted = self.cosine(t) * self.falloff(t);
        self.mu_s * self.transmittance(t) * self.phase(t) * emitted / self.r(t).powi(2)
    }

    /// The single-scattered radiance for unit intensity \[1/m^2\]: the integral of [`integrand`](Self::integrand) over
    /// [`lit`](Self::lit), with a relative error of about 1e-12.
    #[must_use]
    pub fn radiance(&self) -> f64 {
        let Some(arc) = &self.arc else { return 0.0 };
        // T, rho and N vary fastest towards the ends of the arc, over angles of any size. In the logarithm of the odds of the
        // angle every such layer has about the same width. 1/r^2 cancels, as dt/r^2 = dtheta/h.
        let integrand = |s: f64| {
            let angle = arc.at_odds(s);
            let path = arc.t(angle) - self.t_min + self.h / arc.cos_theta(angle);
            let emitted = arc.cosine(angle) * arc.falloff(angle);
            (-self.mu_t * path).exp() * phase(self.g, arc, angle) * emitted * angle.from_a * angle.to_b
        };
        // exp(-64) of the arc at each end is left out.
        let mut ends: Vec<f64> = (0..=8).map(|i| 16.0 * f64::from(i) - 64.0).collect();
        ends.extend(arc.kinks().into_iter().map(|kink| (kink.from_a / kink.to_b).ln()).filter(|s| s.abs() < 64.0));
        ends.sort_by(f64::total_cmp);
        self.mu_s / self.h * integrate_pieces(integrand, &ends, 1e-13) / arc.width()
    }
}

/// `rho` \[1/sr\] in a direction of the arc.
pub(super) fn phase(g: f64, arc: &Arc, angle: Angle) -> f64 {
    let sign = if g < 0.0 { -1.0 } else { 1.0 };
    henyey_greenstein(g, arc.one_plus_sin_theta(sign, angle))
}

/// (1.4), (12), given `1 + sin theta` for `g >= 0` and `1 - sin theta` for `g < 0`.
fn henyey_greenstein(g: f64, one_plus_sin: f64) -> f64 {
    let g = g.abs();
    let s = (1.0 - g).powi(2) + 2.0 * g * one_plus_sin;
    (1.0 - g) * (1.0 + g) / (4.0 * PI * s * s.sqrt())
}

#[cfg(test)]
mod tests {
    use super::super::arbitrary::{config, scene};
    use super::super::paper;
    use super::*;
    use glam::{DVec3, Vec3};
    use proptest::{prop_assert, proptest};

    /// From the origin along x, the emitter at (`t_h`, `h`, 0).
    fn straight(interval: (f32, f32), (t_h, h): (f32, f32), normal: Option<Vec3>, medium: (f32, f32, f32)) -> Scene {
        let ray = Ray::new(Vec3::ZERO, Vec3::X, interval.0, interval.1).unwrap();
        let y = Vec3::new(t_h, h, 0.0);
        let emitter = normal.map_or(Emitter::point(y), |n| Emitter::point_normal(y, n)).unwrap();
        Scene::new(&ray, &emitter, &Medium::new(medium.0, medium.1, medium.2).unwrap())
    }

    fn assert_close(value: f64, expected: f64, relative: f64) {
        assert!(
            (value - expected).abs() <= relative * expected.abs(),
            "{value:e} is not {expected:e} within {relative}"
        );
    }

    /// The integral over distance, with a look at every decade around the emitter and behind both ends, and on both sides
    /// of where the falloff is not smooth.
    fn radiance_over_distance(scene: &Scene) -> f64 {
        let Some(arc) = scene.arc else { return 0.0 };
        let (t_a, t_b) = (arc.t_a, arc.t_b);
        let decades = (-18..=18).map(|k| 10f64.powi(k));
        let mut ends: Vec<f64> = decades
            .flat_map(|x| {
                [
                    t_a + x / scene.mu_t,
                    t_a + x * scene.h,
                    t_b - x * scene.h,
                    scene.t_h - x * scene.h,
                    scene.t_h + x * scene.h,
                ]
            })
            .chain(arc.kinks().into_iter().map(|kink| arc.t(kink)))
            .filter(|t| (t_a..t_b).contains(t))
            .chain([t_a, t_b])
            .collect();
        ends.sort_by(f64::total_cmp);
        integrate_pieces(|t| scene.integrand(t), &ends, 1e-12)
    }

    #[test]
    fn the_geometry_of_a_ray_by_hand() {
        let scene = straight((1.0, 11.0), (5.0, 3.0), Some(Vec3::new(0.6, -0.8, 0.0)), (0.25, 0.5, 0.0));
        assert_close(scene.t_h(), 5.0, 0.0);
        assert_close(scene.h(), 3.0, 0.0);
        assert_close(scene.alpha(), 0.8, 1e-7);
        assert_close(scene.beta(), 0.6, 1e-7);
        assert_close(scene.mu_t(), 0.75, 0.0);
        assert_close(scene.r(1.0), 5.0, 0.0);
        assert_close(scene.cosine(9.0), 0.96, 1e-7);
        assert_close(scene.transmittance(9.0), (-0.75f64 * 13.0).exp(), 1e-15);
        assert_close(scene.theta(8.0), PI / 4.0, 1e-15);
        assert_close(scene.angle(2.0, 8.0), PI / 2.0, 1e-15);
        assert_eq!(scene.lit().unwrap().1, 11.0);
        assert_close(scene.lit().unwrap().0, 1.0, 1e-6); // where the ray meets the emitter's plane
    }

    #[test]
    fn a_ray_behind_the_emitter_is_dark() {
        let scene = straight((1.0, 11.0), (5.0, 3.0), Some(Vec3::Y), (0.25, 0.5, 0.0));
        assert_eq!((scene.lit(), scene.radiance()), (None, 0.0));
    }

    #[test]
    fn a_short_normal_dims_and_a_long_direction_does_not() {
        let ray = |length: f32| Ray::new(Vec3::ZERO, Vec3::X * length, 0.0, 9.0).unwrap();
        let emitter = |length: f32| Emitter::point_normal(Vec3::new(5.0, 3.0, 0.0), Vec3::NEG_Y * length).unwrap();
        let medium = Medium::new(0.1, 0.2, 0.5).unwrap();
        let radiance = |d: f32, n: f32| Scene::new(&ray(d), &emitter(n), &medium).radiance();
        let scale = 1.0 - 1.0 / 2048.0;
        assert_close(radiance(scale, 1.0), radiance(1.0, 1.0), 1e-13);
        assert_close(radiance(1.0, scale), f64::from(scale) * radiance(1.0, 1.0), 1e-13);
    }

    #[test]
    fn a_small_h_has_all_its_digits() {
        // 1 m off a line that passes 1 km away at an angle: the direction is no unit vector in f32, yet h is exact.
        let d = Vec3::new(0.8, 0.6, 0.0);
        let y = Vec3::new(1000.0, 750.0, 1.0 / 1024.0);
        let scene = Scene::new(
            &Ray::new(Vec3::ZERO, d, 0.0, 2000.0).unwrap(),
            &Emitter::point(y).unwrap(),
            &Medium::new(0.0, 1.0, 0.0).unwrap(),
        );
        let (d, y) = (d.as_dvec3(), y.as_dvec3());
        let in_plane = (y.x * d.y - y.y * d.x) / d.length();
        assert_close(scene.h(), in_plane.hypot(y.z), 1e-15);
        assert_close(scene.t_h(), y.dot(d) / d.length(), 1e-15);
        assert!((DVec3::new(y.x, y.y, 0.0).length() - scene.t_h()).abs() < 1e-6);
    }

    #[test]
    fn an_emitter_on_the_line_is_beside_it() {
        let scene = |h| straight((1.0, 9.0), (5.0, h), Some(Vec3::NEG_X), (0.0, 1.0, 0.0));
        assert_close(scene(0.0).h(), 5e-9, 1e-15);
        assert_close(scene(1e-8).h(), f64::from(1e-8f32), 1e-15);
        assert_eq!(scene(0.0).alpha(), 0.0);
        assert_close(scene(0.0).lit().unwrap().1, 5.0, 1e-15);
        assert_close(straight((7.0, 9.0), (-2.0, 0.0), None, (0.0, 1.0, 0.0)).h(), 9e-9, 1e-15);
        assert_eq!(straight((0.0, 9.0), (0.0, 0.0), None, (0.0, 1.0, 0.0)).h(), 1e-18);
    }

    #[test]
    fn without_absorption_and_isotropic_the_radiance_is_elementary() {
        let (mu_s, up) = (1e-30, Some(Vec3::NEG_Y));
        for interval in [(0.0, 9.0), (0.0, f32::INFINITY), (4.0, 4.000001), (7.0, 1e6)] {
            for h in [1e-6f32, 1e-3, 1.0, 1e3] {
                let scene = straight(interval, (5.0, h), None, (0.0, mu_s, 0.0));
                let (t_a, t_b) = scene.interval();
                let expected = f64::from(mu_s) / (4.0 * PI * f64::from(h)) * scene.angle(t_a, t_b);
                // mu_t t is 1e-12 at the far end
                assert_close(scene.radiance(), expected, 4e-12);
                let scene = straight(interval, (5.0, h), up, (0.0, mu_s, 0.0));
                let middle = 0.5 * (scene.theta(t_a) + scene.theta(t_b));
                let expected = f64::from(mu_s) / (4.0 * PI * f64::from(h))
                    * 2.0
                    * (0.5 * scene.angle(t_a, t_b)).sin()
                    * middle.cos();
                let rounding_of_the_middle = 4e-16 / middle.cos();
                assert_close(scene.radiance(), expected, 4e-12 + rounding_of_the_middle);
            }
        }
    }

    #[test]
    fn the_extremes_are_finite() {
        let h = [0.0, 1e-30, 1e-6, 1.0, 1e6, 1e18];
        for (g, h) in [-1.0, -0.999_999, 0.0, 0.999_999, 1.0].into_iter().flat_map(|g| h.map(|h| (g, h))) {
            for normal in [None, Some(Vec3::NEG_Y), Some(Vec3::X)] {
                let scene = straight((0.0, f32::INFINITY), (5.0, h), normal, (1.0, 1.0, g));
                assert!(scene.radiance().is_finite() && scene.radiance() >= 0.0, "g = {g}, h = {h}, {normal:?}");
                let (t_a, t_b) = scene.lit().unwrap_or_default();
                for t in [t_a, 1.0, 5.0, t_b] {
                    assert!(scene.phase(t).is_finite() && scene.integrand(t).is_finite(), "g = {g}, h = {h}, t = {t}");
                }
            }
        }
    }

    #[test]
    fn layers_of_any_width_are_seen() {
        const NEAREST_1: f32 = 1.0f32.next_down();
        for (mu_t, h, g) in [
            (100.0, 1.0, 0.99),
            (1e6, 1.0, -0.99),
            (1e-3, 1e-4, 0.99),
            (1e3, 1e-3, 0.0),
            (1e4, 1e4, 0.9),
            (1.0, 1.0, NEAREST_1),
            (1e-3, 1e-3, -NEAREST_1),
        ] {
            for t_h in [-5.0, 0.0, 0.01, 5.0] {
                let scene = straight((0.0, f32::INFINITY), (t_h, h), None, (0.0, mu_t, g));
                assert_close(scene.radiance(), radiance_over_distance(&scene), 1e-10);
            }
        }
    }

    proptest! {
        #![proptest_config(config(256))]

        #[test]
        fn the_integral_over_angle_is_that_over_distance(scene in scene()) {
            let expected = radiance_over_distance(&scene);
            let error = (scene.radiance() - expected).abs();
            // the effect of the rounding of an end where the light ends abruptly
            let (t_a, t_b) = scene.lit().unwrap_or_default();
            let rounding = 2.0 * f64::EPSILON * (t_a * scene.integrand(t_a) + t_b * scene.integrand(t_b));
            // of subnormal numbers no digits are promised
            prop_assert!(error <= 1e-11 * expected + rounding + 1e-290, "{error:e} of {expected:e}");
        }

        #[test]
        fn the_symbols_agree_with_the_paper(scene in scene()) {
            for t in [scene.t_min, scene.t_h, scene.t_min + 3.0 * scene.h] {
                let theta = scene.theta(t);
                let path = (t - scene.t_min).abs() + scene.r(t);
                let transmittance = paper::transmittance(scene.mu_t, scene.h, scene.t_h - scene.t_min, theta);
                let rounding = 1e-12 * (1.0 + scene.mu_t * path) / theta.cos();
                prop_assert!((scene.transmittance(t) - transmittance).abs() <= rounding * transmittance);
                let rho = paper::phase(scene.g, theta);
                prop_assert!((scene.phase(t) - rho).abs() <= 1e-11 * rho);
                let n = (scene.alpha() * theta.cos() + scene.beta() * theta.sin()).max(0.0);
                prop_assert!(scene.normal().is_none() || (scene.cosine(t) - n).abs() <= 1e-13);
            }
        }
    }
}
