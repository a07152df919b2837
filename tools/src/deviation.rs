//! How far single samples stray: the variance of a ray's weight, by quadrature.
//!
//! A weight with a heavy tail, such as that of distances drawn regardless of `1/r^2`, hides its variance from its own
//! samples until the tail is hit. Here nothing is left to chance.

use airlight::Strategy;
use airlight::oracle::Scene;
use airlight::oracle::quadrature::gauss_legendre;

/// The variance of `w = f/p`, of mean `radiance`, where `p` is the density of `strategy`; to about a percent.
pub(crate) fn variance(scene: &Scene, strategy: Strategy, radiance: f64) -> f64 {
    let Some((start, end)) = scene.lit() else { return 0.0 };
    // (w - L)^2 p dt over the equi-angular variate, which takes 1/r^2 away, and over the logarithm of its odds, which
    // resolves layers at the ends of any thickness: dt = dv / p_e, dv = v (1 - v) ds.
    // Two quotients, for a product of densities may vanish where neither does.
    let lit = |s: f64| {
        let odds = s.exp();
        let v = odds / (1.0 + odds);
        let t = scene.invert(Strategy::EquiAngular, v);
        let (p, uniform) = (scene.pdf(strategy, t), scene.pdf(Strategy::EquiAngular, t));
        let deviation = scene.integrand(t) - radiance * p;
        if p > 0.0 && uniform > 0.0 { deviation / p * (deviation / uniform) * v / (1.0 + odds) } else { 0.0 }
    };
    let pieces = (-4..4).map(|i| 4.0 * f64::from(i));
    let lit_part: f64 = pieces.map(|s| gauss_legendre(lit, s, s + 4.0)).sum();
    // Where nothing is lit the weight is 0.
    let unlit = 1.0 - (scene.cdf(strategy, end) - scene.cdf(strategy, start));
    lit_part + unlit * radiance * radiance
}

#[cfg(test)]
mod tests {
    use super::*;
    use airlight::{Emitter, Medium, Ray};
    use glam::Vec3;

    #[test]
    fn it_is_the_variance_of_many_samples() {
        const SAMPLES: u32 = 20_000;
        let ray = Ray::new(Vec3::ZERO, Vec3::X, 0.25, 4.0).unwrap();
        let position = Vec3::new(1.5, 0.3, 0.0);
        let facing = Vec3::new(0.6, -0.8, 0.0);
        let medium = Medium::new(0.1, 0.6, 0.5).unwrap();
        for emitter in [Emitter::point(position).unwrap(), Emitter::point_normal(position, facing).unwrap()] {
            let scene = Scene::new(&ray, &emitter, &medium);
            let radiance = scene.radiance();
            for &strategy in Strategy::ALL {
                let deviation = |i| {
                    let t = scene.invert(strategy, (f64::from(i) + 0.5) / f64::from(SAMPLES));
                    scene.integrand(t) / scene.pdf(strategy, t) - radiance
                };
                let expected = (0..SAMPLES).map(|i| deviation(i).powi(2)).sum::<f64>() / f64::from(SAMPLES);
                let variance = variance(&scene, strategy, radiance);
                assert!((variance / expected - 1.0).abs() < 1e-2, "{strategy}: {variance} is not {expected}");
            }
        }
    }
}
