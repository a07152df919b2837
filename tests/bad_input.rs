//! A malformed call is refused with an error that names what is wrong; a bad ray is none, it is counted and gets zeros;
//! and whatever the bits of the input, nothing panics and nothing that is not a number comes out.

mod scenes;

use airlight::{
    Counts, Emitter, Error, FARTHEST, Integral, Media, Medium, Nodes, Ray, Sampler, Strategy, UNIT_TOLERANCE,
};
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
        for (k, name) in ["samples.t", "samples.pdf", "samples.weight", "samples.r"].into_iter().enumerate() {
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

/// Nothing takes a coloured medium for a grey one.
#[test]
fn coloured_media_have_no_kernel() {
    let columns = Columns::random(&mut Random::new(SEED), 9);
    let medium = Medium::coloured([0.1; 3], [0.2, 0.3, 0.4], 0.0).unwrap();
    let (coloured, index, emitters) = ([medium], [0; 9], &columns.emitters(0..9));
    let refused = [Media::one(medium), Media::table(&coloured, &index)];
    for (&strategy, media) in Strategy::ALL.iter().flat_map(|s| refused.iter().map(move |media| (s, media))) {
        let (sampler, rays, expected) =
            (Sampler::new(strategy), columns.rays(0..9), Err("there are no kernels for coloured media".to_owned()));
        let (mut drawn, mut out, u) = (Drawn::new(9), [f32::NAN; 9], columns.given());
        assert_eq!(said(sampler.sample(&rays, emitters, media, u, &mut drawn.samples())), expected);
        assert_eq!(said(sampler.pdf(&rays, emitters, media, u, &mut out)), expected);
        assert_eq!(said(sampler.cdf(&rays, emitters, media, u, &mut out)), expected);
        assert_eq!(said(sampler.evaluate(&rays, emitters, media, u, &mut out)), expected);
        assert_eq!(said(Integral::new(Nodes::Eight).radiance(&rays, emitters, media, &mut out)), expected);
        let written = [&drawn.t, &drawn.pdf, &drawn.weight, &drawn.r].map(|column| &column[..]).concat();
        assert!(written.iter().chain(&out).all(|x| x.is_nan()));
    }
    let (Case { ray, emitter, .. }, sampler) = (good(), Sampler::new(Strategy::Product5));
    assert_eq!(sampler.sample_one(&ray, &emitter, &medium, 0.5), None);
    assert_eq!(sampler.pdf_one(&ray, &emitter, &medium, 1.0), 0.0);
    assert_eq!(sampler.cdf_one(&ray, &emitter, &medium, 1.0), 0.0);
    assert_eq!(sampler.evaluate_one(&ray, &emitter, &medium, 1.0), 0.0);
    assert_eq!(Integral::new(Nodes::Eight).radiance_one(&ray, &emitter, &medium), 0.0);
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
    for &strategy in Strategy::ALL {
        let sampler = Sampler::new(strategy);
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
    for &strategy in Strategy::ALL {
        for fields in dark {
            let drawn = with_fields(fields).sample(&Sampler::new(strategy));
            let counts = (drawn.counts.sampled, drawn.counts.empty, drawn.counts.invalid);
            assert_eq!((counts, drawn.bits(0)), ((0, 1, 0), [0; 4]), "{strategy}: {fields:?}");
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
    for &strategy in Strategy::ALL {
        let sampler = Sampler::new(strategy);
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
    for &strategy in Strategy::ALL {
        let sampler = Sampler::new(strategy);
        for (what, column) in [("pdf", columns.pdf(&sampler)), ("integrand", columns.evaluate(&sampler))] {
            let bad = column.iter().position(|x| !(x.is_finite() && *x >= 0.0));
            assert!(bad.is_none(), "{strategy}, {what}, seed {SEED}: {}", Row(&columns, bad.unwrap()));
        }
    }
}
