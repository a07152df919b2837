//! A call through the ABI gives the bits of the call from Rust, however columns lie and on whatever threads.

mod host;

use airlight::{
    Backend, Counts, Emitter, Emitters, Error, Integral, Media, Medium, Nodes, Precision, Rays, Sampler, Samples,
    Strategy,
};
use airlight_c::*;
use core::array;
use core::ptr::null;
use host::{Column, Host, LOOKS, Layout, PACKED, PLAIN, result};

const LAYOUTS: [Layout; 5] = [
    PACKED,
    Layout { stride: 0, offset: 1 },
    Layout { stride: 0, offset: 4 },
    Layout { stride: 48, offset: 8 },
    Layout { stride: 35, offset: 3 },
];

/// Where emitters and media come from.
#[derive(Clone, Copy, Debug)]
enum From {
    One,
    Table,
    Columns,
}

/// The structs of a batch, with the columns that they point to.
struct Lent {
    // What the pointers of the batch point to.
    _columns: Vec<Column>,
    _emitters: Box<airlight_emitters>,
    _media: Box<airlight_media>,
    batch: airlight_batch,
}

fn bits(values: &[f32]) -> Vec<u32> {
    values.iter().map(|value| value.to_bits()).collect()
}

fn lend(host: &Host, layout: Layout, from: From) -> Lent {
    let mut columns: Vec<Column> =
        host.columns().into_iter().map(|column| Column::of(layout, 1, &bits(column))).collect();
    columns.push(Column::of(layout, 1, &host.index));
    let index = columns.last_mut().unwrap().indices();
    let mut at = |i: usize| columns[i].input();
    let (mut emitters, mut media) = (Box::<airlight_emitters>::default(), Box::<airlight_media>::default());
    match from {
        From::One | From::Table => {
            (emitters.table, emitters.table_count) = (host.emitters.as_ptr(), 1);
            (media.table, media.table_count) = (host.media.as_ptr(), 1);
            if let From::Table = from {
                (emitters.table_count, emitters.index) = (host.emitters.len(), index);
                (media.table_count, media.index) = (host.media.len(), index);
            }
        }
        From::Columns => {
            emitters.position = [at(6), at(7), at(8)];
            emitters.direction = [at(9), at(10), at(11)];
            if host.look.has_spots {
                (emitters.cos_outer, emitters.cos_inner) = (at(15), at(16));
            }
            for c in 0..host.look.channels {
                (media.mu_a[c], media.mu_s[c]) = (at(17 + c), at(21 + c));
            }
            (media.g, media.channels) = (at(14), host.look.channels as u32);
        }
    }
    let batch = airlight_batch {
        count: host.rays(),
        origin: [at(0), at(1), at(2)],
        direction: [at(3), at(4), at(5)],
        t_min: at(12),
        t_max: at(13),
        emitters: &*emitters,
        media: &*media,
        ..Default::default()
    };
    Lent { _columns: columns, _emitters: emitters, _media: media, batch }
}

/// What Rust calls take.
struct Known<'a> {
    rays: Rays<'a>,
    emitters: Emitters<'a>,
    media: Media<'a>,
}

/// The first columns.
fn first<const C: usize>(columns: &[Vec<f32>]) -> [&[f32]; C] {
    array::from_fn(|c| &columns[c][..])
}

/// Has `call` make a call from Rust.
fn known<R>(host: &Host, from: From, call: impl FnOnce(&Known<'_>) -> Result<R, Error>) -> R {
    let emitters: Vec<Emitter> = host.emitters.iter().map(|e| emitter(e).unwrap()).collect();
    let media: Vec<Medium> = host.media.iter().map(|m| medium(m).unwrap()).collect();
    let rays = Rays::new(first(&host.origin), first(&host.direction), &host.t_min, &host.t_max);
    let (emitters, media) = match from {
        From::One => (Emitters::one(emitters[0]), Media::one(media[0])),
        From::Table => (Emitters::table(&emitters, &host.index), Media::table(&media, &host.index)),
        From::Columns => {
            let (position, normal, [cos_outer, cos_inner]) =
                (first(&host.position), first(&host.normal), &host.cosines);
            let emitters = match host.look.has_spots {
                false => Emitters::each(position, normal),
                true => Emitters::each_spot(position, normal, cos_outer, cos_inner),
            };
            let media = match host.look.channels {
                1 => Media::each(&host.mu_a[0], &host.mu_s[0], &host.g),
                3 => Media::each_coloured::<3>(first(&host.mu_a), first(&host.mu_s), &host.g),
                _ => Media::each_coloured::<4>(first(&host.mu_a), first(&host.mu_s), &host.g),
            };
            (emitters, media)
        }
    };
    call(&Known { rays, emitters, media }).unwrap()
}

fn emitter(emitter: &airlight_emitter) -> Result<Emitter, Error> {
    match emitter.kind {
        0 => Emitter::point(emitter.position),
        1 => Emitter::point_normal(emitter.position, emitter.direction),
        _ => Emitter::spot(emitter.position, emitter.direction, emitter.cos_outer, emitter.cos_inner),
    }
}

fn medium(medium: &airlight_medium) -> Result<Medium, Error> {
    let airlight_medium { channels, mu_a: [a0, a1, a2, a3], mu_s: [s0, s1, s2, s3], g } = *medium;
    match channels {
        1 => Medium::new(a0, s0, g),
        3 => Medium::coloured([a0, a1, a2], [s0, s1, s2], g),
        _ => Medium::coloured([a0, a1, a2, a3], [s0, s1, s2, s3], g),
    }
}

/// What Rust samples: t, pdf, r, and the weights of the channels.
fn samples_of_rust(host: &Host, from: From, strategy: Strategy) -> (Vec<Vec<f32>>, Counts) {
    let mut columns = vec![vec![0.0; host.u.len()]; 3 + host.look.channels];
    let counts = known(host, from, |Known { rays, emitters, media }| {
        let [t, pdf, r, weights @ ..] = &mut columns[..] else { unreachable!() };
        let mut out = Samples::new(t, pdf).r(r);
        out.weights.iter_mut().zip(weights).for_each(|(out, weight)| *out = Some(weight));
        Sampler::new(strategy).sample(rays, emitters, media, &host.u, &mut out)
    });
    (columns, counts)
}

/// The integrands of the channels at the distances `host.u`.
fn integrands_of_rust(host: &Host, from: From) -> Vec<Vec<f32>> {
    let mut columns = vec![vec![0.0; host.u.len()]; host.look.channels];
    known(host, from, |Known { rays, emitters, media }| {
        let sampler = Sampler::new(Strategy::default());
        match &mut columns[..] {
            [grey] => sampler.evaluate(rays, emitters, media, &host.u, grey),
            [a, b, c] => sampler.evaluate_coloured(rays, emitters, media, &host.u, [a, b, c]),
            [a, b, c, d] => sampler.evaluate_coloured(rays, emitters, media, &host.u, [a, b, c, d]),
            _ => unreachable!(),
        }
    });
    columns
}

/// The radiances of the channels.
fn radiances_of_rust(host: &Host, from: From, nodes: Nodes) -> Vec<Vec<f32>> {
    let mut columns = vec![vec![0.0; host.rays()]; host.look.channels];
    known(host, from, |Known { rays, emitters, media }| {
        let integral = Integral::new(nodes);
        match &mut columns[..] {
            [grey] => integral.radiance(rays, emitters, media, grey),
            [a, b, c] => integral.radiance_coloured(rays, emitters, media, [a, b, c]),
            [a, b, c, d] => integral.radiance_coloured(rays, emitters, media, [a, b, c, d]),
            _ => unreachable!(),
        }
    });
    columns
}

/// Every way of calling: `(layout, from, options)`.
fn ways() -> impl Iterator<Item = (Layout, From, airlight_options)> {
    LAYOUTS.into_iter().enumerate().flat_map(|(i, layout)| {
        [From::One, From::Table, From::Columns]
            .into_iter()
            .map(move |from| (layout, from, airlight_options { threads: i as u32 % 4, ..Default::default() }))
    })
}

#[test]
fn samples_are_those_of_rust() {
    let sizes = [(10_000, 1), (1, 1), (0, 1), (3_000, 3), (2, 5_000), (17, 8)];
    for (look, (rays, per_ray)) in LOOKS.into_iter().flat_map(|look| sizes.map(|size| (look, size))) {
        let host = Host::new(look, rays as u64, rays, per_ray);
        let values = rays * per_ray;
        for (number, &strategy) in (1..).zip(Strategy::ALL) {
            if rays > 100 && number % 3 != 1 {
                continue;
            }
            for (layout, from, options) in ways() {
                let options = airlight_options { strategy: number, ..options };
                let (expected, counts) = samples_of_rust(&host, from, strategy);

                // Elements of several numbers need a larger stride. Some columns are packed where others are not.
                let stride = if per_ray > 8 { layout.stride * per_ray } else { layout.stride };
                let lent = lend(&host, Layout { stride, ..layout }, from);
                let layouts = [Layout { stride, ..layout }, PACKED];
                let mut u = Column::of(layouts[(number + options.threads) as usize % 2], per_ray, &bits(&host.u));
                let mut out: Vec<_> = (0..expected.len()).map(|i| Column::new(layouts[i % 2], rays, per_ray)).collect();
                let mut samples = airlight_samples { per_ray, u: u.input(), ..Default::default() };
                (samples.t, samples.pdf, samples.r) = (out[0].output(), out[1].output(), out[2].output());
                samples.weight.iter_mut().zip(&mut out[3..]).for_each(|(weight, out)| *weight = out.output());
                let mut found = airlight_counts::default();
                // SAFETY: the columns have as many elements as the batch has rays.
                let status = unsafe { airlight_sample(&options, &lent.batch, &samples, &mut found) };
                result(status).unwrap();
                for (out, expected) in out.iter_mut().zip(&expected) {
                    assert_eq!(out.bits(values), bits(expected), "{look:?} {strategy} {rays} {layout:?} {from:?}");
                }
                let numbers = [found.sampled, found.empty, found.invalid, found.bisected];
                assert_eq!(numbers, [counts.sampled, counts.empty, counts.invalid, counts.bisected]);
            }
        }
    }
}

#[test]
fn precision_and_backend_are_those_asked_for() {
    let host = Host::new(PLAIN, 3, 5_000, 1);
    let mut different = Vec::new();
    for backend in Backend::available() {
        let number = ["portable", "avx2", "avx512"].iter().position(|&name| name == backend.name()).unwrap() as u32 + 1;
        for (precision, &of_rust) in (0..).zip(Precision::ALL) {
            let mut expected = [vec![0.0; 5_000], vec![0.0; 5_000]];
            let [t, pdf] = &mut expected;
            known(&host, From::Table, |Known { rays, emitters, media }| {
                let sampler = Sampler::new(Strategy::EquiAngular).with_backend(backend).with_precision(of_rust)?;
                sampler.sample(rays, emitters, media, &host.u, &mut Samples::new(t, pdf))
            });
            let strategy = airlight_strategy::EquiAngular as u32;
            let options = airlight_options { strategy, precision, backend: number, ..Default::default() };
            let lent = lend(&host, PACKED, From::Table);
            let mut u = Column::of(PACKED, 1, &bits(&host.u));
            let mut out = [(); 2].map(|()| Column::new(PACKED, 5_000, 1));
            let mut samples = airlight_samples { per_ray: 1, u: u.input(), ..Default::default() };
            (samples.t, samples.pdf) = (out[0].output(), out[1].output());
            // SAFETY: the columns have as many elements as the batch has rays.
            result(unsafe { airlight_sample(&options, &lent.batch, &samples, core::ptr::null_mut()) }).unwrap();
            let found = out.each_mut().map(|column| column.bits(5_000));
            assert_eq!(found, expected.each_ref().map(|column| bits(column)), "{} {of_rust}", backend.name());
            if !different.contains(&found) {
                different.push(found);
            }
        }
    }
    // Otherwise it would not matter what is asked for.
    assert!(different.len() > 1);
}

#[test]
fn what_is_not_wanted_is_not_missed() {
    let host = Host::new(PLAIN, 4, 5_000, 1);
    let mut expected = [vec![0.0; 5_000], vec![0.0; 5_000]];
    let [weight, r] = &mut expected;
    let mut none = [vec![0.0; 5_000], vec![0.0; 5_000]];
    let [t, pdf] = &mut none;
    known(&host, From::One, |Known { rays, emitters, media }| {
        let mut out = Samples::new(t, pdf).weight(weight).r(r);
        Sampler::new(Strategy::default()).sample(rays, emitters, media, &host.u, &mut out)
    });
    let lent = lend(&host, PACKED, From::One);
    let mut u = Column::of(PACKED, 1, &bits(&host.u));
    for (i, expected) in expected.iter().enumerate() {
        let mut out = Column::new(PACKED, 5_000, 1);
        let mut samples = airlight_samples { per_ray: 1, u: u.input(), ..Default::default() };
        *[&mut samples.weight[0], &mut samples.r][i] = out.output();
        // SAFETY: the columns have as many elements as the batch has rays.
        result(unsafe { airlight_sample(null(), &lent.batch, &samples, core::ptr::null_mut()) }).unwrap();
        assert_eq!(out.bits(5_000), bits(expected));
    }
}

#[test]
fn columns_that_are_not_given_are_zeros() {
    let mut host = Host::new(PLAIN, 5, 5_000, 1);
    host.t_min.fill(0.0);
    host.g.fill(0.0);
    host.normal.iter_mut().for_each(|column| column.fill(0.0));
    let mut expected = vec![0.0; 5_000];
    known(&host, From::Columns, |Known { rays, emitters, media }| {
        Integral::new(Nodes::Eight).radiance(rays, emitters, media, &mut expected)
    });
    let lent = lend(&host, PACKED, From::Columns);
    let none = airlight_column { data: null(), stride: 0 };
    let emitters = airlight_emitters { direction: [none; 3], ..*lent._emitters };
    let media = airlight_media { g: none, ..*lent._media };
    let batch = airlight_batch { t_min: none, emitters: &emitters, media: &media, ..lent.batch };
    let mut out = Column::new(PACKED, 5_000, 1);
    let mut values = airlight_values::default();
    values.value[0] = out.output();
    // SAFETY: the columns have as many elements as the batch has rays.
    result(unsafe { airlight_radiance(null(), &batch, &values, core::ptr::null_mut()) }).unwrap();
    assert_eq!(out.bits(5_000), bits(&expected));
}

#[test]
fn what_is_known_at_distances_is_that_of_rust() {
    type Rust = fn(&Sampler, &Rays<'_>, &Emitters<'_>, &Media<'_>, &[f32], &mut [f32]) -> Result<Counts, Error>;
    type C = unsafe extern "C" fn(
        *const airlight_options,
        *const airlight_batch,
        *const airlight_values,
        *mut airlight_counts,
    ) -> airlight_status;
    // The integrand is known in each channel.
    let calls: [(Option<Rust>, C); 3] =
        [(Some(Sampler::pdf), airlight_pdf), (Some(Sampler::cdf), airlight_cdf), (None, airlight_evaluate)];
    for (look, (rust, c)) in LOOKS.into_iter().flat_map(|look| calls.map(|call| (look, call))) {
        let per_ray = 2;
        let mut host = Host::new(look, 6, 5_000, per_ray);
        host.u.iter_mut().for_each(|t| *t *= 5.0);
        for (layout, from, options) in ways() {
            let expected = rust.map_or_else(
                || integrands_of_rust(&host, from),
                |rust| {
                    let mut expected = vec![0.0; 10_000];
                    known(&host, from, |Known { rays, emitters, media }| {
                        rust(&Sampler::new(Strategy::default()), rays, emitters, media, &host.u, &mut expected)
                    });
                    vec![expected]
                },
            );
            let lent = lend(&host, layout, from);
            let mut t = Column::of(layout, per_ray, &bits(&host.u));
            let mut out: Vec<_> = expected.iter().map(|_| Column::new(layout, 5_000, per_ray)).collect();
            let mut values = airlight_values { per_ray, t: t.input(), ..Default::default() };
            values.value.iter_mut().zip(&mut out).for_each(|(value, out)| *value = out.output());
            // SAFETY: the columns have as many elements as the batch has rays.
            result(unsafe { c(&options, &lent.batch, &values, core::ptr::null_mut()) }).unwrap();
            for (out, expected) in out.iter_mut().zip(&expected) {
                assert_eq!(out.bits(10_000), bits(expected), "{look:?} {layout:?} {from:?}");
            }
        }
    }
}

#[test]
fn radiance_is_that_of_rust_with_every_number_of_nodes() {
    let numbers = Nodes::ALL.iter().map(|&nodes| (nodes, nodes.count() as u32)).chain([(Nodes::Eight, 0)]);
    for (look, (nodes, count)) in LOOKS.into_iter().flat_map(|look| numbers.clone().map(move |number| (look, number))) {
        let host = Host::new(look, 7, 5_000, 1);
        for (layout, from, options) in ways() {
            let expected = radiances_of_rust(&host, from, nodes);
            let lent = lend(&host, layout, from);
            let mut out: Vec<_> = expected.iter().map(|_| Column::new(layout, 5_000, 1)).collect();
            let mut values = airlight_values::default();
            values.value.iter_mut().zip(&mut out).for_each(|(value, out)| *value = out.output());
            let options = airlight_options { nodes: count, ..options };
            // SAFETY: the columns have as many elements as the batch has rays.
            result(unsafe { airlight_radiance(&options, &lent.batch, &values, core::ptr::null_mut()) }).unwrap();
            for (out, expected) in out.iter_mut().zip(&expected) {
                assert_eq!(out.bits(5_000), bits(expected), "{look:?} {layout:?} {from:?}");
            }
        }
    }
}

#[test]
fn choices_are_those_of_rust() {
    let weights = [1.0, 20.0, 3.0];
    for (look, (layout, from, options)) in LOOKS.into_iter().flat_map(|look| ways().map(move |way| (look, way))) {
        let host = Host::new(look, 8, 5_000, 1);
        let table: Vec<Emitter> = host.emitters.iter().map(|e| emitter(e).unwrap()).collect();
        let (mut index, mut probability) = (vec![0; 5_000], vec![0.0; 5_000]);
        known(&host, from, |Known { rays, media, .. }| {
            let (index, probability) = (&mut index, &mut probability);
            Integral::new(Nodes::Eight).choose(rays, &table, &weights, media, &host.u, index, probability)
        });
        let lent = lend(&host, layout, from);
        let emitters =
            airlight_emitters { table: host.emitters.as_ptr(), table_count: host.emitters.len(), ..Default::default() };
        let batch = airlight_batch { emitters: &emitters, ..lent.batch };
        let (mut u, mut weights) = (Column::of(layout, 1, &bits(&host.u)), Column::of(layout, 1, &bits(&weights)));
        let mut out = [(); 2].map(|()| Column::new(layout, 5_000, 1));
        let choices = airlight_choices {
            u: u.input(),
            weights: weights.input(),
            index: out[0].index_output(),
            probability: out[1].output(),
            ..Default::default()
        };
        // SAFETY: the columns have as many elements as the batch has rays.
        result(unsafe { airlight_choose(&options, &batch, &choices, core::ptr::null_mut()) }).unwrap();
        assert_eq!(out[0].bits(5_000), index);
        assert_eq!(out[1].bits(5_000), bits(&probability));
    }
}

/// The numbers of a ray: those of the columns that there are, then `rest`.
fn at_ray<const N: usize>(columns: &[Vec<f32>], ray: usize, rest: f32) -> [u32; N] {
    array::from_fn(|c| columns.get(c).map_or(rest, |column| column[ray]).to_bits())
}

#[test]
fn one_ray_is_a_batch_of_one() {
    for look in LOOKS {
        let mut host = Host::new(look, 9, 100, 1);
        host.index = (0..100).map(|i| i % 3).collect();
        let (samples, _) = samples_of_rust(&host, From::Table, Strategy::default());
        let radiances = radiances_of_rust(&host, From::Table, Nodes::Eight);
        host.u.clone_from(&samples[0]);
        let integrands = integrands_of_rust(&host, From::Table);
        let u = Host::new(look, 9, 100, 1).u;
        for i in (0..100).filter(|i| i % 17 != 5) {
            let at = |columns: &[Vec<f32>; 3]| columns.each_ref().map(|column| column[i]);
            let (emitter, medium) = (host.emitters[i % 3], host.media[i % 3]);
            let (t_min, t_max) = (host.t_min[i], host.t_max[i]);
            let ray = airlight_ray { origin: at(&host.origin), direction: at(&host.direction), t_min, t_max };
            let scene = airlight_scene { ray, emitter, medium, ..Default::default() };
            let (mut sample, mut pdf, mut cdf) = (airlight_one_sample::default(), 0.0, 0.0);
            let (mut integrand, mut radiance) = ([7.0; 5], [7.0; 5]);
            // SAFETY: pointers to what they are said to be.
            unsafe {
                result(airlight_sample_one(null(), &scene, u[i], &mut sample)).unwrap();
                result(airlight_pdf_one(null(), &scene, sample.t, &mut pdf)).unwrap();
                result(airlight_cdf_one(null(), &scene, sample.t, &mut cdf)).unwrap();
                result(airlight_evaluate_one(null(), &scene, sample.t, integrand.as_mut_ptr())).unwrap();
                result(airlight_radiance_one(null(), &scene, radiance.as_mut_ptr())).unwrap();
            }
            let found = [sample.t, sample.pdf, sample.r].map(f32::to_bits);
            assert_eq!(found, at_ray(&samples[..3], i, 0.0), "{look:?}");
            assert_eq!(sample.weight.map(f32::to_bits), at_ray(&samples[3..], i, 0.0), "{look:?}");
            assert_eq!(integrand.map(f32::to_bits), at_ray(&integrands, i, 7.0), "{look:?}");
            assert_eq!(radiance.map(f32::to_bits), at_ray(&radiances, i, 7.0), "{look:?}");
            let ray = airlight::Ray::new(ray.origin, ray.direction, t_min, t_max).unwrap();
            let (emitter, medium) = (self::emitter(&emitter).unwrap(), self::medium(&medium).unwrap());
            let sampler = Sampler::new(Strategy::default());
            assert_eq!(pdf, sampler.pdf_one(&ray, &emitter, &medium, sample.t));
            assert_eq!(cdf, sampler.cdf_one(&ray, &emitter, &medium, sample.t));
        }
    }
}

#[test]
fn numbers_have_the_names_of_rust() {
    // SAFETY: names are C strings that live for ever.
    let text = |name| unsafe { core::ffi::CStr::from_ptr(name) }.to_str().unwrap();
    for (number, strategy) in (1..).zip(Strategy::ALL) {
        assert_eq!(text(airlight_strategy_name(number)), strategy.name());
    }
    assert_eq!(text(airlight_strategy_name(airlight_strategy::Product17 as u32)), "product-17");
    assert_eq!(text(airlight_strategy_name(0)), Strategy::default().name());
    assert!(airlight_strategy_name(Strategy::ALL.len() as u32 + 1).is_null());
    let fastest = airlight::Backend::detect();
    assert_eq!(text(airlight_backend_name(0)), fastest.name());
    assert_eq!(airlight_backend_is_fused(0), fastest.is_fused());
    assert_eq!(text(airlight_backend_name(airlight_backend::Portable as u32)), "portable");
    assert!(airlight_backend_name(99).is_null());
    let root = include_str!("../../../Cargo.toml");
    assert!(root.contains(&format!("version = \"{}\"", text(airlight_version()))), "the version of airlight");
}
