//! `cdf` is the inverse of `sample`: from a distance back to the variate. Its error at any distance is among the figures of
//! `airlight accuracy`, and held on every family by `tests/hard_cases.rs`; here is what it does besides.

mod scenes;

use airlight::{Precision, Sampler, Strategy};
use airlight_tools::samplers;
use scenes::{Case, Columns, Random};

const SEED: u64 = 14;

/// A lit case of each kind, and its ray.
fn lit(random: &mut Random) -> Case {
    std::iter::repeat_with(|| random.case_or_spot()).find(|case| case.oracle().lit().is_some()).unwrap()
}

fn cdfs(sampler: &Sampler, case: &Case, t: Vec<f32>) -> Vec<f32> {
    let (columns, mut cdf) = (Columns::repeat(case, t), Vec::new());
    cdf.resize(columns.len(), f32::NAN);
    let all = 0..columns.len();
    let (rays, emitters, media) = (columns.rays(all.clone()), columns.emitters(all.clone()), columns.media(all));
    sampler.cdf(&rays, &emitters, &media, columns.given(), &mut cdf).unwrap();
    cdf
}

#[test]
fn it_leads_back_to_the_variate() {
    let mut random = Random::new(SEED);
    for _ in 0..300 {
        let case = lit(&mut random);
        for sampler in Strategy::ALL.iter().map(|&strategy| Sampler::new(strategy)) {
            let u: Vec<f32> = (0..40).map(|_| random.uniform()).collect();
            let t = Columns::repeat(&case, u.clone()).sample(&sampler).t;
            let scene = case.oracle();
            for ((u, t), back) in u.into_iter().zip(&t).zip(cdfs(&sampler, &case, t.clone())) {
                // What the rounding of t loses, and the errors of sample and cdf.
                let ends = [t.next_down(), t.next_up()].map(|t| scene.cdf(sampler.strategy(), t.into()));
                let allowed = ends[1] - ends[0] + 2.0 * 2f64.powi(-20);
                let error = f64::from((back - u).abs());
                assert!(error <= allowed, "{}: {u} -> {t} -> {back}, seed {SEED}, {case:?}", sampler.strategy());
            }
        }
    }
}

/// Before and at the start 0, at and beyond the end 1, and between these it does not fall by more than rounding.
#[test]
fn it_goes_from_0_to_1() {
    let mut random = Random::new(SEED + 1);
    for _ in 0..300 {
        let case = lit(&mut random);
        for sampler in samplers::all() {
            let strategy = sampler.strategy();
            let (t_a, t_b) = case.oracle().lit().unwrap();
            let last = f64::from(1e18f32).min(t_b);
            let mut t: Vec<f32> = (0..=64).map(|k| (t_a + (last - t_a) * f64::from(k) / 64.0) as f32).collect();
            t.splice(0..0, [f32::NEG_INFINITY, -1.0]);
            t.extend([f32::MAX, f32::INFINITY]);
            let cdf = cdfs(&sampler, &case, t.clone());
            let seen = || format!("{strategy}, {}, seed {SEED}, {case:?}: {cdf:?}", sampler.precision());
            assert_eq!((cdf[0], cdf[1], cdf[67], cdf[68]), (0.0, 0.0, 1.0, 1.0), "{}", seen());
            assert!(cdf.iter().all(|x| (0.0..=1.0).contains(x)), "{}", seen());
            let rounding = if sampler.precision() == Precision::Exact { 2e-6 } else { 2e-3 };
            assert!(cdf.windows(2).all(|pair| pair[0] <= pair[1] + rounding), "{}", seen());
        }
    }
}

#[test]
fn one_ray_has_the_bits_of_the_batch_and_several_distances_those_of_one_each() {
    let mut random = Random::new(SEED + 2);
    for &strategy in Strategy::ALL {
        let (sampler, case) = (Sampler::new(strategy), lit(&mut random));
        let t: Vec<f32> = (0..77).map(|_| random.between(0.0, 20.0)).collect();
        let batch = cdfs(&sampler, &case, t.clone());
        let one = Columns::repeat(&case, vec![0.0]);
        let mut several = vec![f32::NAN; t.len()];
        sampler.cdf(&one.rays(0..1), &one.emitters(0..1), &one.media(0..1), &t, &mut several).unwrap();
        for ((t, batch), several) in t.iter().zip(&batch).zip(&several) {
            let alone = sampler.cdf_one(&case.ray, &case.emitter, &case.medium, *t);
            assert_eq!((alone.to_bits(), several.to_bits()), (batch.to_bits(), batch.to_bits()), "{strategy} at {t}");
        }
    }
}

#[test]
fn a_distance_that_is_no_number_makes_its_ray_invalid() {
    let mut random = Random::new(SEED + 3);
    for &strategy in Strategy::ALL {
        let (sampler, case) = (Sampler::new(strategy), lit(&mut random));
        let columns = Columns::repeat(&case, vec![1.0, f32::NAN, 2.0]);
        let (rays, emitters, media) = (columns.rays(0..3), columns.emitters(0..3), columns.media(0..3));
        let mut cdf = [f32::NAN; 3];
        let counts = sampler.cdf(&rays, &emitters, &media, columns.given(), &mut cdf).unwrap();
        assert_eq!((counts.sampled, counts.invalid, cdf[1]), (2, 1, 0.0), "{strategy}");
        let result = sampler.cdf(&rays, &emitters, &media, columns.given(), &mut [0.0; 2]);
        assert_eq!(result.unwrap_err().to_string(), "cdf has 2 elements, expected 3");
    }
}
