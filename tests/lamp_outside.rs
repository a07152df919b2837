//! A lamp outside the fog: weights take its leg to lie in the medium as a whole, and the factor that the documentation of
//! `Samples::weight` states corrects them.

use airlight::oracle::quadrature::integrate;
use airlight::{Emitter, Emitters, Media, Medium, Rays, Sampler, Samples, Strategy};
use glam::{DVec3, Vec3};
use std::f64::consts::PI;

/// The fog is the cube of this half side around the origin \[m\].
const HALF_SIDE: f64 = 2.0;
const MU_A: f32 = 0.25;
const MU_S: f32 = 0.5;
const G: f32 = 0.625;
/// The variates are the middles of so many strata.
const SAMPLES: usize = 1 << 16;

/// How far one may go from `x`, in the fog, along a unit vector until the fog ends \[m\].
fn way_out(x: DVec3, along: DVec3) -> f64 {
    (0..3).map(|k| (HALF_SIDE.copysign(along[k]) - x[k]) / along[k]).fold(f64::INFINITY, f64::min)
}

/// How much of the leg from `x`, in the fog, to the lamp lies outside \[m\].
fn outside(x: DVec3, lamp: DVec3) -> f64 {
    let r = (lamp - x).length();
    (r - way_out(x, (lamp - x) / r)).max(0.0)
}

/// A ray that crosses the fog.
struct Crossing {
    origin: Vec3,
    direction: Vec3,
    t_min: f32,
    t_max: f32,
}

impl Crossing {
    fn new() -> Self {
        let (origin, direction) = (Vec3::new(-5.0, 0.375, 0.25), Vec3::new(0.96, 0.0, -0.28));
        let entry = (-2.0 - origin.x) / direction.x;
        let length = way_out(origin.as_dvec3() + direction.as_dvec3() * f64::from(entry), direction.as_dvec3());
        Self { origin, direction, t_min: entry, t_max: entry + length as f32 }
    }

    fn at(&self, t: f64) -> DVec3 {
        self.origin.as_dvec3() + self.direction.as_dvec3().normalize() * t
    }

    /// `mu_s T rho N / r^2` with the transmittance of what lies in the fog alone.
    fn integrand(&self, t: f64, lamp: DVec3, normal: Option<DVec3>) -> f64 {
        let x = self.at(t);
        let (r, to_lamp) = ((lamp - x).length(), (lamp - x).normalize());
        let mu_t = f64::from(MU_A + MU_S);
        let transmittance = (-mu_t * (t - f64::from(self.t_min) + r - outside(x, lamp))).exp();
        // The light goes from the lamp to x, and on to the origin of the ray.
        let cosine = to_lamp.dot(self.direction.as_dvec3().normalize());
        let g = f64::from(G);
        let phase = (1.0 - g * g) / (4.0 * PI * (1.0 + g * g - 2.0 * g * cosine).powf(1.5));
        let of_lamp = normal.map_or(1.0, |n| (-to_lamp).dot(n).max(0.0));
        f64::from(MU_S) * transmittance * phase * of_lamp / (r * r)
    }

    /// The mean of the weights, each times the factor.
    fn mean(&self, strategy: Strategy, lamp: Vec3, normal: Option<Vec3>) -> f64 {
        let column = |value: f32| [value];
        let (origin, direction) = (self.origin.to_array().map(column), self.direction.to_array().map(column));
        let (t_min, t_max) = ([self.t_min], [self.t_max]);
        let rays = Rays::new(origin.each_ref().map(|c| &c[..]), direction.each_ref().map(|c| &c[..]), &t_min, &t_max);
        let emitter = normal.map_or(Emitter::point(lamp), |n| Emitter::point_normal(lamp, n)).unwrap();
        let medium = Medium::new(MU_A, MU_S, G).unwrap();
        let u: Vec<f32> = (0..SAMPLES).map(|i| (i as f32 + 0.5) / SAMPLES as f32).collect();
        let [mut t, mut pdf, mut weight] = [(); 3].map(|()| vec![f32::NAN; SAMPLES]);
        let mut samples = Samples::new(&mut t, &mut pdf).weight(&mut weight);
        let (emitters, media) = (Emitters::one(emitter), Media::one(medium));
        Sampler::new(strategy).sample(&rays, &emitters, &media, &u, &mut samples).unwrap();
        let corrected = t.iter().zip(&weight).map(|(&t, &weight)| {
            let outside = outside(self.at(t.into()), lamp.as_dvec3());
            f64::from(weight) * (f64::from(medium.mu_t()) * outside).exp()
        });
        corrected.sum::<f64>() / SAMPLES as f64
    }
}

#[test]
fn the_corrected_weights_have_the_radiance_for_their_mean() {
    let ray = Crossing::new();
    // Above the fog, beside it, and in it, where there is nothing to correct.
    for lamp in [Vec3::new(0.5, 4.0, 0.75), Vec3::new(3.5, 1.0, -1.0), Vec3::new(0.5, 1.5, 0.75)] {
        for normal in [None, Some(Vec3::NEG_Y), Some(Vec3::new(-0.8, -0.6, 0.0))] {
            let of_lamp = |t| ray.integrand(t, lamp.as_dvec3(), normal.map(Vec3::as_dvec3));
            let expected = integrate(of_lamp, ray.t_min.into(), ray.t_max.into(), 1e-10);
            for &strategy in Strategy::ALL {
                let mean = ray.mean(strategy, lamp, normal);
                let error = (mean / expected - 1.0).abs();
                assert!(error <= 1e-5, "{strategy}, lamp {lamp}, {normal:?}: {mean:e} is not {expected:e}");
            }
        }
    }
}
