//! Coloured media in the kernels: against the oracle in every channel, and that what is written for a ray depends on that ray
//! alone.

mod scenes;

use airlight::oracle::Coloured;
use airlight::{Backend, Counts, Integral, Media, Medium, Nodes, Sampler, Samples, Strategy, Threads};
use scenes::{Case, Columns, Random};
use std::ops::Range;

const SEED: u64 = 17;
/// Rays that a batch is cut into chunks of.
const CHUNK: usize = 4096;
const NODES: Nodes = Nodes::Twelve;

/// Random rays in media of `C` channels, with variates.
#[derive(Clone)]
struct Batch<const C: usize> {
    cases: Vec<Case>,
    columns: Columns,
    mu_a: [Vec<f32>; C],
    mu_s: [Vec<f32>; C],
}

/// All that is written for the rays of a batch.
#[derive(Clone, Debug, PartialEq)]
struct Written<const C: usize> {
    t: Vec<f32>,
    pdf: Vec<f32>,
    r: Vec<f32>,
    weights: [Vec<f32>; C],
    /// At `t`.
    pdf_at_t: Vec<f32>,
    cdf_at_t: Vec<f32>,
    integrands: [Vec<f32>; C],
    radiances: [Vec<f32>; C],
    counts: [Counts; 2],
}

/// A medium about as dense as that of the case, whose channels differ up to a hundredfold; one in eight does not scatter.
fn colour<const C: usize>(random: &mut Random, case: &Case) -> Medium {
    let mu_t: [f32; C] = [(); C].map(|()| case.medium.mu_t() * 10f32.powf(random.between(-1.0, 1.0)));
    let mu_s = mu_t.map(|mu_t| mu_t * [0.0, random.between(0.1, 1.0)][random.below(8).min(1)]);
    let mu_a = std::array::from_fn(|c| mu_t[c] - mu_s[c]);
    Medium::coloured::<C>(mu_a, mu_s, case.medium.g()).unwrap()
}

impl<const C: usize> Batch<C> {
    fn new(rows: impl IntoIterator<Item = (Case, f32)>) -> Self {
        let (cases, u): (Vec<Case>, Vec<f32>) = rows.into_iter().unzip();
        let of_channels = |mu: fn(&Medium) -> f32| {
            std::array::from_fn(|c| cases.iter().map(|case| mu(&case.medium.channel(c).unwrap())).collect())
        };
        let (mu_a, mu_s) = (of_channels(Medium::mu_a), of_channels(Medium::mu_s));
        Self { columns: Columns::new(cases.iter().copied().zip(u)), cases, mu_a, mu_s }
    }

    /// `n` rays, lit or not.
    fn random(n: usize) -> Self {
        println!("seed {SEED}");
        let mut random = Random::new(SEED);
        let row = |random: &mut Random| {
            let case = random.case();
            (Case { medium: colour::<C>(random, &case), ..case }, random.uniform())
        };
        Self::new((0..n).map(|_| row(&mut random)))
    }

    fn len(&self) -> usize {
        self.cases.len()
    }

    fn media(&self, range: Range<usize>) -> Media<'_> {
        let [mu_a, mu_s] = [&self.mu_a, &self.mu_s].map(|mu| mu.each_ref().map(|mu| &mu[range.clone()]));
        Media::each_coloured(mu_a, mu_s, &self.columns.0[Columns::index("media.g")][range])
    }

    fn written(&self, sampler: &Sampler) -> Written<C> {
        self.written_in(sampler, 0..self.len(), &self.media(0..self.len()), self.columns.given())
    }

    fn written_of(&self, sampler: &Sampler, range: Range<usize>) -> Written<C> {
        let u = &self.columns.given()[range.clone()];
        self.written_in(sampler, range.clone(), &self.media(range), u)
    }

    /// Of the rays of a range, in media that are given, with variates for each.
    fn written_in(&self, sampler: &Sampler, range: Range<usize>, media: &Media<'_>, u: &[f32]) -> Written<C> {
        let (rays, emitters) = (self.columns.rays(range.clone()), self.columns.emitters(range.clone()));
        let column = || vec![f32::NAN; u.len()];
        let [mut t, mut pdf, mut r, mut pdf_at_t, mut cdf_at_t] = [(); 5].map(|()| column());
        let [mut weights, mut integrands] = [(); 2].map(|()| [(); C].map(|()| column()));
        let mut radiances = [(); C].map(|()| vec![f32::NAN; range.len()]);
        let mut samples = Samples::new(&mut t, &mut pdf).r(&mut r).weights(slices(&mut weights));
        let of_samples = sampler.sample(&rays, &emitters, media, u, &mut samples).unwrap();
        sampler.pdf(&rays, &emitters, media, &t, &mut pdf_at_t).unwrap();
        sampler.cdf(&rays, &emitters, media, &t, &mut cdf_at_t).unwrap();
        sampler.evaluate_coloured(&rays, &emitters, media, &t, slices(&mut integrands)).unwrap();
        let integral = Integral::new(NODES).with_backend(sampler.backend()).with_threads(sampler.threads());
        let of_rays = integral.radiance_coloured(&rays, &emitters, media, slices(&mut radiances)).unwrap();
        Written { t, pdf, r, weights, pdf_at_t, cdf_at_t, integrands, radiances, counts: [of_samples, of_rays] }
    }
}

fn slices<const C: usize>(columns: &mut [Vec<f32>; C]) -> [&mut [f32]; C] {
    columns.each_mut().map(Vec::as_mut_slice)
}

impl<const C: usize> Written<C> {
    /// The bits of sample `i`, of a ray with as many samples as the others.
    fn bits(&self, i: usize) -> Vec<u32> {
        let ray = i / (self.t.len() / self.radiances[0].len());
        let of_sample = [&self.t, &self.pdf, &self.r, &self.pdf_at_t, &self.cdf_at_t].into_iter();
        let of_sample = of_sample.chain(&self.weights).chain(&self.integrands).map(|column| column[i]);
        of_sample.chain(self.radiances.iter().map(|column| column[ray])).map(f32::to_bits).collect()
    }

    /// What there is of a grey medium too, of sample `i`.
    fn of_grey(&self, i: usize) -> [f32; 7] {
        let columns =
            [&self.t, &self.pdf, &self.r, &self.pdf_at_t, &self.cdf_at_t, &self.weights[0], &self.integrands[0]];
        columns.map(|column| column[i])
    }
}

/// What a call writes for each ray of a batch that holds it alone.
fn alone<const C: usize>(batch: &Batch<C>, sampler: &Sampler) -> Vec<Vec<u32>> {
    (0..batch.len()).map(|i| batch.written_of(sampler, i..i + 1).bits(0)).collect()
}

/// The distance from `x` to the next larger f32.
fn ulp(x: f64) -> f64 {
    scenes::ulp((x as f32).max(f32::MIN_POSITIVE))
}

/// A backend and threads of either kind.
fn roads() -> impl Iterator<Item = (Backend, Threads)> {
    let portable = Backend::available().find(|backend| backend.name() == "portable").unwrap();
    [(Backend::detect(), Threads::Pool), (Backend::detect(), Threads::Caller), (portable, Threads::Pool)].into_iter()
}

/// The largest errors, in the units of their bounds, and how many values were compared.
#[derive(Debug, Default)]
struct Worst([(f64, usize); 6]);

impl Worst {
    const NAMES: [&str; 6] = ["cdf", "cdf at t", "pdf", "integrand", "weight", "radiance"];

    fn hold(&mut self, which: usize, error: f64, bound: f64, place: &dyn Fn() -> String) {
        let name = Self::NAMES[which];
        assert!(error <= bound, "{name} is off by {error:e}, bound {bound:e}: {}", place());
        let (worst, count) = &mut self.0[which];
        (*worst, *count) = (worst.max(error / bound), *count + 1);
    }
}

/// The errors of a sample in all channels, each with its bound; those of densities and weights count by the density over a
/// thousandth of its mean, as the promises do.
fn hold<const C: usize>(worst: &mut Worst, sampler: &Sampler, case: &Case, u: f32, written: &Written<C>, i: usize) {
    let (strategy, scene) = (sampler.strategy(), Coloured::new(&case.ray, &case.emitter, &case.medium));
    let place = || format!("{strategy} on {}, {case:?}, u {u}, seed {SEED}", sampler.backend().name());
    let Some((t_a, t_b)) = scene.mean().lit() else {
        assert!(written.bits(i).iter().all(|&bits| bits == 0), "{}", place());
        return;
    };
    let (t, interval) = (f64::from(written.t[i]), scene.mean().interval());
    let (t_a, t_b) = if strategy == Strategy::Transmittance { interval } else { (t_a, t_b) };
    let near = [written.t[i].next_down().into(), written.t[i].next_up().into()];
    let [low, high] = near.map(|t| scene.cdf(strategy, t));
    worst.hold(0, (low - f64::from(u)).max(f64::from(u) - high).max(0.0), 1.0 / f64::from(1 << 20), &place);
    let error = (f64::from(written.cdf_at_t[i]) - scene.cdf(strategy, t)).abs();
    worst.hold(1, error, 1.0 / f64::from(1 << 20), &place);
    let pdf = scene.pdf(strategy, t);
    let least = 1e-3 / (t_b - t_a);
    if (t_a..=t_b).contains(&t) {
        worst.hold(2, (f64::from(written.pdf_at_t[i]) - pdf).abs() / ulp(pdf.max(least)), 128.0, &place);
    }
    let radiances = scene.radiance();
    for (c, channel) in scene.channels().iter().enumerate() {
        let [weight, f] = [&written.weights, &written.integrands].map(|of| f64::from(of[c][i]));
        if case.medium.channel(c).unwrap().mu_s() == 0.0 {
            assert_eq!((weight, f, written.radiances[c][i]), (0.0, 0.0, 0.0), "{}", place());
            continue;
        }
        let depth = channel.mu_t() * (t - interval.0 + channel.r(t));
        let exact = channel.integrand(t);
        if depth < 30.0 && exact > 1e-30 && channel.cosine(t) > 1e-3 {
            worst.hold(3, (f - exact).abs() / ulp(exact), 48.0, &place);
            let at = |t: f64| channel.integrand(t) / scene.pdf(strategy, t);
            let moved = near.map(|near| (at(near) / at(t) - 1.0).abs()).into_iter().fold(0.0, f64::max);
            let share = (pdf / least).min(1.0);
            if moved.is_finite() {
                worst.hold(4, share * ((weight / at(t) - 1.0).abs() - moved), 2e-5, &place);
            }
        }
        if radiances[c] > 1e-30 {
            worst.hold(5, (f64::from(written.radiances[c][i]) / radiances[c] - 1.0).abs(), 3e-4, &place);
        }
    }
}

fn hold_to_the_oracle<const C: usize>(n: usize) {
    let batch = Batch::<C>::random(n);
    for (backend, threads) in roads() {
        let mut worst = Worst::default();
        for &strategy in Strategy::ALL {
            let sampler = Sampler::new(strategy).with_backend(backend).with_threads(threads);
            let written = batch.written(&sampler);
            for (i, (case, &u)) in batch.cases.iter().zip(batch.columns.given()).enumerate() {
                hold(&mut worst, &sampler, case, u, &written, i);
            }
        }
        for (name, (worst, count)) in Worst::NAMES.iter().zip(worst.0) {
            println!("{C} channels on {}, {threads:?}: {name} {worst:.3} of its bound, {count} values", backend.name());
            assert!(count > n, "{name}");
        }
    }
}

#[test]
fn every_channel_is_that_of_the_oracle() {
    hold_to_the_oracle::<3>(1000);
    hold_to_the_oracle::<4>(500);
}

/// Of the densities of the mean to the bit. A mixture is three times the grey density over 3, and the set-up rounds otherwise:
/// the same distance has a pdf within 16 ulp, or of a thousandth of its mean, and a cdf within 2^-21.
#[test]
fn equal_channels_are_the_grey_medium() {
    let grey = Batch::<1>::random(4000);
    let three = Batch::<3>::new(grey.cases.iter().zip(grey.columns.given()).map(|(case, &u)| {
        let (mu_a, mu_s) = (case.medium.mu_a(), case.medium.mu_s());
        (Case { medium: Medium::coloured([mu_a; 3], [mu_s; 3], case.medium.g()).unwrap(), ..*case }, u)
    }));
    let n = grey.len();
    let (rays, emitters) = (grey.columns.rays(0..n), grey.columns.emitters(0..n));
    for (backend, threads) in roads() {
        for &strategy in Strategy::ALL {
            let sampler = Sampler::new(strategy).with_backend(backend).with_threads(threads);
            let (one, three_drawn) = (grey.written(&sampler), three.written(&sampler));
            let place = format!("{strategy} on {}, {threads:?}, seed {SEED}", backend.name());
            for c in 0..3 {
                let of_first = |columns: &[Vec<f32>; 3]| columns[c] == columns[0];
                assert!(of_first(&three_drawn.weights) && of_first(&three_drawn.integrands), "{place}");
                assert_eq!(three_drawn.radiances[c], one.radiances[0], "{place}");
            }
            if !matches!(strategy, Strategy::Product5 | Strategy::Product9) {
                assert!((0..n).all(|i| three_drawn.of_grey(i) == one.of_grey(i)), "{place}");
                continue;
            }
            let (mut pdf, mut cdf) = (vec![f32::NAN; n], vec![f32::NAN; n]);
            sampler.pdf(&rays, &emitters, &three.media(0..n), &one.t, &mut pdf).unwrap();
            sampler.cdf(&rays, &emitters, &three.media(0..n), &one.t, &mut cdf).unwrap();
            let (mut pdf_error, mut cdf_error) = (0f64, 0f64);
            for i in 0..n {
                let lit = grey.cases[i].oracle().lit();
                let least = lit.map_or(0.0, |(t_a, t_b)| 1e-3 / (t_b - t_a));
                let expected = f64::from(one.pdf_at_t[i]);
                pdf_error = pdf_error.max((f64::from(pdf[i]) - expected).abs() / ulp(expected.max(least)));
                cdf_error = cdf_error.max((f64::from(cdf[i]) - f64::from(one.cdf_at_t[i])).abs());
            }
            println!("{place}: pdf {pdf_error:.1} ulp, cdf {cdf_error:.1e}");
            assert!(pdf_error <= 16.0 && cdf_error <= 1.0 / f64::from(1 << 21), "{place}: {pdf_error}, {cdf_error:e}");
        }
    }
}

/// To the bit: the others share a mixture without it.
#[test]
fn a_channel_that_does_not_scatter_is_0_and_disturbs_no_other() {
    let random = Batch::<3>::random(2000);
    // Where none of the others scatters it takes part in the density.
    let rows = random.cases.iter().copied().zip(random.columns.given().iter().copied());
    let three = Batch::<3>::new(rows.filter(|(case, _)| case.medium.mu_s() > 0.0));
    for dark in [0.0, 0.3, 1e6, f32::MAX] {
        let four = Batch::<4>::new(three.cases.iter().zip(three.columns.given()).map(|(case, &u)| {
            let [a_0, a_1, a_2] = [0, 1, 2].map(|c| case.medium.channel(c).unwrap().mu_a());
            let [s_0, s_1, s_2] = [0, 1, 2].map(|c| case.medium.channel(c).unwrap().mu_s());
            let medium = Medium::coloured([a_0, a_1, dark, a_2], [s_0, s_1, 0.0, s_2], case.medium.g());
            (Case { medium: medium.unwrap(), ..*case }, u)
        }));
        for &strategy in Strategy::ALL {
            let sampler = Sampler::new(strategy);
            let (three, four) = (three.written(&sampler), four.written(&sampler));
            for of_dark in [&four.weights[2], &four.integrands[2], &four.radiances[2]] {
                assert!(of_dark.iter().all(|&x| x == 0.0), "{strategy}, mu_a {dark}");
            }
            let Written { t, pdf, r, weights, pdf_at_t, cdf_at_t, integrands, radiances, counts } = four;
            let [weights, integrands, radiances] = [weights, integrands, radiances].map(|[r, g, _, b]| [r, g, b]);
            let without = Written { t, pdf, r, weights, pdf_at_t, cdf_at_t, integrands, radiances, counts };
            assert_eq!(without, three, "{strategy}, mu_a {dark}");
        }
    }
}

/// One medium for all, columns of it and a table are the same; so are columns of many media and a table of these.
#[test]
fn one_for_all_columns_and_a_table_are_the_same() {
    let batch = Batch::<3>::random(333);
    let one = Batch::<3>::new(
        batch
            .cases
            .iter()
            .map(|case| Case { medium: batch.cases[2].medium, ..*case })
            .zip(batch.columns.given().to_vec()),
    );
    let of_rays: Vec<Medium> = batch.cases.iter().map(|case| case.medium).collect();
    // In another order, with what no ray has.
    let table: Vec<Medium> = of_rays.iter().rev().copied().chain([of_rays[0]]).collect();
    let index: Vec<u32> = (0..333).rev().collect();
    let (same, all) = ([of_rays[0], of_rays[2]], 0..333);
    for &strategy in Strategy::ALL {
        let sampler = Sampler::new(strategy);
        let expected = one.written(&sampler);
        for media in [Media::one(of_rays[2]), Media::table(&same, &[1; 333])] {
            let written = one.written_in(&sampler, all.clone(), &media, one.columns.given());
            assert_eq!(written, expected, "{strategy}: {media:?}, seed {SEED}");
        }
        let written = batch.written_in(&sampler, all.clone(), &Media::table(&table, &index), batch.columns.given());
        assert_eq!(written, batch.written(&sampler), "{strategy}: a table, seed {SEED}");
    }
}

#[test]
fn any_length_and_place_and_neighbours() {
    let batch = Batch::<3>::random(CHUNK + 75);
    for &strategy in Strategy::ALL {
        let sampler = Sampler::new(strategy);
        let alone = alone(&batch, &sampler);
        let around = CHUNK - 9..=CHUNK + 9;
        for range in (0..=33).chain(around).map(|n| 0..n).chain((0..17).map(|start| start..CHUNK + 75)) {
            let written = batch.written_of(&sampler, range.clone());
            for (i, expected) in range.clone().zip(&alone[range.clone()]) {
                assert_eq!(&written.bits(i - range.start), expected, "{strategy}: ray {i} of {range:?}, seed {SEED}");
            }
        }
        for (bad, value) in [(0, f32::NAN), (37, -1.0), (CHUNK, f32::INFINITY)] {
            for c in 0..3 {
                let mut spoilt = batch.clone();
                spoilt.mu_s[c][bad] = value;
                let written = spoilt.written(&sampler);
                for (i, expected) in alone.iter().enumerate() {
                    let zeros = vec![0; expected.len()];
                    let expected = if i == bad { &zeros } else { expected };
                    assert_eq!(&written.bits(i), expected, "{strategy}: {value} in {bad}, ray {i}, seed {SEED}");
                }
                assert_eq!(written.counts.map(|counts| counts.invalid), [1; 2], "{strategy}: {value} in {bad}");
            }
        }
    }
}

#[test]
fn any_number_of_threads() {
    let batch = Batch::<4>::random(11 * CHUNK + 7);
    for strategy in [Strategy::Product5, Strategy::Product9, Strategy::PointNormal] {
        let sampler = Sampler::new(strategy);
        let expected = batch.written(&sampler.with_threads(Threads::Caller));
        for n in [1, 2, 3] {
            let threads = Threads::AtMost(n.try_into().unwrap());
            assert_eq!(batch.written(&sampler.with_threads(threads)), expected, "{strategy} on {n}, seed {SEED}");
        }
    }
}

#[test]
fn several_variates_of_a_ray_are_those_of_one_each() {
    for (n, per_ray) in [(CHUNK + 3, 2), (1, 33), (5, 40), (37, 7), (1, 5000)] {
        let batch = Batch::<3>::random(n);
        let mut random = Random::new(SEED + 1);
        let u: Vec<f32> = (0..n * per_ray).map(|_| random.uniform()).collect();
        for &strategy in Strategy::ALL {
            let sampler = Sampler::new(strategy);
            let several = batch.written_in(&sampler, 0..n, &batch.media(0..n), &u);
            for k in 0..per_ray.min(40) {
                let turn: Vec<f32> = u.iter().skip(k).step_by(per_ray).copied().collect();
                let one = batch.written_in(&sampler, 0..n, &batch.media(0..n), &turn);
                for i in 0..n {
                    let (found, expected) = (several.bits(i * per_ray + k), one.bits(i));
                    assert_eq!(found, expected, "{strategy}: variate {k} of {per_ray} of ray {i} of {n}, seed {SEED}");
                }
            }
        }
    }
}

/// One by one: the distances of the channels, and the weight, the integrand and the radiance of the mean.
#[test]
fn one_ray_has_the_light_of_the_mean() {
    let batch = Batch::<3>::random(500);
    for &strategy in Strategy::ALL {
        let sampler = Sampler::new(strategy);
        let written = batch.written(&sampler);
        for (i, Case { ray, emitter, medium }) in batch.cases.iter().enumerate() {
            let (place, mean) = (format!("{strategy}: {medium:?}, ray {i}, seed {SEED}"), medium.mean());
            let sample = sampler.sample_one(ray, emitter, medium, batch.columns.given()[i]);
            let (t, pdf) = sample.map_or((0.0, 0.0), |sample| (sample.t, sample.pdf));
            assert_eq!((t, pdf), (written.t[i], written.pdf[i]), "{place}");
            assert_eq!(sampler.pdf_one(ray, emitter, medium, t), written.pdf_at_t[i], "{place}");
            assert_eq!(sampler.cdf_one(ray, emitter, medium, t), written.cdf_at_t[i], "{place}");
            let f = sampler.evaluate_one(ray, emitter, medium, t);
            assert_eq!(f, sampler.evaluate_one(ray, emitter, &mean, t), "{place}");
            let integral = Integral::new(NODES);
            let radiance = integral.radiance_one(ray, emitter, medium);
            assert_eq!(radiance, integral.radiance_one(ray, emitter, &mean), "{place}");
            let Some(sample) = sample else { continue };
            // `f` is that at `t` as rounded.
            let expected = f64::from(f) / f64::from(written.pdf_at_t[i]);
            let near = f > 1e-30 && written.pdf_at_t[i] > 1e-5;
            let error = (f64::from(sample.weight) / expected - 1.0).abs();
            assert!(!near || error < 1e-3, "{place}: {} is not {expected:e}", sample.weight);
        }
    }
}
