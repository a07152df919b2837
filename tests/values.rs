//! Rays, emitters, media, samplers and integrals give back what they were made of.

use airlight::{Backend, Emitter, Integral, Medium, Nodes, Precision, Ray, Rays, Sampler, Strategy, Threads};

const POSITION: [f32; 3] = [1.0, -2.0, 3.0];
const UNIT: [f32; 3] = [0.0, -0.6, 0.8];

#[test]
fn rays() {
    let ray = Ray::new(POSITION, UNIT, 0.5, 7.0).unwrap();
    assert_eq!((ray.origin(), ray.direction(), ray.t_min(), ray.t_max()), (POSITION, UNIT, 0.5, 7.0));
    for n in 0..3 {
        let column = &[0.0; 2][..n];
        let rays = Rays::new([column; 3], [column; 3], column, column);
        assert_eq!((rays.len(), rays.is_empty()), (column.len(), column.is_empty()));
    }
}

#[test]
fn emitters() {
    let point = Emitter::point(POSITION).unwrap();
    assert_eq!((point.position(), point.normal(), point.cone()), (POSITION, None, None));
    let facing = Emitter::point_normal(POSITION, UNIT).unwrap();
    assert_eq!((facing.position(), facing.normal(), facing.cone()), (POSITION, Some(UNIT), None));
    let spot = Emitter::spot(POSITION, UNIT, 0.25, 0.75).unwrap();
    assert_eq!((spot.position(), spot.normal()), (POSITION, None));
    let cone = spot.cone().unwrap();
    assert_eq!((cone.axis(), cone.cos_outer(), cone.cos_inner()), (UNIT, 0.25, 0.75));
}

#[test]
fn media() {
    let medium = Medium::new(0.25, 0.5, -0.75).unwrap();
    assert_eq!((medium.mu_a(), medium.mu_s(), medium.mu_t(), medium.g()), (0.25, 0.5, 0.75, -0.75));
}

#[test]
fn a_coloured_medium_has_its_channels_and_their_mean() {
    let medium = Medium::coloured([0.1, 0.2, 0.0], [0.3, 0.1, 1.0], 0.5).unwrap();
    assert_eq!(medium.channels(), 3);
    assert_eq!(medium.channel(1), Some(Medium::new(0.2, 0.1, 0.5).unwrap()));
    assert_eq!(medium.channel(3), None);
    let third = |sum: f64| (sum / 3.0) as f32;
    let (a, s) = ([0.1f32, 0.2, 0.0], [0.3f32, 0.1, 1.0]);
    let [a, s] = [a, s].map(|of| third(of.map(f64::from).iter().sum()));
    assert_eq!((medium.mu_a(), medium.mu_s(), medium.mu_t()), (a, s, a + s));
    assert_eq!(medium.mean(), Medium::new(a, s, 0.5).unwrap());
    // of the channels that scatter, or of all
    let medium = Medium::coloured([0.5, 9.0, 0.7, 8.0], [2.0, 0.0, 4.0, 0.0], 0.0).unwrap();
    assert_eq!((medium.mu_a(), medium.mu_s()), (0.6, 3.0));
    assert_eq!(Medium::coloured([1.0, 2.0, 3.0], [0.0; 3], 0.0).unwrap().mu_t(), 2.0);
    // grey
    let grey = Medium::new(0.1, 0.2, 0.3).unwrap();
    assert_eq!(Medium::coloured([0.1], [0.2], 0.3).unwrap(), grey);
    assert_eq!((grey.channels(), grey.channel(0), grey.channel(1), grey.mean()), (1, Some(grey), None, grey));
    assert_eq!(Medium::coloured([0.1; 3], [0.2; 3], 0.3).unwrap().mean(), grey);
}

#[test]
fn samplers_and_integrals() {
    let threads = [Threads::Pool, Threads::at_most(3), Threads::Caller];
    for (backend, threads) in Backend::available().flat_map(|backend| threads.map(|threads| (backend, threads))) {
        for &precision in Precision::ALL {
            for &strategy in Strategy::ALL {
                let sampler = Sampler::new(strategy).with_backend(backend).with_threads(threads);
                assert_eq!((sampler.precision(), sampler.strategy()), (Precision::Exact, strategy));
                let Ok(sampler) = sampler.with_precision(precision) else { continue };
                assert_eq!((sampler.strategy(), sampler.precision()), (strategy, precision));
                assert_eq!((sampler.backend().name(), sampler.threads()), (backend.name(), threads));
            }
            for &nodes in Nodes::ALL {
                let integral = Integral::new(nodes).with_backend(backend).with_threads(threads);
                let integral = integral.with_precision(precision);
                assert_eq!((integral.nodes(), integral.precision()), (nodes, precision));
                assert_eq!((integral.backend().name(), integral.threads()), (backend.name(), threads));
            }
        }
    }
}

/// The fastest first, each under its name; the portable one is everywhere.
#[test]
fn backends() {
    let known = ["avx512", "avx2", "portable", "scalar"];
    let names: Vec<&str> = Backend::available().map(Backend::name).collect();
    let in_order: Vec<&str> = known.into_iter().filter(|name| names.contains(name)).collect();
    assert_eq!(names, in_order);
    assert!(names.contains(&"portable"), "{names:?}");
    assert_eq!(Backend::detect().name(), names[0]);
    assert_eq!(Sampler::new(Strategy::EquiAngular).backend().name(), names[0]);
}

/// None is the caller's thread alone.
#[test]
fn threads() {
    assert_eq!(Threads::default(), Threads::Pool);
    assert_eq!(Threads::at_most(0), Threads::Caller);
    assert!(matches!(Threads::at_most(3), Threads::AtMost(threads) if threads.get() == 3));
}
