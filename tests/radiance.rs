//! The estimate of a ray's radiance that a product density has: how near it is to quadrature of the integrand, which knows
//! nothing of that density, on every family of hard inputs.

use airlight::oracle::Scene;
use airlight::oracle::quadrature::gauss_legendre;
use airlight::{Backend, Counts, Emitter, Emitters, Media, Medium, Ray, Rays, Sampler, Strategy};
use airlight_tools::errors::{beyond_f32, quantile};
use airlight_tools::families::{Case, Columns, Family};
use glam::Vec3;

const RAYS: usize = 1 << 13;
const SEEDS: [u64; 2] = [8, 9];
const PRODUCTS: [Strategy; 4] = [Strategy::Product3, Strategy::Product5, Strategy::Product9, Strategy::Product17];

/// Where the transmittance to the start of the lit part is less, the estimate runs out of f32's range before the radiance.
const LEAST_TRANSMITTANCE: f64 = 1e-30;
/// The smallest radiance that f32 has with all digits, and a little room.
const LEAST_RADIANCE: f64 = 1e-37;

/// The relative errors that half of the rays stay below, 99 % and all of them.
type Bounds = [f64; 3];

fn text(values: Bounds) -> String {
    values.map(|value| format!("{value:.1e}")).join(" ")
}

/// For 3, 5, 9 and 17 knots: as measured with these seeds, and about a quarter of room.
fn bounds(family: Family) -> [Bounds; 4] {
    match family {
        Family::Generic | Family::Variate => {
            [[0.05, 0.22, 0.3], [0.002, 0.012, 0.016], [2e-4, 0.002, 0.004], [2e-5, 1.3e-4, 0.0012]]
        }
        Family::NearEmitter => {
            [[0.025, 0.17, 0.45], [0.0015, 0.018, 0.04], [1.2e-4, 0.0036, 0.012], [2.4e-5, 0.0016, 0.004]]
        }
        Family::FarAway | Family::ShortIntervals => {
            [[2.5e-7, 3e-4, 0.004], [2.5e-7, 3e-5, 5e-4], [2.5e-7, 5e-6, 1e-4], [2.5e-7, 5e-6, 3e-5]]
        }
        Family::InfiniteRays => {
            [[0.055, 0.35, 0.45], [0.0065, 0.028, 0.036], [0.0012, 0.0065, 0.009], [8e-5, 0.003, 0.004]]
        }
        Family::Cosine => [[0.0035, 0.32, 0.45], [4.5e-4, 0.023, 0.042], [9e-5, 0.0037, 0.02], [2e-5, 0.001, 0.009]],
        Family::Phase => {
            [[0.055, 0.23, 0.3], [0.002, 0.0125, 0.018], [2.1e-4, 0.0027, 0.006], [1.7e-5, 1.3e-4, 0.0012]]
        }
        Family::Medium => [[0.016, 0.3, 0.4], [0.0015, 0.023, 0.035], [1.4e-4, 0.005, 0.01], [2e-5, 0.0022, 0.004]],
        Family::Ray => [[0.024, 0.32, 0.42], [0.0016, 0.022, 0.028], [1.4e-4, 0.003, 0.004], [1.6e-5, 4e-4, 6e-4]],
        Family::RandomBits => {
            [[0.022, 0.35, 0.42], [0.0014, 0.028, 0.034], [1.8e-4, 0.0055, 0.007], [2e-5, 0.0015, 0.0025]]
        }
        Family::Peaks => [[0.028, 0.34, 0.48], [0.0017, 0.022, 0.04], [1.7e-4, 0.0053, 0.0115], [2e-5, 0.0022, 0.0055]],
    }
}

fn estimates(sampler: &Sampler, cases: &[Case]) -> (Vec<f32>, Counts) {
    let columns = Columns::new(cases);
    let mut estimates = vec![f32::NAN; cases.len()];
    let (rays, emitters, media) = (columns.rays(), columns.emitters(), columns.media());
    let counts = sampler.radiance(&rays, &emitters, &media, &mut estimates).unwrap();
    (estimates, counts)
}

/// The cases of a family, with the scenes and the radiances of those that are valid and of resolved size.
fn cases(family: Family, seed: u64, count: usize) -> (Vec<Case>, Vec<Option<(Scene, f64)>>) {
    let cases: Vec<Case> = (0..count as u64).map(|i| family.case(seed, i)).collect();
    let scene = |case: &Case| case.scene().ok().filter(|_| !case.is_extreme()).map(|scene| (scene, scene.radiance()));
    let scenes = cases.iter().map(scene).collect();
    (cases, scenes)
}

/// Whether f32 has the digits of the estimate.
fn comparable(scene: &Scene, radiance: f64) -> bool {
    let start = scene.lit().map_or(0.0, |(t_a, _)| scene.transmittance(t_a));
    radiance > LEAST_RADIANCE && start > LEAST_TRANSMITTANCE && !beyond_f32(scene)
}

#[test]
fn the_estimate_is_near_the_radiance_in_every_family() {
    let mut broken = Vec::new();
    for (family, seed) in Family::ALL.into_iter().flat_map(|family| SEEDS.map(|seed| (family, seed))) {
        let (cases, scenes) = cases(family, seed, RAYS);
        for (strategy, bounds) in PRODUCTS.into_iter().zip(bounds(family)) {
            let (estimates, _) = estimates(&Sampler::new(strategy), &cases);
            let mut errors = Vec::new();
            for ((case, scene), &estimate) in cases.iter().zip(&scenes).zip(&estimates) {
                assert!(estimate.is_finite() && estimate >= 0.0, "{strategy}, seed {seed}: {estimate} of {case:?}");
                let estimate = f64::from(estimate);
                match scene {
                    Some((scene, radiance)) if comparable(scene, *radiance) => {
                        errors.push((estimate / radiance - 1.0).abs());
                    }
                    // Too small for f32, or for its digits: 0, or about as small.
                    Some((_, radiance)) => {
                        let most = if *radiance > 0.0 { 2.0 * radiance + 1e-37 } else { 0.0 };
                        assert!(
                            estimate <= most,
                            "{strategy}, seed {seed}: {estimate:e} is not {radiance:e}, {case:?}"
                        );
                    }
                    None if case.scene().is_err() => assert_eq!(estimate, 0.0, "{strategy}, seed {seed}: {case:?}"),
                    None => {}
                }
            }
            assert!(errors.len() > RAYS / 64, "{strategy} on {}: {} rays compared", family.name(), errors.len());
            errors.sort_unstable_by(f64::total_cmp);
            let figures = [0.5, 0.99, 1.0].map(|p| quantile(&errors, p));
            let line = format!("{:16} {strategy:10} seed {seed}: {} of {}", family.name(), text(figures), text(bounds));
            println!("{line}");
            if figures.iter().zip(bounds).any(|(figure, bound)| *figure > bound) {
                broken.push(line);
            }
        }
    }
    assert!(broken.is_empty(), "{broken:#?}");
}

/// By Gauss and Legendre's rule over the distance, in pieces a quarter of a decade wide around the foot of the
/// perpendicular and behind both ends; and how far the rounding of the distances may move it, relative.
fn radiance_over_distance(scene: &Scene) -> Option<(f64, f64)> {
    const RATIO: f64 = 1.778_279_41;
    let (t_a, t_b) = scene.lit()?;
    let (length, t_h) = (t_b - t_a, scene.t_h());
    let finest = 1e-6 * scene.h().min(length).min(1.0 / scene.mu_t());
    let farthest = length.max((t_b - t_h).abs()).max((t_a - t_h).abs());
    let away = std::iter::successors(Some(finest), |x| Some(x * RATIO)).take_while(|&x| x < farthest);
    let mut ends: Vec<f64> = away.flat_map(|x| [t_a + x, t_b - x, t_h - x, t_h + x]).chain([t_h]).collect();
    ends.retain(|t| (t_a..t_b).contains(t));
    ends.extend([t_a, t_b]);
    ends.sort_by(f64::total_cmp);
    let radiance = ends.windows(2).map(|piece| gauss_legendre(|t| scene.integrand(t), piece[0], piece[1])).sum();
    let near = t_a.max(t_b.min(t_a + 1e3 * scene.h()));
    let rounding = f64::EPSILON * near.max(t_h.abs()) / scene.h().min(length);
    Some((radiance, rounding))
}

/// On peaks, next to emitters and on infinite rays: two quadratures that share the integrand alone.
#[test]
fn the_oracle_is_the_integral_over_distance() {
    for (family, seed) in Family::ALL.into_iter().flat_map(|family| SEEDS.map(|seed| (family, seed))) {
        let (cases, scenes) = cases(family, seed, RAYS / 16);
        let mut compared = 0;
        for (case, scene) in cases.iter().zip(scenes) {
            let Some((scene, radiance)) = scene.filter(|(_, radiance)| *radiance > 1e-200) else { continue };
            let Some((expected, rounding)) = radiance_over_distance(&scene) else { continue };
            let error = (radiance / expected - 1.0).abs();
            let allowed = 1e-9 + 8.0 * rounding;
            assert!(error <= allowed, "{}, seed {seed}: {radiance:e} is not {expected:e}, {case:?}", family.name());
            compared += 1;
        }
        assert!(compared > 10, "{}, seed {seed}: {compared} compared", family.name());
    }
}

/// The estimate and the quadrature of one ray from the origin along z.
fn along_z(strategy: Strategy, (lamp, t_max, g): (Vec3, f32, f32)) -> (f64, f64) {
    let (zero, one, end) = ([0.0], [1.0], [t_max]);
    let rays = Rays::new([&zero; 3], [&zero, &zero, &one], &zero, &end);
    let (emitter, medium) = (Emitter::point(lamp).unwrap(), Medium::new(0.1, 0.3, g).unwrap());
    let mut estimate = [f32::NAN];
    let sampler = Sampler::new(strategy);
    sampler.radiance(&rays, &Emitters::one(emitter), &Media::one(medium), &mut estimate).unwrap();
    let ray = Ray::new(Vec3::ZERO, Vec3::Z, 0.0, t_max).unwrap();
    (estimate[0].into(), Scene::new(&ray, &emitter, &medium).radiance())
}

/// Beside the peak the radiance is proportional to `1 - |g|`, on it to `1/(1 - |g|)^2` or so.
#[test]
fn peaks_have_their_height_up_to_g_1() {
    let (beside, on) = (Vec3::new(1.0, 0.0, 5.0), Vec3::new(5e-4, 0.0, 10.0));
    for (lamp, t_max, g, expected) in [
        (beside, 10.0, 0.9999, 7.83e-6),
        (beside, 10.0, 0.99999, 7.84e-7),
        (beside, 10.0, 1.0, 0.0),
        (beside, 10.0, -1.0, 0.0),
        (on, 8.0, 0.9999, 8417.0),
        (on, 8.0, 1.0, 0.0),
    ] {
        for (strategy, allowed) in PRODUCTS.into_iter().zip([0.25, 0.02, 0.004, 0.001]) {
            let (estimate, radiance) = along_z(strategy, (lamp, t_max, g));
            let near = |value: f64, exact: f64, share: f64| (value - exact).abs() <= share * exact;
            assert!(near(radiance, expected, 1e-3), "quadrature: {radiance:e} is not {expected:e}, g = {g}, {lamp}");
            assert!(near(estimate, radiance, allowed), "{strategy}: {estimate:e} is not {radiance:e}, g = {g}, {lamp}");
        }
    }
}

#[test]
fn every_ray_is_counted() {
    let (cases, scenes) = cases(Family::Generic, 8, RAYS);
    let lit = scenes.iter().flatten().filter(|(_, radiance)| *radiance > 0.0).count();
    for strategy in PRODUCTS {
        let (_, counts) = estimates(&Sampler::new(strategy), &cases);
        assert_eq!((counts.sampled, counts.empty), (lit, RAYS - lit), "{strategy}");
    }
}

#[test]
fn any_number_of_rays() {
    let (cases, _) = cases(Family::Generic, 8, 96);
    for backend in Backend::available() {
        let sampler = Sampler::new(Strategy::Product5).with_backend(backend);
        let all = estimates(&sampler, &cases).0;
        for n in 0..cases.len() {
            let (few, counts) = estimates(&sampler, &cases[..n]);
            assert_eq!(few, all[..n], "{n} rays, {backend:?}");
            assert_eq!(counts.sampled + counts.empty + counts.invalid, n);
        }
    }
}

#[test]
fn other_strategies_have_none() {
    let columns = Columns::new(&[]);
    for &strategy in Strategy::ALL {
        let result = Sampler::new(strategy).radiance(&columns.rays(), &columns.emitters(), &columns.media(), &mut []);
        let expected = format!("the strategy {strategy} has no radiance");
        let said = result.map_err(|error| error.to_string());
        assert_eq!(said, if strategy.has_radiance() { Ok(Counts::default()) } else { Err(expected) });
    }
}
