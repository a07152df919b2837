//! Over all 2^24 variates the mean weight is the radiance, and no weight is a firefly: light behind, beside and before
//! the origin, infinite rays and spots included.

use airlight::oracle::Scene;
use airlight::{Emitter, Emitters, Media, Medium, Ray, Rays, Samples, Strategy};
use airlight_tools::samplers;
use glam::Vec3;

/// The multiples of 2^-24 below 1.
const VARIATES: usize = 1 << 24;
const BATCH: usize = 1 << 20;

/// Rays along z; the emitter at `h` beside and `t_h` along them.
fn scenes() -> Vec<(Ray, Emitter, Medium)> {
    let lit = |t_h, h, t_max, normal: Option<Vec3>, g| {
        let position = Vec3::new(0.0, h, t_h);
        let emitter = normal.map_or(Emitter::point(position), |n| Emitter::point_normal(position, n)).unwrap();
        (Ray::new(Vec3::ZERO, Vec3::Z, 0.0, t_max).unwrap(), emitter, Medium::new(0.1, 0.4, g).unwrap())
    };
    let down = Some(Vec3::new(0.0, -0.8, 0.6));
    let spot = |t_h, h, t_max, inner, g| {
        let (position, axis) = (Vec3::new(0.0, h, t_h), Vec3::new(0.48, -0.8, 0.36));
        let emitter = Emitter::spot(position, axis, 0.5, inner).unwrap();
        (Ray::new(Vec3::ZERO, Vec3::Z, 0.0, t_max).unwrap(), emitter, Medium::new(0.1, 0.4, g).unwrap())
    };
    vec![
        lit(-2.0, 0.5, f32::INFINITY, down, 0.6),
        lit(0.0, 0.7, 6.0, None, -0.3),
        lit(3.0, 0.25, f32::INFINITY, None, 0.6),
        lit(4.0, 0.01, 6.0, down, -0.3),
        spot(2.0, 0.5, 6.0, 0.5, 0.6),
        spot(1.0, 0.8, f32::INFINITY, 0.7, 0.6),
    ]
}

/// The largest `f/p` of the oracle on a fine grid of quantiles.
fn supremum(scene: &Scene, strategy: Strategy) -> f64 {
    let quantiles = (0..=4096).map(|i| (f64::from(i) / 4096.0).clamp(1e-7, 1.0 - 1e-7));
    quantiles
        .map(|u| {
            let t = scene.draw(strategy, u);
            scene.integrand(t) / scene.pdf(strategy, t)
        })
        .fold(0.0, f64::max)
}

#[test]
fn the_mean_over_all_variates_is_the_radiance() {
    for (ray, emitter, medium) in scenes() {
        let scene = Scene::new(&ray, &emitter, &medium);
        let column = |value: f32| vec![value; BATCH];
        let [zero, one] = [0.0, 1.0].map(column);
        let (t_min, t_max) = (column(ray.t_min()), column(ray.t_max()));
        let rays = Rays::new([&zero; 3], [&zero, &zero, &one], &t_min, &t_max);
        for sampler in samplers::all() {
            let (strategy, precision) = (sampler.strategy(), sampler.precision());
            let [mut t, mut pdf, mut weight, mut u] = [(); 4].map(|()| column(0.0));
            let (mut sum, mut largest) = (0.0, 0.0f64);
            for first in (0..VARIATES).step_by(BATCH) {
                for (i, u) in u.iter_mut().enumerate() {
                    *u = (first + i) as f32 / VARIATES as f32;
                }
                let mut samples = Samples::new(&mut t, &mut pdf).weight(&mut weight);
                let (emitters, media) = (Emitters::one(emitter), Media::one(medium));
                sampler.sample(&rays, &emitters, &media, &u, &mut samples).unwrap();
                sum += weight.iter().map(|&w| f64::from(w)).sum::<f64>();
                largest = weight.iter().fold(largest, |largest, &w| largest.max(w.into()));
            }
            let (mean, radiance) = (sum / VARIATES as f64, scene.radiance());
            let error = (mean / radiance - 1.0).abs();
            let bound = supremum(&scene, strategy);
            println!(
                "{strategy}, {precision}: h {} t_h {} error {error:.1e}, largest {:.3}",
                scene.h(),
                scene.t_h(),
                largest / bound
            );
            assert!(
                error < 1e-4,
                "{strategy}, {precision}: {mean:e} is not {radiance:e}, {ray:?} {emitter:?} {medium:?}"
            );
            assert!(
                largest <= 2.0 * bound,
                "{strategy}, {precision}: weight {largest:e} over {bound:e}, {ray:?} {emitter:?}"
            );
        }
    }
}
