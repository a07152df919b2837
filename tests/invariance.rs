//! What is written for a ray depends on that ray alone, to the bit: not on where it stands, on how long the batch is, on
//! where its columns lie in memory, on how many threads there are, or on what is wrong with its neighbours.

mod scenes;

use airlight::{Emitters, Media, Sampler, Samples, Strategy};
use scenes::{Columns, Drawn, Random};
use std::ops::Range;

const SEED: u64 = 4;

/// Rays that a batch is cut into chunks of.
const CHUNK: usize = 4096;

/// What a call writes for each ray of a batch that holds it alone.
fn alone(columns: &Columns, sampler: &Sampler) -> Vec<[u32; 4]> {
    (0..columns.len()).map(|i| columns.sample_range(sampler, i..i + 1).bits(0)).collect()
}

/// Asserts that ray `i` of what was drawn has the bits `expected(i)`.
fn assert_same<'a>(drawn: &Drawn, expected: impl Fn(usize) -> &'a [u32; 4], place: &str) {
    for i in 0..drawn.t.len() {
        let (value, expected) = (drawn.bits(i), expected(i));
        assert_eq!(value, *expected, "ray {i} is {:?}, {place}, seed {SEED}", drawn.row(i));
    }
}

/// `n` random cases, without spots and with, and the bits of each alone, per strategy. Alone, what has no cone is in columns
/// without cones.
fn for_each_strategy(n: usize, test: impl Fn(&Sampler, &Columns, &[[u32; 4]])) {
    for draw in [Columns::random, Columns::with_spots] {
        let columns = draw(&mut Random::new(SEED), n);
        for &strategy in Strategy::ALL {
            let sampler = Sampler::new(strategy);
            test(&sampler, &columns, &alone(&columns, &sampler));
        }
    }
}

#[test]
fn any_length() {
    for_each_strategy(2 * CHUNK + 9, |sampler, columns, alone| {
        let around = |n: usize| n - 9..=n + 9;
        for n in (0..=33).chain(around(CHUNK)).chain(around(2 * CHUNK)) {
            let drawn = columns.sample_range(sampler, 0..n);
            assert_same(&drawn, |i| &alone[i], &format!("{} of {n}", sampler.strategy()));
            assert_eq!(drawn.counts.sampled + drawn.counts.empty, n);
        }
    });
}

#[test]
fn any_place_in_the_batch() {
    for_each_strategy(100, |sampler, columns, alone| {
        for start in 0..17 {
            let drawn = columns.sample_range(sampler, start..columns.len());
            assert_same(&drawn, |i| &alone[start + i], &format!("{} from {start} on", sampler.strategy()));
        }
    });
    for_each_strategy(2 * CHUNK + 1, |sampler, columns, alone| {
        let mut random = Random::new(SEED + 1);
        let mut order: Vec<usize> = (0..columns.len()).collect();
        (1..order.len()).for_each(|i| order.swap(i, random.below(i + 1)));
        let drawn = columns.gather(&order).sample(sampler);
        assert_same(&drawn, |i| &alone[order[i]], &format!("{} shuffled", sampler.strategy()));
    });
}

#[test]
fn any_split() {
    for_each_strategy(3 * CHUNK + 5, |sampler, columns, alone| {
        let mut random = Random::new(SEED + 2);
        for longest in [3, 50, CHUNK, 2 * CHUNK] {
            let mut start = 0;
            while start < columns.len() {
                let end = columns.len().min(start + 1 + random.below(longest));
                let drawn = columns.sample_range(sampler, start..end);
                assert_same(&drawn, |i| &alone[start + i], &format!("{} from {start} to {end}", sampler.strategy()));
                start = end;
            }
        }
    });
}

#[cfg(feature = "rayon")]
#[test]
fn any_number_of_threads() {
    let pool = |n: usize| rayon::ThreadPoolBuilder::new().num_threads(n).build().unwrap();
    for_each_strategy(11 * CHUNK + 7, |sampler, columns, alone| {
        let one = pool(1).install(|| columns.sample(sampler));
        assert_same(&one, |i| &alone[i], &format!("{} on one thread", sampler.strategy()));
        for n in [2, 3] {
            let many = pool(n).install(|| columns.sample(sampler));
            assert_same(&many, |i| &alone[i], &format!("{} on {n} threads", sampler.strategy()));
            assert_eq!(one.counts, many.counts);
        }
    });
}

/// The columns moved by some elements, and outputs in the middle of what must stay as it is.
#[test]
fn any_alignment_and_nothing_beside_it() {
    const CANARY: u32 = 0x7fc0_aa55;
    let canaries = |n: usize| vec![f32::from_bits(CANARY); n];
    for_each_strategy(75, |sampler, columns, alone| {
        for offset in 0..8 {
            // Every column has an offset of its own.
            let shift = |k: usize| (offset + k) % 8;
            let moved: Vec<Vec<f32>> =
                columns.0.iter().enumerate().map(|(k, column)| [&canaries(shift(k)), &column[..]].concat()).collect();
            for n in [1, 7, 8, 9, 31, 75] {
                let column = |k: usize| &moved[k][shift(k)..shift(k) + n];
                let three = |k: usize| [column(k), column(k + 1), column(k + 2)];
                let rays = airlight::Rays::new(three(0), three(3), column(6), column(7));
                let emitters = Emitters::each(three(8), three(11));
                let [cos_outer, cos_inner] = Columns::CONES.map(column);
                let with_cones = Emitters::each_spot(three(8), three(11), cos_outer, cos_inner);
                let has_spots = columns.0[Columns::CONES[0]].iter().any(|cosine| *cosine != -1.0);
                let emitters = if has_spots { with_cones } else { emitters };
                let media = Media::each(column(14), column(15), column(16));
                let mut written: [Vec<f32>; 4] = std::array::from_fn(|_| canaries(n + 32));
                let inside = |k: usize| -> Range<usize> { 8 + shift(k)..8 + shift(k) + n };
                let [t, pdf, weight, r] = &mut written;
                let mut samples = Samples::new(&mut t[inside(0)], &mut pdf[inside(1)])
                    .weight(&mut weight[inside(2)])
                    .r(&mut r[inside(3)]);
                sampler.sample(&rays, &emitters, &media, column(Columns::GIVEN), &mut samples).unwrap();
                for (k, column) in written.iter().enumerate() {
                    for (i, value) in column.iter().enumerate() {
                        let expected = if inside(k).contains(&i) { alone[i - inside(k).start][k] } else { CANARY };
                        let place = || format!("column {k}, {i} of {n}, offset {offset}, {}", sampler.strategy());
                        assert_eq!(value.to_bits(), expected, "{value} in {}", place());
                    }
                }
            }
        }
    });
}

/// A task that writes less writes the same.
#[test]
fn any_choice_of_outputs() {
    for_each_strategy(77, |sampler, columns, alone| {
        let n = columns.len();
        let (rays, emitters, media) = (columns.rays(0..n), columns.emitters(0..n), columns.media(0..n));
        for (with_weight, with_r) in [(false, false), (true, false), (false, true)] {
            let mut drawn = Drawn::new(n);
            let mut samples = drawn.samples();
            samples.weights[0] = samples.weights[0].take().filter(|_| with_weight);
            samples.r = samples.r.filter(|_| with_r);
            sampler.sample(&rays, &emitters, &media, columns.given(), &mut samples).unwrap();
            for (i, expected) in alone.iter().enumerate() {
                let mut bits = drawn.bits(i);
                for (k, written) in [(2, with_weight), (3, with_r)] {
                    if !written {
                        assert!(drawn.row(i)[k].is_nan(), "column {k} was written");
                        bits[k] = expected[k];
                    }
                }
                assert_eq!(bits, *expected, "ray {i}, {}", sampler.strategy());
            }
        }
    });
}

#[test]
fn one_for_all_is_the_same_for_each() {
    let mut random = Random::new(SEED + 3);
    for &strategy in Strategy::ALL {
        let sampler = Sampler::new(strategy);
        for _ in 0..32 {
            let one = random.case_or_spot();
            let n = 100;
            let columns = Columns::new((0..n).map(|_| {
                let case = random.case();
                (scenes::Case { ray: case.ray, ..one }, random.uniform())
            }));
            let each = columns.sample(&sampler);
            let bits: Vec<[u32; 4]> = (0..n).map(|i| each.bits(i)).collect();
            let both = [(Some(one.emitter), None), (None, Some(one.medium)), (Some(one.emitter), Some(one.medium))];
            for (emitter, medium) in both {
                let emitters = emitter.map_or(columns.emitters(0..n), Emitters::one);
                let media = medium.map_or(columns.media(0..n), Media::one);
                let mut drawn = Drawn::new(n);
                let samples = &mut drawn.samples();
                let counts = sampler.sample(&columns.rays(0..n), &emitters, &media, columns.given(), samples).unwrap();
                assert_eq!(counts, each.counts);
                assert_same(&drawn, |i| &bits[i], &format!("{strategy}, {one:?}"));
            }
        }
    }
}

/// A bad value in each field at each place of a lane group.
#[test]
fn any_neighbour() {
    for_each_strategy(43, |sampler, columns, alone| {
        for bad in 0..columns.len() {
            for (field, name) in Columns::FIELDS.iter().enumerate() {
                for value in [f32::NAN, f32::INFINITY] {
                    if *name == "rays.t_max" && value.is_infinite() {
                        continue; // a ray without an end
                    }
                    let mut columns = columns.clone();
                    columns.0[field][bad] = value;
                    let drawn = columns.sample(sampler);
                    let expected = |i: usize| if i == bad { &[0; 4] } else { &alone[i] };
                    assert_same(&drawn, expected, &format!("{}, {name} of {bad} is {value}", sampler.strategy()));
                    assert_eq!(drawn.counts.invalid, 1, "{}, {name} of {bad} is {value}", sampler.strategy());
                }
            }
        }
    });
}

/// `pdf` and `evaluate` too.
#[test]
fn densities_and_integrands_depend_on_their_ray_alone() {
    for_each_strategy(2 * CHUNK + 3, |sampler, columns, _| {
        let columns = &mut columns.clone();
        columns.0[Columns::GIVEN].iter_mut().for_each(|t| *t *= 12.0);
        let (pdf, integrand) = (columns.pdf(sampler), columns.evaluate(sampler));
        for i in 0..columns.len() {
            let one = columns.gather(&[i]);
            assert_eq!(pdf[i].to_bits(), one.pdf(sampler)[0].to_bits(), "pdf of {i}, {}", sampler.strategy());
            assert_eq!(integrand[i].to_bits(), one.evaluate(sampler)[0].to_bits(), "integrand of {i}");
        }
    });
}
