//! A call through the ABI gives the bits of the call from Rust, however columns lie and on whatever threads.

mod host;

use airlight::{
    Backend, Emitter, Emitters, Error, Integral, Media, Medium, Nodes, Precision, Rays, Sampler, Samples, Strategy,
};
use airlight_c::*;
use core::ptr::null;
use host::{Column, Host, Layout, PACKED, result};

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
            (media.mu_a[0], media.mu_s[0], media.g) = (at(14), at(15), at(16));
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

/// Columns of three coordinates.
fn three(columns: &[Vec<f32>; 3]) -> [&[f32]; 3] {
    columns.each_ref().map(|column| &column[..])
}

/// Has `call` make a call from Rust.
fn known<R>(host: &Host, from: From, call: impl FnOnce(&Known<'_>) -> Result<R, Error>) -> R {
    let emitters: Vec<Emitter> = host.emitters.iter().map(|e| emitter(e).unwrap()).collect();
    let media: Vec<Medium> = host.media.iter().map(|m| Medium::new(m.mu_a[0], m.mu_s[0], m.g).unwrap()).collect();
    let rays = Rays::new(three(&host.origin), three(&host.direction), &host.t_min, &host.t_max);
    let (emitters, media) = match from {
        From::One => (Emitters::one(emitters[0]), Media::one(media[0])),
        From::Table => (Emitters::table(&emitters, &host.index), Media::table(&media, &host.index)),
        From::Columns => {
            let media = Media::each(&host.mu_a, &host.mu_s, &host.g);
            (Emitters::each(three(&host.position), three(&host.normal)), media)
        }
    };
    call(&Known { rays, emitters, media }).unwrap()
}

fn emitter(emitter: &airlight_emitter) -> Result<Emitter, Error> {
    match emitter.kind {
        0 => Emitter::point(emitter.position),
        _ => Emitter::point_normal(emitter.position, emitter.direction),
    }
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
    for (rays, per_ray) in [(10_000, 1), (1, 1), (0, 1), (3_000, 3), (2, 5_000), (17, 8)] {
        let host = Host::new(rays as u64, rays, per_ray);
        let values = rays * per_ray;
        for (number, &strategy) in (1..).zip(Strategy::ALL) {
            if rays > 100 && number % 3 != 1 {
                continue;
            }
            for (layout, from, options) in ways() {
                let options = airlight_options { strategy: number, ..options };
                let mut expected = [const { Vec::new() }; 4].map(|_: Vec<f32>| vec![0.0; values]);
                let [t, pdf, weight, r] = &mut expected;
                let counts = known(&host, from, |Known { rays, emitters, media }| {
                    let mut out = Samples::new(t, pdf).weight(weight).r(r);
                    Sampler::new(strategy).sample(rays, emitters, media, &host.u, &mut out)
                });

                // Elements of several numbers need a larger stride. Some columns are packed where others are not.
                let stride = if per_ray > 8 { layout.stride * per_ray } else { layout.stride };
                let lent = lend(&host, Layout { stride, ..layout }, from);
                let layouts = [Layout { stride, ..layout }, PACKED];
                let mut u = Column::of(layouts[(number + options.threads) as usize % 2], per_ray, &bits(&host.u));
                let mut out = [0, 1, 0, 1].map(|i| Column::new(layouts[i], rays, per_ray));
                let mut samples = airlight_samples { per_ray, u: u.input(), ..Default::default() };
                (samples.t, samples.pdf) = (out[0].output(), out[1].output());
                (samples.weight[0], samples.r) = (out[2].output(), out[3].output());
                let mut found = airlight_counts::default();
                // SAFETY: the columns have as many elements as the batch has rays.
                let status = unsafe { airlight_sample(&options, &lent.batch, &samples, &mut found) };
                result(status).unwrap();
                for (out, expected) in out.iter_mut().zip(&expected) {
                    assert_eq!(out.bits(values), bits(expected), "{strategy} {rays} {per_ray} {layout:?} {from:?}");
                }
                let numbers = [found.sampled, found.empty, found.invalid, found.bisected];
                assert_eq!(numbers, [counts.sampled, counts.empty, counts.invalid, counts.bisected]);
            }
        }
    }
}

#[test]
fn precision_and_backend_are_those_asked_for() {
    let host = Host::new(3, 5_000, 1);
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
    let host = Host::new(4, 5_000, 1);
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
    let mut host = Host::new(5, 5_000, 1);
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
    let per_ray = 2;
    let mut host = Host::new(6, 5_000, per_ray);
    host.u.iter_mut().for_each(|t| *t *= 5.0);
    type Rust =
        fn(&Sampler, &Rays<'_>, &Emitters<'_>, &Media<'_>, &[f32], &mut [f32]) -> Result<airlight::Counts, Error>;
    type C = unsafe extern "C" fn(
        *const airlight_options,
        *const airlight_batch,
        *const airlight_values,
        *mut airlight_counts,
    ) -> airlight_status;
    let calls: [(Rust, C); 3] =
        [(Sampler::pdf, airlight_pdf), (Sampler::cdf, airlight_cdf), (Sampler::evaluate, airlight_evaluate)];
    for (rust, c) in calls {
        for (layout, from, options) in ways() {
            let mut expected = vec![0.0; 10_000];
            known(&host, from, |Known { rays, emitters, media }| {
                rust(&Sampler::new(Strategy::default()), rays, emitters, media, &host.u, &mut expected)
            });
            let lent = lend(&host, layout, from);
            let (mut t, mut out) = (Column::of(layout, per_ray, &bits(&host.u)), Column::new(layout, 5_000, per_ray));
            let mut values = airlight_values { per_ray, t: t.input(), ..Default::default() };
            values.value[0] = out.output();
            // SAFETY: the columns have as many elements as the batch has rays.
            result(unsafe { c(&options, &lent.batch, &values, core::ptr::null_mut()) }).unwrap();
            assert_eq!(out.bits(10_000), bits(&expected), "{layout:?} {from:?}");
        }
    }
}

#[test]
fn radiance_is_that_of_rust_with_every_number_of_nodes() {
    let host = Host::new(7, 5_000, 1);
    for (nodes, count) in Nodes::ALL.iter().map(|&nodes| (nodes, nodes.count() as u32)).chain([(Nodes::Eight, 0)]) {
        for (layout, from, options) in ways() {
            let mut expected = vec![0.0; 5_000];
            known(&host, from, |Known { rays, emitters, media }| {
                Integral::new(nodes).radiance(rays, emitters, media, &mut expected)
            });
            let lent = lend(&host, layout, from);
            let mut out = Column::new(layout, 5_000, 1);
            let mut values = airlight_values::default();
            values.value[0] = out.output();
            let options = airlight_options { nodes: count, ..options };
            // SAFETY: the columns have as many elements as the batch has rays.
            result(unsafe { airlight_radiance(&options, &lent.batch, &values, core::ptr::null_mut()) }).unwrap();
            assert_eq!(out.bits(5_000), bits(&expected));
        }
    }
}

#[test]
fn choices_are_those_of_rust() {
    let host = Host::new(8, 5_000, 1);
    let weights = [1.0, 20.0, 3.0];
    let table: Vec<Emitter> = host.emitters.iter().map(|e| emitter(e).unwrap()).collect();
    for (layout, from, options) in ways() {
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

#[test]
fn one_ray_is_a_batch_of_one() {
    let host = Host::new(9, 100, 1);
    for i in (0..100).filter(|i| i % 17 != 5) {
        let at = |columns: &[Vec<f32>; 3]| columns.each_ref().map(|column| column[i]);
        let (emitter, medium) = (host.emitters[i % 3], host.media[i % 3]);
        let (t_min, t_max) = (host.t_min[i], host.t_max[i]);
        let ray = airlight_ray { origin: at(&host.origin), direction: at(&host.direction), t_min, t_max };
        let scene = airlight_scene { ray, emitter, medium, ..Default::default() };
        let ray = airlight::Ray::new(ray.origin, ray.direction, t_min, t_max).unwrap();
        let emitter = self::emitter(&emitter).unwrap();
        let medium = Medium::new(medium.mu_a[0], medium.mu_s[0], medium.g).unwrap();
        let sampler = Sampler::new(Strategy::default());
        let (mut sample, mut value) = (airlight_one_sample::default(), [0.0; 4]);
        // SAFETY: pointers to what they are said to be.
        unsafe {
            result(airlight_sample_one(null(), &scene, host.u[i], &mut sample)).unwrap();
            result(airlight_pdf_one(null(), &scene, sample.t, &mut value[0])).unwrap();
            result(airlight_cdf_one(null(), &scene, sample.t, &mut value[1])).unwrap();
            result(airlight_evaluate_one(null(), &scene, sample.t, &mut value[2])).unwrap();
            result(airlight_radiance_one(null(), &scene, &mut value[3])).unwrap();
        }
        let expected = sampler.sample_one(&ray, &emitter, &medium, host.u[i]);
        let numbers = expected.map_or([0.0; 4], |s| [s.t, s.pdf, s.weight, s.r]);
        assert_eq!([sample.t, sample.pdf, sample.weight[0], sample.r], numbers);
        let integral = Integral::new(Nodes::Eight);
        let expected = [
            sampler.pdf_one(&ray, &emitter, &medium, sample.t),
            sampler.cdf_one(&ray, &emitter, &medium, sample.t),
            sampler.evaluate_one(&ray, &emitter, &medium, sample.t),
            integral.radiance_one(&ray, &emitter, &medium),
        ];
        assert_eq!(value, expected);
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
