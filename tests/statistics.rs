//! What is drawn from random variates is distributed as claimed, and the mean of its weights is the radiance.
//!
//! A million samples for each of a dozen scenes, and fifty thousand for each of 188 more, stand three tests for every
//! strategy: chi-square over 101 cells, Kolmogorov and Smirnov's, and the mean of the weights. The significances of the first two are those of all scenes and strategies together.

mod scenes;

use airlight::oracle::Scene;
use airlight::oracle::quadrature::integrate_pieces;
use airlight::{Sampler, Strategy};
use scenes::{Case, Columns, Drawn, Random};

const SEED: u64 = 2;
const CELLS: usize = 101;
const SCENES: usize = 200;
/// Of a false alarm among all scenes and strategies.
const SIGNIFICANCE: f64 = 0.01;

/// Samples for scene number `i`.
fn samples(i: usize) -> usize {
    if i < 12 { 1_000_000 } else { 50_000 }
}

/// Scenes in which the light comes from more than a point: an estimator's variance is finite and can be measured.
fn cases() -> Vec<Case> {
    let mut random = Random::new(SEED);
    let moderate = |case: &Case| {
        let scene = case.oracle();
        scene.h() > 0.3
            && scene.mu_t() * scene.h() < 10.0
            && scene.lit().is_some_and(|(t_a, t_b)| scene.angle(t_a, t_b) > 0.3)
    };
    std::iter::repeat_with(|| random.case()).filter(moderate).take(SCENES).collect()
}

/// Draws for every scene and strategy, and gives `test` the significance that is Sidak's share of each.
fn for_each(test: impl Fn(&Case, &Scene, Strategy, &Drawn, f64)) {
    let share = 1.0 - (1.0 - SIGNIFICANCE).powf(1.0 / (SCENES * Strategy::ALL.len()) as f64);
    for (i, case) in cases().iter().enumerate() {
        let mut random = Random::new(SEED << 32 | i as u64);
        let mut columns = Columns::repeat(case, vec![0.0; samples(i)]);
        columns.0[Columns::GIVEN].fill_with(|| random.uniform());
        for &strategy in Strategy::ALL {
            let drawn = columns.sample(&Sampler::new(strategy));
            assert_eq!(drawn.counts.sampled, samples(i));
            test(case, &case.oracle(), strategy, &drawn, share);
        }
    }
}

/// The ends of cells of equal width in the angle at the emitter; for the density that knows no emitter of equal width in
/// `t`, all but the last one, which takes the last thousandth.
fn ends(scene: &Scene, strategy: Strategy) -> [f64; CELLS - 1] {
    std::array::from_fn(|i| {
        let x = (i + 1) as f64 / CELLS as f64;
        match strategy {
            Strategy::Transmittance => {
                let (start, end) = (scene.draw(strategy, 0.0), scene.draw(strategy, 0.999));
                start + (end - start) * (i + 1) as f64 / (CELLS - 1) as f64
            }
            _ => scene.draw(Strategy::EquiAngular, x),
        }
    })
}

/// The probability that a chi-square variable of `freedom` degrees is beyond `x`, by quadrature around its mode.
fn chi_square_tail(freedom: usize, x: f64) -> f64 {
    let mode = freedom as f64 - 2.0;
    let density = |y: f64| if y > 0.0 { (0.5 * mode * (y / mode).ln() - 0.5 * (y - mode)).exp() } else { 0.0 };
    let pieces = |a: f64| [0, 1, 2, 4, 8, 16, 32].map(|k| a + 0.5 * mode * f64::from(k));
    integrate_pieces(density, &pieces(x), 1e-10) / integrate_pieces(density, &pieces(0.0), 1e-10)
}

/// The probability that Kolmogorov's variable is beyond `lambda`.
fn kolmogorov_tail(lambda: f64) -> f64 {
    let term = |k: i32| (-2.0 * (f64::from(k) * lambda).powi(2)).exp() * if k % 2 == 0 { -2.0 } else { 2.0 };
    (1..=100).map(term).sum::<f64>().min(1.0)
}

#[test]
fn the_tails_are_those_of_the_tables() {
    for (value, expected) in [
        (chi_square_tail(10, 18.307_038), 0.05),
        (chi_square_tail(100, 135.806_723), 0.01),
        (kolmogorov_tail(1.358_099), 0.05),
        (kolmogorov_tail(1.627_624), 0.01),
    ] {
        assert!((value / expected - 1.0).abs() < 1e-4, "{value} is not {expected}");
    }
}

#[test]
fn chi_square() {
    for_each(|case, scene, strategy, drawn, share| {
        let ends = ends(scene, strategy);
        let mut observed = [0.0; CELLS];
        for &t in &drawn.t {
            observed[ends.partition_point(|&end| end < f64::from(t))] += 1.0;
        }
        let cdf: Vec<f64> = ends.iter().map(|&t| scene.cdf(strategy, t)).chain([1.0]).collect();
        // Neighbouring cells are pooled until five samples are expected; what is left at the end joins the last pool.
        let mut pools: Vec<(f64, f64)> = Vec::new();
        let mut pool = (0.0, 0.0);
        let mut below = 0.0;
        for (observed, cdf) in observed.into_iter().zip(cdf) {
            pool = (pool.0 + observed, pool.1 + (cdf - below) * drawn.t.len() as f64);
            below = cdf;
            if pool.1 >= 5.0 {
                pools.push(std::mem::take(&mut pool));
            }
        }
        let last = pools.last_mut().unwrap();
        *last = (last.0 + pool.0, last.1 + pool.1);
        let sum: f64 = pools.iter().map(|(observed, expected)| (observed - expected).powi(2) / expected).sum();
        let p = chi_square_tail(pools.len() - 1, sum);
        assert!(p > share, "{strategy}: chi-square {sum} of {} cells, p = {p:e}, seed {SEED}, {case:?}", pools.len());
    });
}

/// Looked at is every 64th sample; between two of them the distance cannot grow by more than 64 samples.
#[test]
fn kolmogorov_smirnov() {
    const EVERY: usize = 64;
    for_each(|case, scene, strategy, drawn, share| {
        let mut t = drawn.t.clone();
        t.sort_unstable_by(f32::total_cmp);
        let n = t.len() as f64;
        let distance = (0..t.len())
            .step_by(EVERY)
            .map(|i| (scene.cdf(strategy, f64::from(t[i])) - (i as f64 + 0.5) / n).abs())
            .fold(0.0, f64::max);
        let p = kolmogorov_tail((distance + 0.5 / n) * n.sqrt());
        assert!(p > share, "{strategy}: distance {distance}, p = {p:e}, seed {SEED}, {case:?}");
    });
}

#[test]
fn the_mean_weight_is_the_radiance() {
    for_each(|case, scene, strategy, drawn, _| {
        let (n, weights) = (drawn.weight.len() as f64, || drawn.weight.iter().map(|&w| f64::from(w)));
        let mean = weights().sum::<f64>() / n;
        let variance = weights().map(|w| (w - mean).powi(2)).sum::<f64>() / (n - 1.0);
        let radiance = scene.radiance();
        // A weight is rounded to f32, and where one strategy hits the integrand that is all its variance.
        let rounding = 1e-6 * radiance;
        let z = (mean - radiance) / (variance / n).sqrt().max(rounding);
        assert!(z.abs() < 5.0, "{strategy}: {mean:e} is not {radiance:e}, z = {z}, seed {SEED}, {case:?}");
    });
}
