//! The choice of an emitter: its probability is that emitter's share of the light, choices come as often as that says, and
//! they depend on nothing but the ray, the table and the variate.

mod scenes;

use airlight::{
    Backend, Counts, Emitter, Emitters, Error, Integral, Media, Medium, Nodes, Precision, Ray, Rays, Sampler, Samples,
    Strategy, Threads,
};
use scenes::{Case, Columns, Random};
use std::iter::repeat_n;
use std::num::NonZeroUsize;
use std::ops::Range;

/// Tables with fewer emitters than there are slots, as many, one more, and many more with a slot that is not full.
const TABLES: [usize; 6] = [1, 2, 32, 33, 64, 205];
/// Rays that a batch is cut into chunks of.
const CHUNK: usize = 4096;

/// Emitters of a middling room, and their weights; one of five is out.
struct Lights {
    table: Vec<Emitter>,
    weights: Vec<f32>,
}

impl Lights {
    fn new(random: &mut Random, n: usize) -> Self {
        let table = (0..n).map(|_| random.case_or_spot().emitter).collect();
        let weight = |i: usize| if n > 1 && i % 5 == 3 { 0.0 } else { random.between(0.1, 10.0) };
        Self { table, weights: (0..n).map(weight).collect() }
    }

    /// What each of them adds to the radiance of a ray.
    fn shares(&self, integral: &Integral, case: &Case) -> Vec<f64> {
        let lights = self.table.iter().zip(&self.weights);
        lights.map(|(light, w)| (w * integral.radiance_one(&case.ray, light, &case.medium)).into()).collect()
    }

    fn choose(&self, integral: &Integral, columns: &Columns, range: Range<usize>) -> Chosen {
        let mut chosen = Chosen::new(range.len());
        let Chosen { index, probability, .. } = &mut chosen;
        let (rays, media, u) = (columns.rays(range.clone()), columns.media(range.clone()), &columns.given()[range]);
        chosen.counts = integral.choose(&rays, &self.table, &self.weights, &media, u, index, probability).unwrap();
        chosen
    }

    /// One ray with many variates.
    fn choose_often(&self, integral: &Integral, case: &Case, u: Vec<f32>) -> Chosen {
        let columns = Columns::repeat(case, u);
        self.choose(integral, &columns, 0..columns.len())
    }
}

/// What a call wrote, and what it returned.
struct Chosen {
    index: Vec<u32>,
    probability: Vec<f32>,
    counts: Counts,
}

impl Chosen {
    /// Outputs that hold what no call writes.
    fn new(n: usize) -> Self {
        Self { index: vec![u32::MAX; n], probability: vec![f32::NAN; n], counts: Counts::default() }
    }

    fn bits(&self) -> Vec<[u32; 2]> {
        self.index.iter().zip(&self.probability).map(|(index, p)| [*index, p.to_bits()]).collect()
    }
}

/// The probability is the share to rounding: so the probabilities add up to 1. Emitters without a share are not chosen.
#[test]
fn a_probability_is_the_share_of_the_light_and_all_add_up_to_1() {
    const SEED: u64 = 21;
    let mut random = Random::new(SEED);
    for (n, precision) in TABLES.into_iter().flat_map(|n| Precision::ALL.iter().map(move |&p| (n, p))) {
        let integral = Integral::new(Nodes::Four).with_precision(precision);
        let lights = Lights::new(&mut random, n);
        for _ in 0..40 {
            let case = random.case();
            let shares = lights.shares(&integral, &case);
            let total: f64 = shares.iter().sum();
            if total == 0.0 {
                continue;
            }
            let mut before = 0.0;
            let middle = |share: &f64| {
                before += share;
                ((before - 0.5 * share) / total) as f32
            };
            let chosen = lights.choose_often(&integral, &case, shares.iter().map(middle).collect());
            let mut sum = 0.0;
            for (i, share) in shares.iter().enumerate() {
                let expected = share / total;
                let of = || format!("emitter {i} of {n}, {precision}, seed {SEED}, {case:?}");
                // The variate of a smaller one may be rounded to its neighbour's.
                if expected < 1e-6 {
                    sum += expected;
                    continue;
                }
                let p = f64::from(chosen.probability[i]);
                assert_eq!(chosen.index[i], i as u32, "{}", of());
                assert!((p / expected - 1.0).abs() < 2.5e-7, "{p}, expected {expected}: {}", of());
                sum += p;
            }
            assert!((sum - 1.0).abs() < 2e-7, "the sum is {sum}: {n} emitters, seed {SEED}, {case:?}");
        }
    }
}

#[test]
fn choices_are_as_frequent_as_their_probabilities_say() {
    const SEED: u64 = 22;
    const DRAWS: usize = 1 << 17;
    let mut random = Random::new(SEED);
    let integral = Integral::new(Nodes::Four);
    for n in [5, 32, 100] {
        let lights = Lights::new(&mut random, n);
        for _ in 0..4 {
            let case = random.case();
            let shares = lights.shares(&integral, &case);
            let total: f64 = shares.iter().sum();
            let chosen = lights.choose_often(&integral, &case, (0..DRAWS).map(|_| random.uniform()).collect());
            let mut hits = vec![0usize; n];
            chosen.index.iter().for_each(|&index| hits[index as usize] += 1);
            // Cells of at least 10 expected choices; the rest is one more.
            let (mut chi2, mut cells, mut rest) = (0.0, 0, (0.0, 0.0));
            for (share, hits) in shares.iter().zip(hits) {
                let expected = DRAWS as f64 * share / total;
                assert!(*share > 0.0 || hits == 0, "an emitter without a share was chosen: seed {SEED}, {case:?}");
                if expected < 10.0 {
                    rest = (rest.0 + expected, rest.1 + hits as f64);
                } else {
                    chi2 += (hits as f64 - expected).powi(2) / expected;
                    cells += 1;
                }
            }
            if rest.0 > 10.0 {
                chi2 += (rest.1 - rest.0).powi(2) / rest.0;
                cells += 1;
            }
            let freedom = (cells - 1) as f64;
            let limit = freedom + 5.0 * (2.0 * freedom).sqrt() + 10.0;
            assert!(chi2 < limit, "chi2 {chi2} with {freedom} degrees of freedom: {n} emitters, seed {SEED}, {case:?}");
        }
    }
}

#[test]
fn the_index_increases_with_the_variate() {
    const SEED: u64 = 23;
    let mut random = Random::new(SEED);
    for n in TABLES {
        let lights = Lights::new(&mut random, n);
        let case = random.case();
        let u = (0..=5000).map(|k| k as f32 / 5000.0).collect();
        let chosen = lights.choose_often(&Integral::new(Nodes::Six), &case, u);
        assert!(chosen.index.is_sorted(), "{n} emitters, seed {SEED}, {case:?}: {:?}", chosen.index);
        // Both ends as well have emitters with a share.
        assert!(chosen.probability.iter().all(|p| *p > 0.0), "{n} emitters, seed {SEED}, {case:?}");
    }
}

/// One light for each sample, and the sum over all of them.
#[test]
fn the_estimate_of_many_lights_is_the_sum_over_all() {
    const SEED: u64 = 24;
    const DRAWS: usize = 1 << 16;
    let mut random = Random::new(SEED);
    let sampler = Sampler::new(Strategy::Product5);
    for n in [3, 32, 100] {
        let lights = Lights::new(&mut random, n);
        for _ in 0..4 {
            let case = random.case();
            let expected: f64 = lights.shares(&Integral::new(Nodes::Twelve), &case).iter().sum();
            let columns = Columns::repeat(&case, (0..DRAWS).map(|_| random.uniform()).collect());
            let Chosen { index, probability, .. } =
                lights.choose(&Integral::new(Nodes::Four), &columns, 0..columns.len());
            let u: Vec<f32> = (0..DRAWS).map(|_| random.uniform()).collect();
            let [mut t, mut pdf, mut weight] = [(); 3].map(|()| vec![0.0; DRAWS]);
            let mut samples = Samples::new(&mut t, &mut pdf).weight(&mut weight);
            let (rays, media) = (columns.rays(0..DRAWS), columns.media(0..DRAWS));
            sampler.sample(&rays, &Emitters::table(&lights.table, &index), &media, &u, &mut samples).unwrap();
            let estimates = || {
                let of = |(w, (i, p)): (&f32, (&u32, &f32))| f64::from(lights.weights[*i as usize] * w) / f64::from(*p);
                weight.iter().zip(index.iter().zip(&probability)).map(of)
            };
            let mean = estimates().sum::<f64>() / DRAWS as f64;
            let variance = estimates().map(|x| (x - mean).powi(2)).sum::<f64>() / DRAWS as f64;
            let error = (variance / DRAWS as f64).sqrt();
            let off = (mean - expected).abs();
            assert!(off < 5.0 * error + 1e-5 * expected, "{mean} +- {error}, expected {expected}: {n}, seed {SEED}");
            // One light alone would be off by the others' shares.
            assert!(error < 0.02 * expected, "{mean} +- {error}: {n}, seed {SEED}");
        }
    }
}

/// A lamp above the ray, one that turns away from it, and a weight of 0.
#[test]
fn a_ray_that_nothing_lights_is_empty_and_a_bad_one_invalid() {
    let (lamp, away) = ([0.0, 1.0, 3.0], [0.0, 1.0, 0.0]);
    let away = Emitter::point_normal(lamp, away).unwrap();
    let lamp = Emitter::point(lamp).unwrap();
    let medium = Medium::new(0.1, 0.2, 0.5).unwrap();
    let ray = |t_max| Ray::new([0.0; 3], [0.0, 0.0, 1.0], 0.0, t_max).unwrap();
    let choose = |table: &[Emitter], weights: &[f32], ray: Ray, medium: Medium, u: f32, mu_s: f32| {
        let mut columns = Columns::repeat(&Case { ray, emitter: lamp, medium }, vec![u; 3]);
        columns.0[Columns::index("media.mu_s")].fill(mu_s);
        let lights = Lights { table: table.to_vec(), weights: weights.to_vec() };
        let chosen = lights.choose(&Integral::new(Nodes::Four), &columns, 0..3);
        let Counts { sampled, empty, invalid, bisected, .. } = chosen.counts;
        assert_eq!((sampled + empty + invalid, bisected), (3, 0));
        ([sampled, empty, invalid], chosen.index[0], chosen.probability[0])
    };
    let many: Vec<Emitter> = repeat_n(away, 50).chain([lamp]).chain(repeat_n(away, 20)).collect();
    let ones = vec![1.0; many.len()];
    for u in [0.0, 0.3, 1.0] {
        assert_eq!(choose(&[away, lamp, away], &[1.0; 3], ray(9.0), medium, u, 0.2), ([3, 0, 0], 1, 1.0));
        assert_eq!(choose(&many, &ones, ray(9.0), medium, u, 0.2), ([3, 0, 0], 50, 1.0));
    }
    let empty = ([0, 3, 0], 0, 0.0);
    assert_eq!(choose(&[away, away], &[1.0; 2], ray(9.0), medium, 0.5, 0.2), empty);
    assert_eq!(choose(&[away, lamp], &[1.0, 0.0], ray(9.0), medium, 0.5, 0.2), empty);
    assert_eq!(choose(&[lamp], &[1.0], ray(0.0), medium, 0.5, 0.2), empty);
    assert_eq!(choose(&[lamp], &[1.0], ray(9.0), medium, 0.5, 0.0), empty);
    assert_eq!(choose(&many, &vec![0.0; many.len()], ray(9.0), medium, 0.5, 0.2), empty);
    let invalid = ([0, 0, 3], 0, 0.0);
    for u in [f32::NAN, -f32::from_bits(1), 1f32.next_up(), f32::INFINITY] {
        assert_eq!(choose(&[away, lamp], &[1.0; 2], ray(9.0), medium, u, 0.2), invalid);
        assert_eq!(choose(&many, &ones, ray(9.0), medium, u, 0.2), invalid);
    }
    assert_eq!(choose(&[away, lamp], &[1.0; 2], ray(9.0), medium, 0.5, f32::NAN), invalid);
    assert_eq!(choose(&many, &ones, ray(9.0), medium, 0.5, -1.0), invalid);
}

/// Sums of the largest shares and weights are finite, and those of the smallest are no division by 0.
#[test]
fn shares_at_the_ends_of_f32_have_probabilities() {
    let near = Emitter::point([0.0, 1e-12, 3.0]).unwrap();
    let case = Case {
        ray: Ray::new([0.0; 3], [0.0, 0.0, 1.0], 0.0, 9.0).unwrap(),
        emitter: near,
        medium: Medium::new(0.0, 1.0, 0.0).unwrap(),
    };
    for (n, weight) in [(3, f32::MAX), (40, f32::MAX), (3, 1e-38), (40, f32::from_bits(1))] {
        let lights = Lights { table: vec![near; n], weights: vec![weight; n] };
        let chosen = lights.choose_often(&Integral::new(Nodes::Four), &case, vec![0.0, 0.25, 0.5, 1.0]);
        assert_eq!((chosen.counts.sampled, chosen.index[0], chosen.index[3]), (4, 0, n as u32 - 1));
        let expected = 1.0 / n as f32;
        assert!(chosen.probability.iter().all(|p| (p / expected - 1.0).abs() < 1e-6), "{:?}", chosen.probability);
    }
    // The first one's share is nothing to the second one's, and u = 0 has it all the same.
    let lights = Lights { table: vec![near; 2], weights: vec![f32::from_bits(1), 1e30] };
    let chosen = lights.choose_often(&Integral::new(Nodes::Four), &case, vec![0.0, 1e-9]);
    assert_eq!(chosen.index, [0, 1]);
    assert!(chosen.probability[0] > 0.0);
}

#[test]
fn a_coloured_medium_chooses_as_its_mean_does() {
    const N: usize = 40;
    let columns = Columns::random(&mut Random::new(2), N);
    let rays = columns.rays(0..N);
    let coloured = Medium::coloured([0.1, 0.2, 0.0], [0.2, 0.3, 0.9], 0.3).unwrap();
    let table = [Emitter::point([0.0; 3]).unwrap(), Emitter::point([1.0, 2.0, 3.0]).unwrap()];
    let [of_colour, of_mean] = [coloured, coloured.mean()].map(|medium| {
        let (mut index, mut probability) = (vec![7; N], vec![7.0; N]);
        let (integral, media) = (Integral::new(Nodes::Four), Media::one(medium));
        integral.choose(&rays, &table, &[1.0, 2.0], &media, &[0.4; N], &mut index, &mut probability).unwrap();
        (index, probability)
    });
    assert_eq!(of_colour, of_mean);
    assert!(of_mean.0.contains(&0) && of_mean.0.contains(&1));
}

#[test]
fn malformed_calls_are_refused_by_name() {
    const N: usize = 5;
    let columns = Columns::random(&mut Random::new(1), N);
    let (rays, media) = (columns.rays(0..N), columns.media(0..N));
    let lamp = Emitter::point([0.0; 3]).unwrap();
    let coloured = Medium::coloured([0.1; 3], [0.2, 0.3, 0.4], 0.0).unwrap();
    let mixed = [coloured.mean(), coloured];
    let choose = |rays: &Rays<'_>, table: &[Emitter], weights: &[f32], media: &Media<'_>, n: [usize; 3]| {
        let (mut index, mut probability) = (vec![7; n[1]], vec![7.0; n[2]]);
        let u = vec![0.5; n[0]];
        let result = Integral::new(Nodes::Four).choose(rays, table, weights, media, &u, &mut index, &mut probability);
        assert!(index.iter().all(|i| *i == 7) && probability.iter().all(|p| *p == 7.0), "something was written");
        result.unwrap_err().to_string()
    };
    let tables: [(&[Emitter], &[f32], &str); 7] = [
        (&[], &[], "table is empty"),
        (&[], &[1.0], "table is empty"),
        (&[lamp; 2], &[1.0], "weights has 1 elements, expected 2"),
        (&[lamp; 2], &[1.0; 3], "weights has 3 elements, expected 2"),
        (&[lamp; 2], &[1.0, -0.5], "weights is -0.5, expected finite values >= 0"),
        (&[lamp; 2], &[f32::NAN, 1.0], "weights is NaN, expected finite values >= 0"),
        (&[lamp; 2], &[f32::INFINITY, 1.0], "weights is inf, expected finite values >= 0"),
    ];
    for (table, weights, expected) in tables {
        assert_eq!(choose(&rays, table, weights, &media, [N; 3]), expected);
    }
    let of = |n| choose(&rays, &[lamp], &[1.0], &media, n);
    assert_eq!(of([N - 1, N, N]), "u has 4 elements, expected 5");
    assert_eq!(of([2 * N, N, N]), "u has 10 elements, expected 5");
    assert_eq!(of([N, N + 1, N]), "index has 6 elements, expected 5");
    assert_eq!(of([N, N, 0]), "probability has 0 elements, expected 5");
    let of_rays = Media::table(&mixed, &[0; N]);
    let refused = "media.table[0] has 1 channel, expected 3";
    assert_eq!(choose(&rays, &[lamp], &[1.0], &of_rays, [N; 3]), refused);
    let short = columns.rays(0..N - 1);
    assert_eq!(choose(&short, &[lamp], &[1.0], &media, [N; 3]), "media.mu_a has 5 elements, expected 4");
    let weight = Integral::new(Nodes::Four).choose(&rays, &[lamp], &[-1.0], &media, &[], &mut [], &mut []);
    assert!(matches!(weight, Err(Error::Value { field: "weights", value: -1.0, .. })), "{weight:?}");
}

/// No bit depends on the length of the batch, the place in it, the backend's width or the threads.
#[test]
fn any_length_place_backend_and_threads() {
    const SEED: u64 = 25;
    const RAYS: usize = 2 * CHUNK + 9;
    let mut random = Random::new(SEED);
    let mut columns = Columns::random(&mut random, RAYS);
    for i in (0..RAYS).step_by(97) {
        columns.0[Columns::index(["rays.t_max", "media.g", "u"][i % 3])][i] = f32::NAN;
    }
    for n in [3, 70] {
        let lights = Lights::new(&mut random, n);
        let fused: Vec<Backend> = Backend::available().filter(|backend| backend.is_fused()).collect();
        let of_first = lights.choose(&Integral::new(Nodes::Four).with_backend(fused[0]), &columns, 0..RAYS).bits();
        for backend in Backend::available() {
            let integral = Integral::new(Nodes::Four).with_backend(backend);
            let all = lights.choose(&integral, &columns, 0..RAYS);
            let (bits, counts) = (all.bits(), all.counts);
            assert_eq!(counts.invalid, RAYS.div_ceil(97), "{counts:?}");
            assert_eq!(counts.sampled, all.probability.iter().filter(|p| **p > 0.0).count());
            assert!(!backend.is_fused() || bits == of_first, "{backend:?} and {:?}, seed {SEED}", fused[0]);
            let hold = |integral: &Integral, range: Range<usize>| {
                let found = lights.choose(integral, &columns, range.clone());
                assert_eq!(found.bits(), bits[range.clone()], "{range:?}, {n} emitters, {backend:?}, seed {SEED}");
                found.counts
            };
            for rays in (1..=70).chain([CHUNK - 1, CHUNK, CHUNK + 1, CHUNK + 17]) {
                hold(&integral, 0..rays);
            }
            for start in 1..40 {
                hold(&integral, start..100);
                hold(&integral, start..start + 1);
            }
            for threads in [1, 2, 3] {
                let threads = Threads::AtMost(NonZeroUsize::new(threads).unwrap());
                assert_eq!(hold(&integral.with_threads(threads), 0..RAYS), counts, "{threads:?}");
            }
        }
    }
}
