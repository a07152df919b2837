//! Spots in the oracle, against what a spot is: the part of a ray inside the cone, the falloff, the integral, the variances.
//! And in the kernels, against both.

mod scenes;

use airlight::oracle::Scene;
use airlight::{Emitter, Emitters, FARTHEST, Integral, Medium, Nodes, Ray, Sampler, Strategy};
use airlight_tools::backends::distinct;
use airlight_tools::samplers;
use glam::{DVec3, Vec3};
use scenes::{Case, Columns, Drawn, Random};

const SEED: u64 = 15;

fn vector(v: [f32; 3]) -> DVec3 {
    Vec3::from(v).as_dvec3()
}

/// A ray and a spot.
#[derive(Clone, Copy, Debug)]
struct Spot {
    ray: Ray,
    emitter: Emitter,
}

/// The cosine of an angle in degrees.
fn cos_degrees(angle: f32) -> f32 {
    f64::from(angle).to_radians().cos() as f32
}

impl Spot {
    fn new(ray: Ray, position: Vec3, axis: Vec3, cos_outer: f32, cos_inner: f32) -> Self {
        Self { ray, emitter: Emitter::spot(position, axis, cos_outer, cos_inner).unwrap() }
    }

    /// A ray through a box of side 10 around a spot.
    fn generic(random: &mut Random, axis: Vec3, cos_outer: f32, cos_inner: f32) -> Self {
        let length = random.between(1.0, 20.0);
        let ray = Ray::new(random.point(), random.unit(), 0.0, length).unwrap();
        Self::new(ray, Vec3::ZERO, axis, cos_outer, cos_inner)
    }

    /// Any of the axes, cones and rays that there are in a box of side 10.
    fn any(random: &mut Random) -> Self {
        let angle = 90.0 * random.uniform().powi(3);
        let outer = [cos_degrees(angle), cos_degrees(0.1), 0.0, random.uniform()][random.below(4)];
        let inner = [outer, outer + (1.0 - outer) * random.uniform(), 1.0][random.below(3)];
        let toward = random.unit();
        let position = random.point();
        let t_min = [0.0, 3.0 * random.uniform()][random.below(2)];
        let t_max = [t_min + 20.0 * random.uniform(), f32::INFINITY][random.below(2)];
        let ray = Ray::new(random.point(), toward, t_min, t_max).unwrap();
        // any axis, and one that meets the ray or nearly so
        let aimed = (Vec3::from(ray.origin()) + Vec3::from(ray.direction()) * random.between(-5.0, 15.0) - position)
            .normalize();
        let axis = [random.unit(), aimed, (aimed + 0.01 * random.unit()).normalize()][random.below(3)];
        Self::new(ray, position, axis, outer, inner)
    }

    /// A point at the same place that shines alike in all directions.
    fn without_cone(&self) -> Emitter {
        Emitter::point(self.emitter.position()).unwrap()
    }

    fn scene(&self, medium: &Medium) -> Scene {
        Scene::new(&self.ray, &self.emitter, medium)
    }

    fn air(&self) -> Scene {
        self.scene(&Medium::new(0.0, 1.0, 0.0).unwrap())
    }

    /// The distance of the emitter from the ray's line.
    fn h(&self) -> f64 {
        let [o, d, y] = [self.ray.origin(), self.ray.direction(), self.emitter.position()].map(vector);
        (y - o).cross(d.normalize()).length()
    }

    /// What the definition says at `t`: the cosine of the angle to the axis, and how far rounding may have moved it.
    fn cosine(&self, t: f64) -> (f64, f64) {
        let cone = self.emitter.cone().unwrap();
        let [o, d, y, a] = [self.ray.origin(), self.ray.direction(), self.emitter.position(), cone.axis()].map(vector);
        let (d, a) = (d.normalize(), a.normalize());
        let from_y = (o - y) + t * d;
        let r = from_y.length();
        let reach = (o - y).abs().max_element() + t;
        (a.dot(from_y) / r, 1e-15 + 1e-15 * reach / r)
    }

    /// What the definition of the falloff says of a cosine.
    fn falloff(&self, cosine: f64) -> f64 {
        let cone = self.emitter.cone().unwrap();
        let (outer, inner) = (f64::from(cone.cos_outer()), f64::from(cone.cos_inner()));
        let s = if cosine < outer {
            0.0
        } else if cosine >= inner {
            1.0
        } else {
            (cosine - outer) / (inner - outer)
        };
        s * s * (3.0 - 2.0 * s)
    }
}

/// Distances all over the ray, and close to where the oracle says that the light begins and ends.
fn distances(spot: &Spot, scene: &Scene, random: &mut Random) -> Vec<f64> {
    let (t_min, t_max) = (f64::from(spot.ray.t_min()), f64::from(spot.ray.t_max().min(FARTHEST)));
    let even = (0..=64).map(|i| t_min + (t_max - t_min) * f64::from(i) / 64.0);
    let by_decade = (-20..=20).flat_map(|k| {
        let x = 10f64.powi(k) * (1.0 + f64::from(random.uniform()));
        [
            t_min + x,
            t_max - x,
            scene.t_h() + x,
            scene.t_h() - x,
            scene.t_h() + x * scene.h(),
            scene.t_h() - x * scene.h(),
        ]
    });
    let ends = scene.lit().into_iter().flat_map(|(t_a, t_b)| {
        (-14..=0).flat_map(move |k| {
            let x = 10f64.powi(k);
            [t_a, t_b]
                .into_iter()
                .flat_map(move |t| [t * (1.0 + x), t * (1.0 - x), t + x * (t_b - t_a), t - x * (t_b - t_a)])
        })
    });
    even.chain(by_decade.collect::<Vec<_>>()).chain(ends).filter(|t| (t_min..=t_max).contains(t)).collect()
}

/// Asserts that what is lit, and how, is what the definition says; returns how many points were inside, and outside.
fn assert_clipped(spot: &Spot, random: &mut Random) -> [usize; 2] {
    let scene = spot.air();
    let cone = spot.emitter.cone().unwrap();
    let (outer, fall) = (f64::from(cone.cos_outer()), f64::from(cone.cos_inner() - cone.cos_outer()));
    // The oracle keeps a little off an emitter on the ray.
    let off_line = if scene.h() > 1.0001 * spot.h() { 1.0 } else { 0.0 };
    let mut points = [0; 2];
    for t in distances(spot, &scene, random) {
        let (cosine, rounding) = spot.cosine(t);
        let rounding = rounding + off_line * (scene.h() / (t - scene.t_h())).powi(2);
        let inside = scene.lit().is_some_and(|(t_a, t_b)| (t_a..=t_b).contains(&t));
        let clear = (cosine - outer).abs() > 4.0 * rounding;
        if !clear || rounding.is_nan() {
            continue;
        }
        assert_eq!(cosine > outer, inside, "{spot:?} at {t:e}, cosine {cosine}, {:?}", scene.lit());
        points[usize::from(!inside)] += 1;
        let slack = if fall == 0.0 { 1e-15 } else { 1e-14 + 6.0 * rounding / fall };
        let error = (scene.falloff(t) - spot.falloff(cosine)).abs();
        assert!(error <= slack, "{spot:?} at {t:e}: {} is not {}", scene.falloff(t), spot.falloff(cosine));
    }
    points
}

#[test]
fn the_lit_part_is_inside_the_cone_and_nothing_else() {
    println!("seed {SEED}");
    let mut random = Random::new(SEED);
    let mut points = [0; 2];
    for _ in 0..20_000 {
        let found = assert_clipped(&Spot::any(&mut random), &mut random);
        points = [0, 1].map(|k| points[k] + found[k]);
    }
    println!("{points:?} points inside and outside");
    assert!(points.iter().all(|&n| n > 500_000), "{points:?}");
}

#[test]
fn special_rays_are_clipped_too() {
    println!("seed {SEED}");
    let mut random = Random::new(SEED);
    let cosines = [0.0, 1.0, 1f32.next_down(), cos_degrees(0.1), cos_degrees(45.0), 0.8, 0.6, f32::MIN_POSITIVE];
    let directions = [Vec3::X, Vec3::NEG_X, Vec3::Y, Vec3::NEG_Y, Vec3::new(0.6, 0.8, 0.0), Vec3::new(-0.8, 0.6, 0.0)];
    let positions = [
        Vec3::ZERO,
        5.0 * Vec3::X,
        Vec3::new(5.0, 1e-6, 0.0),
        Vec3::new(5.0, 1e-3, 1e-3),
        Vec3::new(5.0, 3.0, 0.0),
        Vec3::new(5.0, 0.0, -3.0),
        -2.0 * Vec3::X,
        Vec3::new(1e9, 1.0, 0.0),
    ];
    for (outer, position) in cosines.into_iter().flat_map(|c| positions.map(|position| (c, position))) {
        // along the side of the cone, within rounding; along the axis and across it
        let along_side = [-1.0, 1.0].map(|side| Vec3::new(outer, side * (1.0 - outer * outer).max(0.0).sqrt(), 0.0));
        for axis in directions.into_iter().chain(along_side) {
            for (t_min, t_max) in [(0.0, f32::INFINITY), (0.0, 9.0), (4.999, 5.001)] {
                let ray = Ray::new(Vec3::ZERO, Vec3::X, t_min, t_max).unwrap();
                for inner in [outer, 1.0] {
                    assert_clipped(&Spot::new(ray, position, axis, outer, inner), &mut random);
                }
            }
        }
    }
}

#[test]
fn whatever_the_bits_the_lit_part_is_inside_the_cone() {
    println!("seed {SEED}");
    let mut random = Random::new(SEED);
    let mut lit = 0;
    for _ in 0..100_000 {
        let mut any = || f32::from_bits(random.bits() as u32);
        let (origin, position) = (Vec3::new(any(), any(), any()), Vec3::new(any(), any(), any()));
        let (t_min, t_max, outer, inner) = (any().abs(), any().abs(), any().abs(), any().abs());
        let (outer, inner) = (outer.min(1.0), inner.min(1.0));
        let (t_min, t_max) = (t_min.min(t_max), t_max.max(t_min));
        let Ok(ray) = Ray::new(origin, random.unit(), t_min, t_max) else { continue };
        if t_min == t_max {
            continue;
        }
        let Ok(emitter) = Emitter::spot(position, random.unit(), outer.min(inner), outer.max(inner)) else { continue };
        let spot = Spot { ray, emitter };
        assert_clipped(&spot, &mut random);
        let radiance = spot.air().radiance();
        assert!(radiance.is_finite() && radiance >= 0.0, "{spot:?}: {radiance}");
        lit += usize::from(spot.air().lit().is_some());
    }
    assert!(lit > 1000, "{lit}");
}

#[test]
fn without_a_cosine_the_cone_is_the_half_space() {
    println!("seed {SEED}");
    let mut random = Random::new(SEED);
    for _ in 0..2000 {
        let axis = random.unit();
        let spot = Spot::generic(&mut random, axis, 0.0, 0.0);
        let normal = Emitter::point_normal(Vec3::ZERO, axis).unwrap();
        let expected = Spot { emitter: normal, ..spot }.air().lit();
        match (spot.air().lit(), expected) {
            (None, None) => {}
            (Some((t_a, t_b)), Some((a, b))) => {
                assert!((t_a - a).abs() <= 1e-14 * a && (t_b - b).abs() <= 1e-14 * b, "{spot:?}");
            }
            other => panic!("{spot:?}: {other:?}"),
        }
    }
}

/// With `alpha`, `beta` and `gamma` the axis' parts across the ray towards it, along it, and along `u x d`:
/// `t' = h (beta c -+ alpha s)/(alpha c +- beta s)`, `s^2 = 1 - c^2 - gamma^2`; an end is where the denominator is positive.
#[test]
fn the_closed_form_of_the_ends_is_the_interval() {
    println!("seed {SEED}");
    let mut random = Random::new(SEED);
    let mut lit = 0;
    for _ in 0..100_000 {
        let (axis, outer) = (random.unit(), random.uniform());
        let spot = Spot::generic(&mut random, axis, outer, outer);
        let [o, d, a] = [spot.ray.origin(), spot.ray.direction(), axis.to_array()].map(vector);
        let (d, a, c) = (d.normalize(), a.normalize(), f64::from(outer));
        let t_h = -o.dot(d);
        let foot: DVec3 = o + t_h * d;
        let (h, u) = (foot.length(), foot.normalize());
        let [alpha, beta, gamma] = [u, d, u.cross(d)].map(|of| a.dot(of));
        let squared = 1.0 - c * c - gamma * gamma;
        if squared.abs() < 1e-6 || h < 1e-3 {
            continue;
        }
        let s = squared.max(0.0).sqrt();
        let (below, above) = (alpha * c + beta * s, alpha * c - beta * s);
        let (mut t_a, mut t_b) = (0.0, f64::from(spot.ray.t_max()));
        if below > 0.0 {
            t_a = f64::max(t_a, t_h + h * (beta * c - alpha * s) / below);
        }
        if above > 0.0 {
            t_b = f64::min(t_b, t_h + h * (beta * c + alpha * s) / above);
        }
        let dark = squared <= 0.0 || (below <= 0.0 && above <= 0.0) || t_a >= t_b;
        match spot.air().lit() {
            None => assert!(dark, "{spot:?}: {t_a} to {t_b}"),
            Some(ends) => {
                assert!(!dark, "{spot:?}: {ends:?}");
                let error = (ends.0 - t_a).abs().max((ends.1 - t_b).abs());
                assert!(error <= 1e-9, "{spot:?}: {ends:?}, {t_a} to {t_b}");
                lit += 1;
            }
        }
    }
    assert!(lit > 20_000, "{lit}");
}

/// One hundred scenes, by uniform distances and the definition alone.
#[test]
fn the_radiance_of_smooth_spots_is_the_mean_of_samples() {
    const SAMPLES: usize = 1 << 16;
    println!("seed {SEED}");
    let mut random = Random::new(SEED);
    let (mut worst, mut sum, mut scenes) = (0.0f64, 0.0, 0);
    while scenes < 100 {
        let axis = random.unit();
        let outer = cos_degrees(random.between(5.0, 90.0));
        let inner = outer + (1.0 - outer) * random.uniform();
        let spot = Spot::generic(&mut random, axis, outer, inner);
        let (mu_a, mu_s, g) = (random.between(0.0, 0.5), random.between(0.1, 0.5), random.between(-0.7, 0.7));
        let scene = spot.scene(&Medium::new(mu_a, mu_s, g).unwrap());
        if scene.h() < 0.2 || scene.lit().is_none_or(|(t_a, t_b)| t_b - t_a < 0.1) {
            continue;
        }
        let [o, d, a] = [spot.ray.origin(), spot.ray.direction(), axis.to_array()].map(vector);
        let [length, mu_a, mu_s, g] = [spot.ray.t_max(), mu_a, mu_s, g].map(f64::from);
        let (mut mean, mut square) = (0.0, 0.0);
        for _ in 0..SAMPLES {
            let t = length * (random.bits() >> 11) as f64 / (1u64 << 53) as f64;
            let x = o + t * d.normalize();
            let r = x.length();
            let phi = x.dot(a.normalize()) / r;
            let s = ((phi - f64::from(outer)) / f64::from(inner - outer)).clamp(0.0, 1.0);
            // g > 0 scatters forward: from the emitter at the origin over x back along the ray
            let cosine = -x.dot(d.normalize()) / r;
            let rho = (1.0 - g * g) / (4.0 * std::f64::consts::PI * (1.0 + g * g - 2.0 * g * cosine).powf(1.5));
            let f = length * mu_s * (-(mu_a + mu_s) * (t + r)).exp() * rho * s * s * (3.0 - 2.0 * s) / (r * r);
            mean += f / SAMPLES as f64;
            square += f * f / SAMPLES as f64;
        }
        let z = (mean - scene.radiance()) / ((square - mean * mean) / SAMPLES as f64).sqrt();
        assert!(z.abs() < 4.0, "{spot:?}: {mean:e} is not {:e}, {z} standard errors", scene.radiance());
        (worst, sum, scenes) = (worst.max(z.abs()), sum + z * z, scenes + 1);
    }
    let rms = (sum / 100.0).sqrt();
    println!("largest {worst}, root mean square {rms} standard errors");
    assert!((0.75..1.25).contains(&rms), "{rms}");
}

/// The mean relative variances of product-5, product-9 and equi-angular in lit rays of the generic box, half of them with `g`
/// 0.9, for cones that are drawn.
fn mean_variances(cosines: impl Fn(&mut Random) -> [f32; 2]) -> [f64; 3] {
    const SCENES: usize = 400;
    let mut random = Random::new(SEED);
    let (mut sums, mut scenes) = ([0.0; 3], 0);
    while scenes < SCENES {
        let ([outer, inner], axis) = (cosines(&mut random), random.unit());
        let medium = Medium::new(0.5, 0.2, [0.0, 0.9][random.below(2)]).unwrap();
        let scene = Spot::generic(&mut random, axis, outer, inner).scene(&medium);
        if scene.lit().is_none() {
            continue;
        }
        let strategies = [Strategy::Product5, Strategy::Product9, Strategy::EquiAngular];
        let variances = strategies.map(|strategy| scene.relative_variance(strategy).unwrap());
        sums = [0, 1, 2].map(|k| sums[k] + variances[k]);
        scenes += 1;
    }
    sums.map(|sum| sum / SCENES as f64)
}

/// Figures that were measured before, on other rays of such a box.
#[test]
fn product_densities_leave_the_variance_that_is_expected() {
    println!("seed {SEED}; mean V of product-5, product-9, equi-angular");
    let expected = [
        (45.0, [0.014, 0.0012, 1.1]),
        (30.0, [0.015, 0.0016, 0.93]),
        (15.0, [0.015, 0.0023, 0.67]),
        (5.0, [0.018, 0.0041, 0.42]),
    ];
    for (half_angle, expected) in expected {
        let outer = cos_degrees(half_angle);
        let means = mean_variances(|_| [outer, 0.5 + 0.5 * outer]);
        println!("{half_angle} degrees: {means:.4?}, expected {expected:?}");
        for (mean, expected) in means.into_iter().zip(expected) {
            assert!((mean - expected).abs() <= 0.3 * expected, "{half_angle} degrees: {mean} is not {expected}");
        }
    }
}

#[test]
fn product_densities_follow_any_falloff() {
    println!("seed {SEED}; mean V of product-5, product-9, equi-angular");
    let means = mean_variances(|random| {
        let outer = cos_degrees(random.between(2.0, 60.0));
        let between = outer + (1.0 - outer) * random.uniform();
        [outer, [outer, between, between, 1.0][random.below(4)]]
    });
    println!("half-angles from 2 to 60 degrees, edges from hard to soft: {means:.4?}");
    assert!(means[0] <= 0.02 && means[1] <= 0.005, "{means:?}");
}

/// Media of the kernels' tests.
fn fog(random: &mut Random) -> Medium {
    Medium::new(random.between(0.0, 0.5), random.between(0.1, 0.5), random.between(-0.7, 0.7)).unwrap()
}

/// But for the rounding of `t`. The density of the transmittance knows no cone: what it draws outside has no weight.
#[test]
fn no_sample_is_outside_the_cone() {
    println!("seed {SEED}");
    let mut random = Random::new(SEED);
    let (mut inside, mut outside) = (0, 0);
    for _ in 0..5000 {
        let (spot, medium) = (Spot::any(&mut random), fog(&mut random));
        let (scene, (t_min, t_max)) = (spot.scene(&medium), (spot.ray.t_min(), spot.ray.t_max()));
        let least = 2f32.powi(-24);
        let variates = [0.0, least, random.uniform(), random.uniform(), 1.0 - least, 1.0];
        let kernels = distinct().flat_map(|backend| samplers::all().map(move |sampler| sampler.with_backend(backend)));
        for (sampler, u) in kernels.flat_map(|sampler| variates.map(|u| (sampler, u))) {
            let sample = sampler.sample_one(&spot.ray, &spot.emitter, &medium, u);
            let Some(sample) = sample else {
                let short = scene.lit().is_none_or(|(t_a, t_b)| t_b - t_a < 1e-6 * t_a);
                assert!(short, "{sampler:?} at {u} has no sample of {spot:?}: {:?}", scene.lit());
                continue;
            };
            let seen = || format!("{sampler:?} at {u}: {sample:?} of {spot:?}, {:?}", scene.lit());
            let (low, high): (f64, f64) = (sample.t.next_down().into(), sample.t.next_up().into());
            let within = scene.lit().is_some_and(|(t_a, t_b)| t_a <= high && low <= t_b);
            assert!((t_min..=t_max).contains(&sample.t) && sample.weight.is_finite(), "{}", seen());
            if sampler.strategy() == Strategy::Transmittance {
                assert!(within || sample.weight == 0.0, "{}", seen());
                outside += usize::from(!within);
            } else {
                assert!(within, "{}", seen());
                inside += 1;
            }
        }
    }
    println!("{inside} samples inside, {outside} of the transmittance outside");
    assert!(inside > 100_000 && outside > 1000);
}

/// Weights, integrands and integrals are those of a point times the falloff, which is 0 or 1 if the edge is hard.
#[test]
fn kernels_have_the_falloff() {
    println!("seed {SEED}");
    let mut random = Random::new(SEED);
    let (mut hard, mut soft, mut dark) = (0, 0, 0);
    let mut scenes = 0;
    while scenes < 1000 {
        let (outer, axis) = (cos_degrees(random.between(5.0, 90.0)), random.unit());
        let inner = [outer, outer + (1.0 - outer) * random.uniform()][random.below(2)];
        let (spot, medium) = (Spot::generic(&mut random, axis, outer, inner), fog(&mut random));
        let scene = spot.scene(&medium);
        if scene.h() < 0.1 || scene.lit().is_none_or(|(t_a, t_b)| scene.angle(t_a, t_b) < 0.1) {
            continue;
        }
        scenes += 1;
        let (ray, emitter, point) = (&spot.ray, &spot.emitter, &spot.without_cone());
        let integral = Integral::new(Nodes::Twelve).radiance_one(ray, emitter, &medium);
        let error = (f64::from(integral) / scene.radiance() - 1.0).abs();
        assert!(error < 5e-2, "{spot:?}: {integral:e} is not {:e}", scene.radiance());
        for sampler in samplers::all() {
            let evaluate = |emitter, t: f32| f64::from(sampler.evaluate_one(ray, emitter, &medium, t));
            for _ in 0..20 {
                let t = random.uniform() * ray.t_max();
                let (cosine, rounding) = spot.cosine(t.into());
                let beyond = (cosine - f64::from(outer)).abs();
                if beyond < 1e-6 {
                    continue;
                }
                let (found, falloff) = (evaluate(emitter, t), spot.falloff(cosine));
                let expected = falloff * evaluate(point, t);
                let error = (found - expected).abs();
                let allowed = 2e-5 + 4.0 * rounding / beyond;
                assert!(error <= allowed * expected, "{sampler:?} at {t}: {found:e} is not {expected:e}, {spot:?}");
                *[&mut dark, &mut soft, &mut hard][if falloff == 0.0 { 0 } else { usize::from(falloff == 1.0) + 1 }] +=
                    1;

                let u = random.uniform();
                let sample = sampler.sample_one(ray, emitter, &medium, u).unwrap();
                let t = [sample.t.next_down(), sample.t, sample.t.next_up()];
                let near = t.map(|t| evaluate(emitter, t));
                let (low, high) = (near.into_iter().fold(f64::MAX, f64::min), near.into_iter().fold(0.0, f64::max));
                let (found, pdf) = (f64::from(sample.weight * sample.pdf), f64::from(sample.pdf));
                let at_an_end = sampler.pdf_one(ray, emitter, &medium, t[0]) == 0.0
                    || sampler.pdf_one(ray, emitter, &medium, t[2]) == 0.0;
                let fits = (0.999 * low..=1.001 * high).contains(&found);
                assert!(fits || at_an_end, "{sampler:?} at {u}: {sample:?}, {low:e} to {high:e} over {pdf}, {spot:?}");
            }
        }
    }
    println!("{hard} in full, {soft} between the cones, {dark} in the dark");
    assert!(hard.min(soft).min(dark) > 10_000);
}

/// It has no word on the cone: the distances and densities are those of a point.
#[test]
fn the_transmittance_is_sampled_along_the_whole_ray() {
    println!("seed {SEED}");
    let mut random = Random::new(SEED);
    let mut lit = 0;
    let sampler = Sampler::new(Strategy::Transmittance);
    for _ in 0..2000 {
        let (spot, medium, u) = (Spot::any(&mut random), fog(&mut random), random.uniform());
        let of = |emitter: &Emitter| sampler.sample_one(&spot.ray, emitter, &medium, u);
        let (Some(found), Some(point)) = (of(&spot.emitter), of(&spot.without_cone())) else { continue };
        assert_eq!([found.t, found.pdf].map(f32::to_bits), [point.t, point.pdf].map(f32::to_bits), "{spot:?} at {u}");
        lit += 1;
    }
    assert!(lit > 500, "{lit}");
}

/// All that is written for the rows of columns whose emitters are given as `emitters`, as bits.
fn everything(columns: &Columns, emitters: &Emitters<'_>, sampler: &Sampler) -> Vec<[u32; 8]> {
    let (n, t) = (columns.len(), columns.given().iter().map(|u| 12.0 * u).collect::<Vec<_>>());
    let (rays, media) = (columns.rays(0..n), columns.media(0..n));
    let (mut drawn, mut at_t) = (Drawn::new(n), [(); 4].map(|()| vec![f32::NAN; n]));
    let [pdf, cdf, integrand, radiance] = &mut at_t;
    sampler.sample(&rays, emitters, &media, columns.given(), &mut drawn.samples()).unwrap();
    sampler.pdf(&rays, emitters, &media, &t, pdf).unwrap();
    sampler.cdf(&rays, emitters, &media, &t, cdf).unwrap();
    sampler.evaluate(&rays, emitters, &media, &t, integrand).unwrap();
    let integral = Integral::new(Nodes::Four).with_backend(sampler.backend()).with_precision(sampler.precision());
    integral.radiance(&rays, emitters, &media, radiance).unwrap();
    (0..n)
        .map(|i| {
            let [t, pdf, weight, r] = drawn.bits(i);
            let [pdf_at, cdf, integrand, radiance] = at_t.each_ref().map(|column| column[i].to_bits());
            [t, pdf, weight, r, pdf_at, cdf, integrand, radiance]
        })
        .collect()
}

/// To the bit, whether or not spots stand next to it.
#[test]
fn two_cosines_of_minus_1_are_no_cone() {
    const RAYS: usize = 4099;
    println!("seed {SEED}");
    let mut random = Random::new(SEED);
    let cases: Vec<(Case, f32)> = (0..RAYS).map(|_| (random.case(), random.uniform())).collect();
    let is_spot: Vec<bool> = (0..RAYS).map(|_| random.below(3) == 0).collect();
    let mixed = cases.iter().zip(&is_spot).map(|(&(case, u), &is_spot)| {
        let emitter = if is_spot { random.spot() } else { case.emitter };
        (Case { emitter, ..case }, u)
    });
    let (mixed, alike) = (Columns::new(mixed), Columns::new(cases.iter().copied()));
    let none = vec![-1.0; RAYS];
    let [position, axis] = [8, 11].map(|first| [0, 1, 2].map(|k| &alike.0[first + k][..]));
    for backend in distinct() {
        for sampler in samplers::all().map(|sampler| sampler.with_backend(backend)) {
            let expected = everything(&alike, &Emitters::each(position, axis), &sampler);
            let without = everything(&alike, &Emitters::each_spot(position, axis, &none, &none), &sampler);
            let beside = everything(&mixed, &mixed.emitters(0..RAYS), &sampler);
            let mut spots = 0;
            for i in 0..RAYS {
                let seen = || format!("ray {i}, {sampler:?}: {:?}", cases[i]);
                assert_eq!(without[i], expected[i], "{}", seen());
                assert!(is_spot[i] || beside[i] == expected[i], "{}", seen());
                spots += usize::from(is_spot[i] && beside[i] != expected[i]);
            }
            assert!(spots > 500, "{spots} spots are none, {sampler:?}");
        }
    }
}
