//! A malformed call is refused with an error that names what is wrong; a bad ray is none, it is counted and gets zeros;
//! and whatever the bits of the input, nothing panics and nothing that is not a number comes out.

mod scenes;

use airlight::{
    Counts, Emitter, Error, FARTHEST, Integral, Media, Medium, Nodes, Ray, Sampler, Samples, Strategy, UNIT_TOLERANCE,
};
use airlight_tools::samplers;
use glam::Vec3;
use scenes::{Case, Columns, Drawn, Random, Row};

const SEED: u64 = 5;

/// What is no number between two finite ones.
const NO_NUMBER: [f32; 3] = [f32::NAN, f32::INFINITY, f32::NEG_INFINITY];

/// What is said of a column of another length.
fn length(field: &str, length: usize, expected: usize) -> String {
    format!("{field} has {length} elements, expected {expected}")
}

fn said(result: Result<Counts, Error>) -> Result<Counts, String> {
    result.map_err(|error| error.to_string())
}

#[test]
fn input_of_another_length_is_named() {
    const N: usize = 9;
    let all = Columns::random(&mut Random::new(SEED), N);
    let sampler = Sampler::new(Strategy::PointNormal);
    for (field, name) in Columns::FIELDS.into_iter().enumerate() {
        for other in [0, N - 1, N + 1] {
            let mut columns = all.clone();
            columns.0[field].resize(other, 0.0);
            // The first column has the length of the batch by definition. If it differs, the next that is looked at is wrong.
            let (name, len, n) = if field == 0 { ("rays.direction[0]", N, other) } else { (name, other, N) };
            let three = |k: usize| [k, k + 1, k + 2].map(|k| &columns.0[k][..]);
            let rays = airlight::Rays::new(three(0), three(3), &columns.0[6], &columns.0[7]);
            let [cos_outer, cos_inner] = Columns::CONES.map(|k| &columns.0[k][..]);
            let emitters = airlight::Emitters::each_spot(three(8), three(11), cos_outer, cos_inner);
            let [mu_a, mu_s, g] = three(14);
            let media = airlight::Media::each(mu_a, mu_s, g);

            let mut drawn = Drawn::new(n);
            let result = sampler.sample(&rays, &emitters, &media, columns.given(), &mut drawn.samples());
            assert_eq!(said(result), Err(length(name, len, n)));
            let untouched = |column: &[f32]| column.iter().all(|x| x.is_nan());
            assert!([&drawn.t, &drawn.pdf, &drawn.weight, &drawn.r].into_iter().all(|column| untouched(column)));

            let name = if name == "u" { "t" } else { name };
            let mut out = vec![f32::NAN; n];
            let result = sampler.pdf(&rays, &emitters, &media, columns.given(), &mut out);
            assert_eq!(said(result), Err(length(name, len, n)));
            let result = sampler.evaluate(&rays, &emitters, &media, columns.given(), &mut out);
            assert_eq!(said(result), Err(length(name, len, n)));
            assert!(untouched(&out));
        }
    }
}

#[test]
fn output_of_another_length_is_named() {
    const N: usize = 9;
    let columns = Columns::random(&mut Random::new(SEED), N);
    let (rays, emitters, media) = (columns.rays(0..N), columns.emitters(0..N), columns.media(0..N));
    let sampler = Sampler::new(Strategy::PointNormal);
    for other in [0, N - 1, N + 1] {
        for (k, name) in ["samples.t", "samples.pdf", "samples.weights[0]", "samples.r"].into_iter().enumerate() {
            let mut drawn = Drawn::new(N);
            let columns_out = [&mut drawn.t, &mut drawn.pdf, &mut drawn.weight, &mut drawn.r];
            columns_out.into_iter().nth(k).unwrap().resize(other, f32::NAN);
            let result = sampler.sample(&rays, &emitters, &media, columns.given(), &mut drawn.samples());
            assert_eq!(said(result), Err(length(name, other, N)));
            let written = [drawn.t, drawn.pdf, drawn.weight, drawn.r].concat();
            assert!(written.iter().all(|x| x.is_nan()), "something was written beside {name}");
        }
        let mut out = vec![f32::NAN; other];
        let result = sampler.pdf(&rays, &emitters, &media, columns.given(), &mut out);
        assert_eq!(said(result), Err(length("pdf", other, N)));
        let result = sampler.evaluate(&rays, &emitters, &media, columns.given(), &mut out);
        assert_eq!(said(result), Err(length("integrand", other, N)));
        assert!(out.iter().all(|x| x.is_nan()));
    }
}

#[test]
fn an_error_says_it_in_words() {
    assert_eq!(Medium::new(0.0, 1.0, 2.0).unwrap_err().to_string(), "g is 2, expected -1 <= g <= 1");
}

/// Asserts that a constructor refused `value` of `field`.
fn assert_refused<T: std::fmt::Debug>(result: Result<T, Error>, field: &str, value: f32) {
    match result {
        Err(Error::Value { field: named, value: said, .. }) => {
            assert_eq!(named, field);
            assert_eq!(said.to_bits(), value.to_bits(), "{field} is {value}, it says {said}");
        }
        other => panic!("{field} = {value} gives {other:?}"),
    }
}

/// The vector with one coordinate replaced.
fn with(v: Vec3, k: usize, value: f32) -> Vec3 {
    let mut v = v.to_array();
    v[k] = value;
    Vec3::from(v)
}

#[test]
fn parameters_out_of_range_are_refused() {
    let too_far = FARTHEST.next_up();
    for k in 0..3 {
        for value in NO_NUMBER.into_iter().chain([too_far, -too_far, f32::MAX]) {
            let far = with(Vec3::ONE, k, value);
            assert_refused(Ray::new(far, Vec3::X, 0.0, 1.0), "origin", value);
            assert_refused(Emitter::point(far), "position", value);
            assert_refused(Emitter::point_normal(far, Vec3::X), "position", value);
            assert_refused(Emitter::spot(far, Vec3::X, 0.5, 0.6), "position", value);
        }
        for value in NO_NUMBER {
            let bent = with(Vec3::ZERO, k, value);
            assert_refused(Ray::new(Vec3::ZERO, bent, 0.0, 1.0), "direction", bent.length());
            assert_refused(Emitter::point_normal(Vec3::ZERO, bent), "normal", bent.length());
            assert_refused(Emitter::spot(Vec3::ZERO, bent, 0.5, 0.6), "axis", bent.length());
        }
    }
    for length in [0.0, 1.0 - 1.01 * UNIT_TOLERANCE, 1.0 + 1.01 * UNIT_TOLERANCE, 2.0, 1e-30, 1e18] {
        let v = length * Vec3::Y;
        assert_refused(Ray::new(Vec3::ZERO, v, 0.0, 1.0), "direction", v.length());
        assert_refused(Emitter::point_normal(Vec3::ZERO, v), "normal", v.length());
        assert_refused(Emitter::spot(Vec3::ZERO, v, 0.5, 0.6), "axis", v.length());
    }
    let spot = |cos_outer: f32, cos_inner: f32| Emitter::spot(Vec3::ZERO, Vec3::X, cos_outer, cos_inner);
    for cosine in NO_NUMBER.into_iter().chain([-f32::from_bits(1), -1.0, 1f32.next_up()]) {
        assert_refused(spot(cosine, 1.0), "cos_outer", cosine);
        assert_refused(spot(0.0, cosine), "cos_inner", cosine);
    }
    assert_refused(spot(0.5, 0.5f32.next_down()), "cos_inner", 0.5f32.next_down());

    let ray = |t_min: f32, t_max: f32| Ray::new(Vec3::ZERO, Vec3::X, t_min, t_max);
    for t_min in NO_NUMBER.into_iter().chain([-1.0, -f32::from_bits(1), too_far]) {
        assert_refused(ray(t_min, f32::INFINITY), "t_min", t_min);
    }
    for t_max in [f32::NAN, f32::NEG_INFINITY, -1.0, 0.0, 1f32.next_down()] {
        assert_refused(ray(1.0, t_max), "t_max", t_max);
    }

    for mu in NO_NUMBER.into_iter().chain([-1.0, -f32::from_bits(1)]) {
        assert_refused(Medium::new(mu, 1.0, 0.0), "mu_a", mu);
        assert_refused(Medium::new(1.0, mu, 0.0), "mu_s", mu);
        for c in 0..3 {
            let with_mu = with(Vec3::ONE, c, mu).to_array();
            assert_refused(Medium::coloured(with_mu, [1.0; 3], 0.0), "mu_a", mu);
            assert_refused(Medium::coloured([1.0; 3], with_mu, 0.0), "mu_s", mu);
        }
    }
    assert_refused(Medium::coloured([], [], 0.0), "channels", 0.0);
    assert_refused(Medium::coloured([1.0; 2], [1.0; 2], 0.0), "channels", 2.0);
    assert_refused(Medium::coloured([1.0; 5], [1.0; 5], 0.0), "channels", 5.0);
    assert_refused(Medium::coloured([0.0, 0.0, f32::MAX], [0.0, 1.0, f32::MAX], 0.0), "mu_t", f32::INFINITY);
    assert_refused(Medium::new(f32::MAX, f32::MAX, 0.0), "mu_t", f32::INFINITY);
    for g in NO_NUMBER.into_iter().chain([1f32.next_up(), -1f32.next_up(), 2.0]) {
        assert_refused(Medium::new(1.0, 1.0, g), "g", g);
        assert_refused(Medium::coloured([1.0; 4], [1.0; 4], g), "g", g);
    }
}

#[test]
fn parameters_at_the_end_of_their_range_are_accepted() {
    for length in [1.0, 1.0 - 0.99 * UNIT_TOLERANCE, 1.0 + 0.99 * UNIT_TOLERANCE] {
        for (t_min, t_max) in [(0.0, 0.0), (-0.0, 1.0), (FARTHEST, f32::INFINITY), (0.0, f32::MAX)] {
            Ray::new(Vec3::splat(-FARTHEST), length * Vec3::Y, t_min, t_max).unwrap();
        }
        Emitter::point_normal(Vec3::splat(FARTHEST), length * Vec3::Z).unwrap();
        for (cos_outer, cos_inner) in [(0.0, 0.0), (0.0, 1.0), (-0.0, 0.5), (1.0, 1.0)] {
            Emitter::spot(Vec3::splat(FARTHEST), length * Vec3::Z, cos_outer, cos_inner).unwrap();
        }
    }
    for (mu_a, mu_s, g) in [(0.0, 0.0, -1.0), (f32::MAX, 0.0, 1.0), (-0.0, 0.5 * f32::MAX, -0.0)] {
        Medium::new(mu_a, mu_s, g).unwrap();
        Medium::coloured([mu_a; 4], [mu_s; 4], g).unwrap();
    }
}

/// Calls with so many columns of weights, integrands or radiances.
fn said_of_columns<const C: usize>(columns: &Columns, media: &Media<'_>) -> [Result<Counts, Error>; 3] {
    let (n, sampler, integral) = (columns.len(), Sampler::new(Strategy::Product5), Integral::new(Nodes::Eight));
    let (rays, emitters, given) = (columns.rays(0..n), columns.emitters(0..n), columns.given());
    let [mut weights, mut integrands, mut radiances] = [(); 3].map(|()| [(); C].map(|()| vec![f32::NAN; n]));
    let (mut t, mut pdf) = (vec![f32::NAN; n], vec![f32::NAN; n]);
    let mut samples = Samples::new(&mut t, &mut pdf).weights(weights.each_mut().map(Vec::as_mut_slice));
    let results = [
        sampler.sample(&rays, &emitters, media, given, &mut samples),
        sampler.evaluate_coloured(&rays, &emitters, media, given, integrands.each_mut().map(Vec::as_mut_slice)),
        integral.radiance_coloured(&rays, &emitters, media, radiances.each_mut().map(Vec::as_mut_slice)),
    ];
    for (result, columns) in results.iter().zip([&weights, &integrands, &radiances]) {
        let written = columns.iter().flatten().any(|x| !x.is_nan());
        assert_eq!(written, result.is_ok() && C > 0, "{result:?}");
    }
    results
}

/// Nothing takes a coloured medium for a grey one, or the reverse.
#[test]
fn another_number_of_columns_than_channels_is_named() {
    let columns = Columns::random(&mut Random::new(SEED), 9);
    let (rgb, four) = (rgb(), Medium::coloured([0.1; 4], [0.2, 0.3, 0.4, 0.5], 0.0).unwrap());
    let (table, index) = ([rgb; 2], [0; 9]);
    for (media, channels) in
        [(columns.media(0..9), 1), (Media::one(rgb), 3), (Media::table(&table, &index), 3), (Media::one(four), 4)]
    {
        for (columns, results) in [
            (1, said_of_columns::<1>(&columns, &media)),
            (2, said_of_columns::<2>(&columns, &media)),
            (3, said_of_columns::<3>(&columns, &media)),
            (4, said_of_columns::<4>(&columns, &media)),
        ] {
            for (result, name) in results.into_iter().zip(["samples.weights", "integrand", "radiance"]) {
                if columns == channels {
                    assert!(result.is_ok(), "{name}, {channels} channels: {result:?}");
                    continue;
                }
                let Err(Error::Channels { field, index, channels: found, expected, .. }) = result else {
                    panic!("{name}, {columns} columns for {channels} channels: {result:?}");
                };
                assert_eq!((field, index, found, expected), (name, None, columns, channels));
                let plural = if columns == 1 { "" } else { "s" };
                assert_eq!(said(result), Err(format!("{name} has {columns} channel{plural}, expected {channels}")));
            }
        }
        // Weights may be left out.
        assert!(said_of_columns::<0>(&columns, &media)[0].is_ok());
        // One column is what `evaluate` and `radiance` write.
        let (rays, emitters, mut out) = (columns.rays(0..9), columns.emitters(0..9), [f32::NAN; 9]);
        let expected = |name: &str| Err(format!("{name} has 1 channel, expected {channels}"));
        let evaluated = Sampler::new(Strategy::Product9).evaluate(&rays, &emitters, &media, columns.given(), &mut out);
        assert!(channels == 1 || said(evaluated) == expected("integrand"), "{evaluated:?}");
        let integrated = Integral::new(Nodes::Four).radiance(&rays, &emitters, &media, &mut out);
        assert!(channels == 1 || said(integrated) == expected("radiance"), "{integrated:?}");
    }
}

#[test]
fn a_number_of_channels_that_there_is_not_is_named() {
    fn said_of<const C: usize>(columns: &Columns) -> Result<Counts, Error> {
        let (n, mu) = (columns.len(), vec![0.1; columns.len()]);
        let media = Media::each_coloured([&mu; C], [&mu; C], &mu);
        let (rays, emitters, mut pdf) = (columns.rays(0..n), columns.emitters(0..n), vec![0.0; n]);
        Sampler::new(Strategy::EquiAngular).pdf(&rays, &emitters, &media, columns.given(), &mut pdf)
    }
    let columns = Columns::random(&mut Random::new(SEED), 9);
    for good in [said_of::<1>(&columns), said_of::<3>(&columns), said_of::<4>(&columns)] {
        assert!(good.is_ok(), "{good:?}");
    }
    for (channels, result) in
        [(0.0, said_of::<0>(&columns)), (2.0, said_of::<2>(&columns)), (5.0, said_of::<5>(&columns))]
    {
        assert_refused(result, "channels", channels);
        assert_eq!(said(result), Err(format!("channels is {channels}, expected 1, 3 or 4")));
    }
}

#[test]
fn channels_that_differ_in_a_table_are_named() {
    let columns = Columns::random(&mut Random::new(SEED), 9);
    let (rays, emitters, index, mut pdf) = (columns.rays(0..9), columns.emitters(0..9), [0; 9], [f32::NAN; 9]);
    let four = Medium::coloured([0.1; 4], [0.2; 4], 0.0).unwrap();
    for (table, entry, channels, expected) in [
        ([rgb(), rgb(), good().medium], 2, 1, 3),
        ([good().medium, rgb(), rgb()], 0, 1, 3),
        ([four, rgb(), four], 1, 3, 4),
    ] {
        let media = Media::table(&table, &index);
        let result = Sampler::new(Strategy::Product5).pdf(&rays, &emitters, &media, columns.given(), &mut pdf);
        let Err(Error::Channels { field, index, channels: found, expected: most, .. }) = result else {
            panic!("{table:?}: {result:?}");
        };
        assert_eq!((field, index, found, most), ("media.table", Some(entry), channels, expected));
        let plural = if channels == 1 { "" } else { "s" };
        let text = format!("media.table[{entry}] has {channels} channel{plural}, expected {expected}");
        assert_eq!(said(result), Err(text));
        assert!(pdf.iter().all(|pdf| pdf.is_nan()));
    }
}

/// A medium of three channels.
fn rgb() -> Medium {
    Medium::coloured([0.1, 0.2, 0.0], [0.3, 0.1, 1.0], 0.5).unwrap()
}

/// `mu_a` of three channels, then `mu_s`.
type Channels = [Vec<f32>; 6];

/// All that is written for a ray in three channels: `t`, `pdf`, `r`, weights; the density and the integrands at another
/// distance; radiances.
type Written = [u32; 13];

fn write(strategy: Strategy, columns: &Columns, channels: &Channels) -> (Vec<Written>, [Counts; 4]) {
    let n = columns.len();
    let mut out: [Vec<f32>; 13] = std::array::from_fn(|_| vec![f32::NAN; n]);
    let [t, pdf, r, w_0, w_1, w_2, p, f_0, f_1, f_2, l_0, l_1, l_2] = &mut out;
    let [a_0, a_1, a_2, s_0, s_1, s_2] = channels;
    let media = Media::each_coloured([a_0, a_1, a_2], [s_0, s_1, s_2], &columns.0[Columns::index("media.g")]);
    let (sampler, rays, emitters) = (Sampler::new(strategy), columns.rays(0..n), columns.emitters(0..n));
    let mut samples = Samples::new(t, pdf).r(r).weights([w_0, w_1, w_2]);
    let at = vec![2.0; n];
    let counts = [
        sampler.sample(&rays, &emitters, &media, columns.given(), &mut samples),
        sampler.pdf(&rays, &emitters, &media, &at, p),
        sampler.evaluate_coloured(&rays, &emitters, &media, &at, [f_0, f_1, f_2]),
        Integral::new(Nodes::Six).radiance_coloured(&rays, &emitters, &media, [l_0, l_1, l_2]),
    ];
    let rows = (0..n).map(|i| out.each_ref().map(|column| column[i].to_bits())).collect();
    (rows, counts.map(Result::unwrap))
}

/// A coefficient that is none makes its ray invalid, in any channel, and disturbs no neighbour.
#[test]
fn a_channel_that_is_none_is_counted_and_gets_zeros() {
    const N: usize = 19;
    const BAD: usize = 7;
    let columns = Columns::new((0..N).map(|_| (good(), 0.5)));
    let channels: Channels = std::array::from_fn(|k| (0..N).map(|i| 0.1 + 0.01 * (k * N + i) as f32).collect());
    for &strategy in Strategy::ALL {
        let (expected, counts) = write(strategy, &columns, &channels);
        assert_eq!(counts.map(|counts| counts.sampled), [N; 4], "{strategy}");
        let values = NO_NUMBER.into_iter().chain([-0.1, -f32::from_bits(1), -1e30]);
        let one = values.flat_map(|value| (0..6).map(move |k| vec![(k, value)]));
        // No sum, and cancelling ones.
        let two = (0..3).flat_map(|c| [f32::MAX, -0.2].map(|value| vec![(c, value), (3 + c, value.abs().max(0.5))]));
        for fields in one.chain(two) {
            let mut bad = channels.clone();
            fields.iter().for_each(|&(k, value)| bad[k][BAD] = value);
            let (written, counts) = write(strategy, &columns, &bad);
            for (i, row) in written.iter().enumerate() {
                let expected = if i == BAD { &[0; 13] } else { &expected[i] };
                assert_eq!(row, expected, "{strategy}: ray {i} with {fields:?} in {BAD}");
            }
            for counts in counts {
                assert_eq!((counts.sampled, counts.invalid), (N - 1, 1), "{strategy}: {fields:?}");
            }
        }
    }
}

#[test]
fn columns_of_channels_of_another_length_are_named() {
    let columns = Columns::random(&mut Random::new(SEED), 9);
    let (rays, emitters, mut pdf) = (columns.rays(0..9), columns.emitters(0..9), [f32::NAN; 9]);
    let names = ["mu_a[0]", "mu_a[1]", "mu_a[2]", "mu_s[0]", "mu_s[1]", "mu_s[2]", "g"];
    for (k, name) in names.into_iter().enumerate() {
        let mut of_media: [Vec<f32>; 7] = std::array::from_fn(|_| vec![0.1; 9]);
        of_media[k].truncate(8);
        let [a_0, a_1, a_2, s_0, s_1, s_2, g] = &of_media;
        let media = Media::each_coloured([a_0, a_1, a_2], [s_0, s_1, s_2], g);
        let result = Sampler::new(Strategy::Product9).pdf(&rays, &emitters, &media, columns.given(), &mut pdf);
        assert_eq!(said(result), Err(length(&format!("media.{name}"), 8, 9)));
    }
}

/// A case that every strategy samples.
fn good() -> Case {
    Case {
        ray: Ray::new(Vec3::ZERO, Vec3::new(0.6, 0.0, 0.8), 0.5, 9.0).unwrap(),
        emitter: Emitter::point_normal(Vec3::new(1.0, 2.0, 3.0), Vec3::NEG_Y).unwrap(),
        medium: Medium::new(0.1, 0.2, 0.5).unwrap(),
    }
}

const COS_OUTER: &str = "emitters.cos_outer";
const COS_INNER: &str = "emitters.cos_inner";

/// What the fields of a bad ray hold, others as in [`good`].
fn bad_rays() -> Vec<Vec<(&'static str, f32)>> {
    let mut bad: Vec<Vec<(&'static str, f32)>> = Vec::new();
    for name in Columns::FIELDS {
        bad.extend(NO_NUMBER.map(|value| vec![(name, value)]));
    }
    bad.retain(|fields| fields != &[("rays.t_max", f32::INFINITY)]);
    // |d|^2 = 5, where the series of |d| - 1 is 0 again.
    bad.push(vec![("rays.direction[0]", -2.0), ("rays.direction[1]", 1.0), ("rays.direction[2]", 0.0)]);
    let too_far = FARTHEST.next_up();
    let one = [
        ("rays.t_min", -1.0),
        ("rays.t_min", -f32::from_bits(1)),
        ("rays.t_min", 9.1), // beyond t_max
        ("rays.t_max", 0.4), // before t_min
        ("rays.t_max", -1.0),
        ("rays.origin[1]", too_far),
        ("emitters.position[0]", -too_far),
        ("rays.direction[0]", 0.0),
        ("rays.direction[1]", 0.1),
        ("emitters.normal[0]", 1.0),
        ("emitters.normal[1]", -1.01),
        ("emitters.normal[1]", 1e-30),
        ("media.mu_a", -f32::from_bits(1)),
        ("media.mu_a", -0.1),
        ("media.mu_s", -0.1),
        ("media.g", 1f32.next_up()),
        ("media.g", -1.5),
        ("u", -f32::from_bits(1)),
        ("u", 1f32.next_up()),
        ("u", 1e30),
    ];
    bad.extend(one.map(|field| vec![field]));
    bad.push(vec![("rays.direction[0]", 0.0), ("rays.direction[2]", 0.0)]);
    bad.push(vec![("rays.origin[0]", 1e30), ("emitters.position[0]", 1e30)]);
    bad.push(vec![("media.mu_a", f32::MAX), ("media.mu_s", f32::MAX)]);
    // One cosine of -1 alone; cosines out of [0, 1]; the inner one below the outer one.
    let cosines = [
        [0.5, -1.0],
        [-1.0, 0.5],
        [-1.0, 1.0],
        [-f32::from_bits(1), 0.5],
        [-0.5, -0.5],
        [0.5, 1f32.next_up()],
        [1.5, 1.5],
        [0.5, 0.5f32.next_down()],
        [0.5, 0.0],
        [1f32.next_down(), f32::NAN],
        [f32::NAN, 0.5],
        [f32::NAN; 2],
    ];
    bad.extend(cosines.map(|[outer, inner]| vec![(COS_OUTER, outer), (COS_INNER, inner)]));
    for axis in [0.0, -0.0, 1e-30, 0.99, 1.01, f32::NAN, f32::INFINITY] {
        bad.push(vec![("emitters.normal[1]", axis), (COS_OUTER, 0.5), (COS_INNER, 0.6)]);
    }
    bad
}

fn with_fields(fields: &[(&str, f32)]) -> Columns {
    let mut columns = Columns::new([(good(), 0.5)]);
    for (name, value) in fields {
        columns.0[Columns::index(name)][0] = *value;
    }
    columns
}

#[test]
fn a_bad_ray_is_counted_and_gets_zeros() {
    for sampler in samplers::all() {
        let strategy = format!("{}, {}", sampler.strategy(), sampler.precision());
        for good in [&[][..], &[(COS_OUTER, 0.5), (COS_INNER, 0.6)], &[(COS_OUTER, -0.0), (COS_INNER, 1.0)]] {
            assert_eq!(with_fields(good).sample(&sampler).counts.sampled, 1, "{strategy}: {good:?}");
        }
        for fields in bad_rays() {
            let columns = with_fields(&fields);
            let drawn = columns.sample(&sampler);
            let counts = (drawn.counts.sampled, drawn.counts.empty, drawn.counts.invalid);
            assert_eq!((counts, drawn.bits(0)), ((0, 0, 1), [0; 4]), "{strategy}: {fields:?}, {:?}", drawn.row(0));
            let given = columns.given()[0];
            if fields[0].0 != "u" || given.is_nan() {
                assert_eq!((columns.pdf(&sampler), columns.evaluate(&sampler)), (vec![0.0], vec![0.0]), "{fields:?}");
            }
        }
    }
}

#[test]
fn a_ray_without_light_is_empty() {
    let dark: [&[(&str, f32)]; 6] = [
        &[("rays.t_max", 0.5)],
        &[("emitters.normal[1]", 1.0)],
        // Along the emitter's plane and beside it, on the dark side.
        &[("emitters.normal[1]", 1.0), ("emitters.position[1]", 1e-3)],
        &[("rays.t_min", 2e6), ("rays.t_max", 2e6)],
        // Cones that face away, and one of no width.
        &[("emitters.normal[1]", 1.0), (COS_OUTER, 0.0), (COS_INNER, 0.5)],
        &[(COS_OUTER, 1.0), (COS_INNER, 1.0)],
    ];
    for sampler in samplers::all() {
        for fields in dark {
            let drawn = with_fields(fields).sample(&sampler);
            let counts = (drawn.counts.sampled, drawn.counts.empty, drawn.counts.invalid);
            let name = format!("{}, {}", sampler.strategy(), sampler.precision());
            assert_eq!((counts, drawn.bits(0)), ((0, 1, 0), [0; 4]), "{name}: {fields:?}");
        }
    }
}

/// Rows of random bits in all fields or in some of otherwise good rays.
fn random_bits(n: usize) -> Columns {
    let mut random = Random::new(SEED + 1);
    let mut columns = Columns::with_spots(&mut random, n);
    for i in 0..n {
        // In one row of eight everything is random. So wild a ray is hardly ever valid.
        let mut fields = if i % 8 == 0 { u64::from(u32::MAX) } else { random.bits() & random.bits() & random.bits() };
        // Three rows of four have no cone: random cosines are hardly ever those of one.
        if i % 4 != 1 {
            for k in Columns::CONES {
                columns.0[k][i] = -1.0;
                fields &= !(1 << k);
            }
        }
        for (field, column) in columns.0.iter_mut().enumerate() {
            if fields >> field & 1 == 1 {
                column[i] = f32::from_bits(random.bits() as u32);
            }
        }
    }
    columns
}

#[test]
fn any_bits_give_numbers() {
    const N: usize = 1 << 20;
    let columns = random_bits(N);
    for sampler in samplers::all() {
        let strategy = format!("{}, {}", sampler.strategy(), sampler.precision());
        let drawn = columns.sample(&sampler);
        let counts = drawn.counts;
        assert_eq!(counts.sampled + counts.empty + counts.invalid, N, "{strategy}");
        assert!(counts.sampled > N / 8 && counts.invalid > N / 4 && counts.empty > N / 64, "{strategy}: {counts:?}");
        let mut written = 0;
        for i in 0..N {
            let row @ [t, ..] = drawn.row(i);
            let place = || format!("{strategy}: {row:?} of ray {i}, seed {SEED}{}", Row(&columns, i));
            assert!(row.iter().all(|x| x.is_finite() && *x >= 0.0), "{}", place());
            if drawn.bits(i) != [0; 4] {
                written += 1;
                assert!(columns.0[6][i] <= t && t <= columns.0[7][i], "{}", place());
            }
        }
        assert!(written <= counts.sampled, "{strategy}: {written} of {counts:?}");
    }
}

#[test]
fn any_bits_give_densities_and_integrands() {
    const N: usize = 1 << 20;
    let columns = random_bits(N);
    for sampler in samplers::all() {
        let strategy = format!("{}, {}", sampler.strategy(), sampler.precision());
        for (what, column) in [("pdf", columns.pdf(&sampler)), ("integrand", columns.evaluate(&sampler))] {
            let bad = column.iter().position(|x| !(x.is_finite() && *x >= 0.0));
            assert!(bad.is_none(), "{strategy}, {what}, seed {SEED}: {}", Row(&columns, bad.unwrap()));
        }
    }
}
