//! Every strategy samples the density that it says it does: `pdf` integrates to 1, `sample` inverts its distribution in
//! order of the variate, and what `sample`, `pdf` and `evaluate` return for one point fits together.

mod scenes;

use airlight::oracle::quadrature::integrate_pieces;
use airlight::{Emitter, Medium, Ray, Sampler, Strategy};
use airlight_tools::contender::PRODUCTS;
use glam::Vec3;
use scenes::{Case, Columns, Random, Row, ulp};

const SEED: u64 = 1;

/// A direction or normal as long as any that is accepted.
fn nearly_unit(random: &mut Random) -> Vec3 {
    random.unit() * random.between(0.9991, 1.0009)
}

/// Cases of every kind: an emitter with or without a normal, backward, isotropic and forward scattering, thin and dense,
/// a ray with an end or without, that starts in the medium or outside.
fn cases() -> Vec<Case> {
    let mut random = Random::new(SEED);
    let mut cases = Vec::new();
    for kind in 0..48 {
        let pick = |period: usize| kind / period % 2 == 1;
        let (point, dense, infinite, outside) = (pick(1), pick(2), pick(4), pick(8));
        let g = [0.0, 0.9, -0.6][kind / 16];
        let mut found = 0;
        while found < 3 {
            let position = random.point();
            let emitter = if point {
                Emitter::point(position)
            } else {
                Emitter::point_normal(position, nearly_unit(&mut random))
            };
            let t_min = if outside { random.between(0.5, 3.0) } else { 0.0 };
            let length = if infinite { f32::INFINITY } else { random.between(1.0, 20.0) };
            let ray = Ray::new(random.point(), nearly_unit(&mut random), t_min, t_min + length);
            let mu_t = if dense { 3.0 } else { 0.01 };
            let medium = Medium::new(0.4 * mu_t, 0.6 * mu_t, g);
            let case = Case { ray: ray.unwrap(), emitter: emitter.unwrap(), medium: medium.unwrap() };
            if case.oracle().lit().is_some() {
                found += 1;
                cases.push(case);
            }
        }
    }
    cases
}

/// Every case with every strategy.
fn each() -> impl Iterator<Item = (Case, Strategy)> {
    cases().into_iter().flat_map(|case| Strategy::ALL.iter().map(move |&strategy| (case, strategy)))
}

/// 0, 1, their neighbours, and `n` between.
fn variates(n: usize) -> Vec<f32> {
    let least = 2f32.powi(-24);
    let mut random = Random::new(SEED + 1);
    let mut u = vec![0.0, least, 1.0 - least, 1.0];
    u.extend((0..n).map(|_| random.uniform()));
    u
}

/// The smallest and the largest value of `f` as near to `t` as `reach`: what rounding may make of it.
fn range_around(t: f32, reach: f64, f: impl Fn(f64) -> f64) -> (f64, f64) {
    let values = [-1.0, -0.5, 0.0, 0.5, 1.0].map(|k| f(f64::from(t) + k * reach));
    values.into_iter().fold((f64::INFINITY, 0.0), |(low, high), x| (low.min(x), high.max(x)))
}

/// The variable of the quadrature is one in which the density is smooth: the angle, or for the density that knows no
/// emitter the distance by its own distribution.
#[test]
fn the_pdf_integrates_to_1() {
    for (case, strategy) in each() {
        let (scene, sampler) = (case.oracle(), Sampler::new(strategy));
        let variable = if strategy == Strategy::Transmittance { strategy } else { Strategy::EquiAngular };
        let density = |x: f64| {
            let t = scene.draw(variable, x) as f32;
            f64::from(sampler.pdf_one(&case.ray, &case.emitter, &case.medium, t)) / scene.pdf(variable, f64::from(t))
        };
        // A product density has kinks at its knots, which short pieces let the quadrature see.
        let pieces = if PRODUCTS.contains(&strategy) { 256 } else { 16 };
        let ends: Vec<f64> = (0..=pieces).map(|i| f64::from(i) / f64::from(pieces)).collect();
        let mass = integrate_pieces(density, &ends, 1e-6);
        assert!((mass - 1.0).abs() <= 1e-5, "{strategy}: {mass}, seed {SEED}, {case:?}");
    }
}

/// What the rounding of `t` loses aside.
#[test]
fn samples_invert_the_distribution() {
    let mut errors = Vec::new();
    for (case, strategy) in each() {
        let scene = case.oracle();
        let columns = Columns::repeat(&case, variates(2044));
        let drawn = columns.sample(&Sampler::new(strategy));
        assert_eq!(drawn.counts.sampled, columns.len(), "{strategy}, seed {SEED}, {case:?}");
        for (&t, &u) in drawn.t.iter().zip(columns.given()) {
            let (low, high) = range_around(t, ulp(t), |t| scene.cdf(strategy, t));
            let u = f64::from(u);
            let error = (low - u).max(u - high).max(0.0);
            assert!(error <= 5e-6, "{strategy}: {error:e} at u = {u}, t = {t}, seed {SEED}, {case:?}");
            errors.push(error);
        }
    }
    errors.sort_by(f64::total_cmp);
    let percentile = errors[errors.len() * 999 / 1000];
    assert!(percentile <= 2e-6, "the 99.9th percentile is {percentile:e}, seed {SEED}");
}

/// Variates from each `start` on, `step` apart, in order.
fn runs(starts: &[f32], step: f32) -> Vec<f32> {
    let mut u: Vec<f32> = starts.iter().flat_map(|u| (0..16).map(move |k| u + k as f32 * step)).collect();
    u.retain(|&u| u <= 1.0);
    u.sort_by(f32::total_cmp);
    u
}

/// Strata stay strata. Variates that only their last digits tell apart may swap, by no more than the inverse is off.
#[test]
fn distances_do_not_fall_as_the_variate_grows() {
    let (stratum, apart, least) = (2f32.powi(-14), 2f32.powi(-20), 2f32.powi(-24));
    let strata = (0..=1 << 14).map(|i| i as f32 * stratum);
    let starts = strata.chain(variates(64).into_iter().map(|u| (u / apart).floor() * apart)).collect::<Vec<_>>();
    let (wide, narrow) = (runs(&starts, apart), runs(&variates(64), least));
    for (case, strategy) in each() {
        let draw = |u: &[f32]| Columns::repeat(&case, u.to_vec()).sample(&Sampler::new(strategy)).t;
        let t = draw(&wide);
        for (u, t) in wide.windows(2).zip(t.windows(2)) {
            assert!(t[0] <= t[1], "{strategy}: t falls along {t:?} at u = {u:?}, seed {SEED}, {case:?}");
        }
        for (u, t) in narrow.windows(2).zip(draw(&narrow).windows(2)) {
            let scene = case.oracle();
            let fall = || scene.cdf(strategy, f64::from(t[0])) - scene.cdf(strategy, f64::from(t[1]));
            assert!(t[0] <= t[1] || fall() <= 5e-6, "{strategy}: {t:?} at u = {u:?}, seed {SEED}, {case:?}");
        }
    }
}

/// They agree to a fraction of 1e-5, and to what comes of rounding distances to f32, the ray's and those to the emitter,
/// which move the end of the light and what the transmittance is the exponential of.
#[test]
fn sample_pdf_and_evaluate_agree_at_the_sample() {
    for (case, strategy) in each() {
        let (scene, sampler) = (case.oracle(), Sampler::new(strategy));
        let mut columns = Columns::repeat(&case, variates(124));
        let drawn = columns.sample(&sampler);
        // Between steep knots a product density has the error of v: relative to its mean, not to itself.
        let spread = scene.draw(strategy, 0.75) - scene.draw(strategy, 0.25);
        let vanishing = if PRODUCTS.contains(&strategy) { 1e-6 * 0.5 / spread } else { 0.0 };
        columns.0[Columns::GIVEN] = drawn.t.clone();
        let (pdf, integrand) = (columns.pdf(&sampler), columns.evaluate(&sampler));
        for i in 0..columns.len() {
            let [t, pdf_of_sample, weight, r] = drawn.row(i).map(f64::from);
            let [pdf, integrand] = [pdf[i], integrand[i]].map(f64::from);
            let reach = 2.0 * ulp(drawn.t[i].max(drawn.r[i]));
            let fraction = 1e-5 + scene.mu_t() * reach;
            let check = |what: &str, value: f64, expected: f64, vanishing: f64, f: &dyn Fn(f64) -> f64| {
                let (low, high) = range_around(drawn.t[i], reach, f);
                let allowed = fraction * high + (high - low) + vanishing + f64::from(f32::MIN_POSITIVE);
                let row = Row(&columns, i);
                assert!(
                    (value - expected).abs() <= allowed,
                    "{strategy}, {what}: {value:e} is not {expected:e} within {allowed:e}, seed {SEED}: {row}"
                );
            };
            check("pdf of sample", pdf_of_sample, pdf, vanishing, &|t| scene.pdf(strategy, t));
            check("pdf", pdf, scene.pdf(strategy, t), vanishing, &|t| scene.pdf(strategy, t));
            check("weight times pdf", weight * pdf_of_sample, integrand, 0.0, &|t| scene.integrand(t));
            check("integrand", integrand, scene.integrand(t), 0.0, &|t| scene.integrand(t));
            check("r", r, scene.r(t), 0.0, &|t| scene.r(t));
        }
    }
}
