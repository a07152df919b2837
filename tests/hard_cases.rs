//! Inputs that break renderers do not break this one: every bound holds on every family, and what is not a number or
//! beyond all range comes out finite, in range and counted.

use airlight::oracle::Scene;
use airlight::{Emitter, Integral, Medium, Nodes, Precision, Ray, Sampler, Strategy};
use airlight_tools::backends::distinct;
use airlight_tools::bounds::bounds;
use airlight_tools::errors::Errors;
use airlight_tools::families::Family;
use airlight_tools::samplers;
use glam::{EulerRot, Quat, Vec3};

const RAYS: usize = 1 << 14;

fn holds(family: Family) {
    // Few of arbitrary bits are rays: a quantile of 1 % needs more of them.
    let rays = if family == Family::RandomBits { 8 * RAYS } else { RAYS };
    let mut backends = 0;
    for backend in distinct() {
        backends += 1;
        for sampler in samplers::all() {
            let (strategy, precision) = (sampler.strategy(), sampler.precision());
            let sampler = sampler.with_backend(backend);
            let errors = Errors::measure(&sampler, family, rays, 201, |_| ());
            assert!(errors.sampled > rays / 40, "{strategy}, {precision}: {} of {rays} rays", errors.sampled);
            for bound in bounds(strategy, precision, family) {
                let (figure, value, limit) = (bound.figure, (bound.read)(&errors), bound.limit);
                assert!(
                    bound.holds(&errors),
                    "{strategy}, {precision} on {}, {}: {figure} {value:e} exceeds {limit:e}; worst {:?}",
                    family.name(),
                    backend.name(),
                    errors.worst
                );
            }
        }
    }
    assert!(backends > 0, "no backend was run");
}

#[test]
fn variates_at_the_ends_of_the_unit_interval() {
    holds(Family::Variate);
}

#[test]
fn emitters_on_the_ray() {
    holds(Family::NearEmitter);
}

#[test]
fn emitters_far_away() {
    holds(Family::FarAway);
}

#[test]
fn rays_without_end() {
    holds(Family::InfiniteRays);
}

#[test]
fn intervals_of_nanoradians() {
    holds(Family::ShortIntervals);
}

#[test]
fn emitters_that_turn_away() {
    holds(Family::Cosine);
}

#[test]
fn phase_functions_up_to_their_poles() {
    holds(Family::Phase);
}

#[test]
fn media_from_vacuum_to_ink() {
    holds(Family::Medium);
}

#[test]
fn rays_that_are_hardly_any() {
    holds(Family::Ray);
}

#[test]
fn arbitrary_bits() {
    holds(Family::RandomBits);
}

#[test]
fn peaks_of_the_phase_function_next_to_emitters() {
    holds(Family::Peaks);
}

#[test]
fn cones_of_spots() {
    holds(Family::Spot);
}

#[test]
fn channels_of_coloured_media() {
    holds(Family::Colour);
}

/// `N` is about `grade` all along the ray, 0 at t = 2: its squares leave f32, then its products, then `1/beta`.
#[test]
fn emitters_seen_edge_on() {
    let medium = Medium::new(0.1, 0.2, 0.6).unwrap();
    let lamp = Emitter::point_normal(Vec3::new(5.0, 1.0, 0.0), Vec3::Z).unwrap();
    for exponent in [9, 15, 19, 20, 21, 22, 24, 25, 26, 28, 30, 31, 34, 37, 38, 39, 41, 44] {
        let grade = 10f64.powi(-exponent) as f32;
        for t_max in [4.0, 10.0, f32::INFINITY] {
            let (origin, direction) = (Vec3::new(0.0, 0.0, -2.0 * grade), Vec3::new(1.0, 0.0, grade));
            let ray = Ray::new(origin, direction, 0.0, t_max).unwrap();
            let scene = Scene::new(&ray, &lamp, &medium);
            for backend in distinct() {
                for &strategy in Strategy::ALL {
                    for u in [0.1, 0.25, 0.5, 0.75, 0.9] {
                        let sample = Sampler::new(strategy).with_backend(backend).sample_one(&ray, &lamp, &medium, u);
                        let name = format!("{strategy}, {}, grade {grade:e}, t_max {t_max}, u {u}", backend.name());
                        let Some(sample) = sample else {
                            assert!(exponent > 24, "{name}: no sample");
                            continue;
                        };
                        let cdf = |t: f32| scene.cdf(strategy, t.into());
                        let (low, high) = (cdf(sample.t.next_down()), cdf(sample.t.next_up()));
                        let near = 1.0 / f64::from(1 << 20);
                        let inside = (low - near..=high + near).contains(&f64::from(u));
                        assert!(inside, "{name}: t {} with the CDF {low} to {high}", sample.t);
                        assert!(sample.pdf > 0.0 && sample.weight.is_finite(), "{name}: {sample:?}");
                    }
                }
            }
        }
    }
}

/// `N` is about `grade` all along the ray, which runs along no axis: the pdf keeps its digits, though `N` is the difference of
/// products that are rounded to 2^-24.
#[test]
fn emitters_seen_almost_edge_on_have_an_exact_pdf() {
    let medium = Medium::new(0.1, 0.2, 0.6).unwrap();
    let turned = Quat::from_euler(EulerRot::XYZ, 0.7, 0.4, 1.1);
    let at = Vec3::new(0.3, -1.2, 2.1);
    for (grade, steps) in [(1e-1f32, 40), (1e-2, 40), (1e-3, 40)] {
        for step in 0..steps {
            let slope = step as f32 / steps as f32;
            let normal = turned * Vec3::new(grade, slope * grade, 1.0).normalize();
            let lamp = Emitter::point_normal(at, normal).unwrap();
            let (start, along) = (Vec3::new(1.1 + slope, -2.3, 0.0), Vec3::new(0.1 * slope, 1.0, 0.0).normalize());
            let ray = Ray::new(at + turned * start, turned * along, 0.0, 4.0 + slope).unwrap();
            let scene = Scene::new(&ray, &lamp, &medium);
            for (backend, &strategy) in distinct().flat_map(|backend| Strategy::ALL.iter().map(move |s| (backend, s))) {
                let sampler = Sampler::new(strategy).with_backend(backend);
                for t in [0.5, 1.5, 2.5, 3.5] {
                    let (pdf, exact) = (sampler.pdf_one(&ray, &lamp, &medium, t), scene.pdf(strategy, t.into()));
                    let error = (f64::from(pdf) / exact - 1.0).abs() / f64::from(f32::EPSILON);
                    let name = format!("{strategy}, {}, grade {grade:e}, slope {slope}, t {t}", backend.name());
                    assert!(error <= 64.0, "{name}: {pdf:e} is off by {error} times 2^-23");
                }
            }
        }
    }
}

/// An emitter next to the ray sees what distances in metres leave of a direction's length: 1e-12 of it is 1e-5 of `h`.
#[test]
fn directions_not_quite_of_unit_length() {
    let medium = Medium::new(0.1, 0.2, 0.6).unwrap();
    let lamp = Emitter::point(Vec3::new(1.0, 2e-7, 0.0)).unwrap();
    for length in [0.9991, 0.9999, 1.0, 1.0001, 1.0009] {
        let ray = Ray::new(Vec3::ZERO, Vec3::X * length, 0.0, 2.0).unwrap();
        let scene = Scene::new(&ray, &lamp, &medium);
        for backend in distinct() {
            let sampler = Sampler::new(Strategy::EquiAngular).with_backend(backend);
            for t in [1.0f32.next_down(), 1.0, 1.0f32.next_up(), 1.0f32.next_up().next_up()] {
                let (f, exact) = (sampler.evaluate_one(&ray, &lamp, &medium, t), scene.integrand(t.into()));
                let error = (f64::from(f) / exact - 1.0).abs() / f64::from(f32::EPSILON);
                assert!(error <= 24.0, "{}, length {length}, t {t}: off by {error} times 2^-23", backend.name());
            }
        }
    }
}

/// `mu_s T`, the density times `r^2`, or `1/r^2` is beyond all of f32, although integrand, weight and integral are not.
#[test]
fn integrands_whose_parts_leave_f32() {
    let equi_angular = Strategy::EquiAngular;
    let point = |x: f32, y: f32| Emitter::point(Vec3::new(x, y, 0.0)).unwrap();
    let medium = |mu_t: f32, mu_s: f32, g: f32| Medium::new(mu_t - mu_s, mu_s, g).unwrap();
    let mut cases = Vec::new();
    for (size, mu_s) in [(1e-15f32, 1e-32), (1e-12, 1e-28), (1e-9, 1e-28)] {
        cases.push((equi_angular, medium(55.0 / size, mu_s, 0.6), point(0.5 * size, 0.2 * size), 2.0 * size, 0.6));
    }
    for mu_t in [1e3f32, 1e4, 1e5, 1e6] {
        let lamp = point(85.0 / mu_t, 0.5 / mu_t);
        cases.push((Strategy::Transmittance, medium(mu_t, mu_t, 0.0), lamp, 200.0 / mu_t, 1.0));
    }
    for (mu_s, g, r) in [(1.2e-38f32, 0.999_999_9, 1e6f32), (1.2e-38, 1.0f32.next_down(), 1e5), (1e-36, 0.999_999, 1e6)]
    {
        cases.push((equi_angular, medium(mu_s, mu_s, g), point(r, 0.0), 0.5 * r, 0.0));
    }
    for (strategy, medium, lamp, length, u) in cases {
        let ray = Ray::new(Vec3::ZERO, Vec3::X, 0.0, length).unwrap();
        let scene = Scene::new(&ray, &lamp, &medium);
        for backend in distinct() {
            let sampler = Sampler::new(strategy).with_backend(backend);
            let sample = sampler.sample_one(&ray, &lamp, &medium, u).unwrap();
            let t = f64::from(sample.t);
            let integrand = sampler.evaluate_one(&ray, &lamp, &medium, sample.t);
            let integral = Integral::new(Nodes::Twelve).with_backend(backend).radiance_one(&ray, &lamp, &medium);
            // That of the pdf that was returned: its rounding is tested elsewhere.
            let weight = scene.integrand(t) / f64::from(sample.pdf);
            for (what, value, exact, bound) in [
                ("integrand", integrand, scene.integrand(t), 1e-5),
                ("weight", sample.weight, weight, 1e-4),
                ("integral", integral, scene.radiance(), 1e-3),
            ] {
                let error = (f64::from(value) / exact - 1.0).abs();
                let name = format!("{what}, {strategy}, {}, {medium:?}, length {length:e}", backend.name());
                assert!(error <= bound, "{name}: {value:e} in place of {exact:e}");
            }
        }
    }
}

/// The lit part ends half of `h` before the foot, and `h` is 1e-9 of `t`: an f32 and the remainder of its rounding have too few
/// digits for `t'` at this end.
#[test]
fn a_lit_part_that_ends_at_the_foot_has_an_exact_cdf() {
    let medium = Medium::new(5e-3, 0.02, 0.999_907_4).unwrap();
    let position = Vec3::new(-0.064_836_405, -4.146_048_5, 0.617_648_84);
    let lamp = Emitter::point_normal(position, Vec3::new(-0.842_351_4, 0.522_521_14, 0.131_968_74)).unwrap();
    let direction = Vec3::new(-0.015_465_578, -0.988_966_6, 0.147_329_21);
    let ray = Ray::new(Vec3::ZERO, direction, 2.948_009_7, 10.0).unwrap();
    let scene = Scene::new(&ray, &lamp, &medium);
    for strategy in [Strategy::Product3, Strategy::Product5, Strategy::Product9, Strategy::Product17] {
        for backend in distinct() {
            let sampler = Sampler::new(strategy).with_backend(backend);
            let mut t = scene.lit().unwrap().1 as f32;
            for _ in 0..200 {
                t = t.next_down();
                let (cdf, exact) = (sampler.cdf_one(&ray, &lamp, &medium, t), scene.cdf(strategy, t.into()));
                let error = (f64::from(cdf) - exact).abs();
                assert!(error <= 5e-7, "{strategy}, {}, t {t}: {cdf} in place of {exact}", backend.name());
            }
        }
    }
}

/// It subtends less than 1e-30 rad, which only a density that does not ask for the angle can do with.
#[test]
fn a_ray_too_short_for_angles() {
    let medium = Medium::new(0.0, 1e-4, 0.6).unwrap();
    let lamp = Emitter::point(Vec3::new(1e4, 0.0, 0.0)).unwrap();
    let ray = Ray::new(Vec3::ZERO, Vec3::X, 0.0, 5e-18).unwrap();
    for &strategy in Strategy::ALL {
        let sampler = Sampler::new(strategy);
        let sample = sampler.sample_one(&ray, &lamp, &medium, 0.5);
        assert_eq!(sample.is_some(), strategy == Strategy::Transmittance, "{strategy}");
        if let Some(sample) = sample {
            let f = sampler.evaluate_one(&ray, &lamp, &medium, sample.t);
            assert!(f > 0.0 && (sample.weight * sample.pdf / f - 1.0).abs() < 1e-5, "{sample:?}, f {f:e}");
        }
    }
}

/// It faces the ray from 1e-20 m away: the cosines at both ends are as small, that between them is 1.
#[test]
fn an_emitter_that_faces_a_ray_next_to_it_lights_it() {
    let medium = Medium::new(0.1, 0.2, 0.6).unwrap();
    for h in [1e-12, 1e-16, 1e-20, 1e-23] {
        let lamp = Emitter::point_normal(Vec3::new(1.0, h, 0.0), Vec3::NEG_Y).unwrap();
        let ray = Ray::new(Vec3::ZERO, Vec3::X, 0.0, 2.0).unwrap();
        let scene = Scene::new(&ray, &lamp, &medium);
        for (backend, &strategy) in distinct().flat_map(|backend| Strategy::ALL.iter().map(move |s| (backend, s))) {
            let sampler = Sampler::new(strategy).with_backend(backend);
            for u in [0.1, 0.5, 0.9] {
                let name = format!("{strategy}, {}, h {h:e}, u {u}", backend.name());
                let sample = sampler.sample_one(&ray, &lamp, &medium, u).expect(&name);
                let cdf = |t: f32| scene.cdf(strategy, t.into());
                let (low, high) = (cdf(sample.t.next_down()), cdf(sample.t.next_up()));
                let near = 1.0 / f64::from(1 << 20);
                assert!((low - near..=high + near).contains(&f64::from(u)), "{name}: CDF {low} to {high}");
            }
        }
    }
}

/// The same emitters by `Fast`, which may miss their light but not place it beyond the plane.
#[test]
fn emitters_seen_edge_on_are_sampled_on_their_side_of_the_plane() {
    let medium = Medium::new(0.1, 0.2, 0.6).unwrap();
    for exponent in 9..=44 {
        let grade = 10f64.powi(-exponent) as f32;
        for (side, normal) in [(1.0f32, Vec3::new(0.0, 0.0, 1.0)), (-1.0, Vec3::new(0.0, -1.0, grade))] {
            // The plane is met at t = 2, by a slope of `grade` either way.
            let (origin, direction, at) = if side > 0.0 {
                (Vec3::new(0.0, 0.0, -2.0 * grade), Vec3::new(1.0, 0.0, grade), Vec3::new(5.0, 1.0, 0.0))
            } else {
                (Vec3::new(3.0, -1.0, 2.0), Vec3::NEG_Z, Vec3::new(-3.0, -1.0, 0.0))
            };
            let lamp = Emitter::point_normal(at, normal).unwrap();
            let ray = Ray::new(origin, direction, 0.0, f32::INFINITY).unwrap();
            for (backend, &strategy) in distinct().flat_map(|backend| Strategy::ALL.iter().map(move |s| (backend, s))) {
                let Ok(sampler) = Sampler::new(strategy).with_precision(Precision::Fast) else { continue };
                for u in [0.0, 0.05, 0.5, 0.95, 1.0] {
                    let Some(sample) = sampler.with_backend(backend).sample_one(&ray, &lamp, &medium, u) else {
                        continue;
                    };
                    let lit = if side > 0.0 { 1.999..=1e18 } else { 0.0..=2.001 };
                    let name = format!("{strategy}, {}, grade {grade:e}, side {side}, u {u}", backend.name());
                    assert!(lit.contains(&sample.t) && sample.pdf >= 0.0 && sample.weight >= 0.0, "{name}: {sample:?}");
                }
            }
        }
    }
}
