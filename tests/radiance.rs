//! The integral of the airlight: how near it is to quadrature of the integrand, which knows nothing of its rule, on every
//! family of hard inputs, and that what is written for a ray depends on that ray alone.

mod scenes;

use airlight::oracle::Scene;
use airlight::oracle::quadrature::integrate_pieces;
use airlight::{
    Backend, Counts, Emitter, Emitters, Integral, Media, Medium, Nodes, Precision, Ray, Rays, UnknownNodes,
};
use airlight_tools::errors::{grazes_a_cone, is_comparable, quantile};
use airlight_tools::families::{CHANNELS, Case, Columns, Family};
use glam::Vec3;
use scenes::Random;
use std::ops::Range;

const RAYS: usize = 1 << 13;
const SEEDS: [u64; 2] = [8, 9];
/// Rays that a batch is cut into chunks of.
const CHUNK: usize = 4096;

/// The relative errors that half of the rays stay below, 99 % and all of them.
type Bounds = [f64; 3];

/// The table of the documentation: of a family the bounds for every number of nodes.
fn stated(family: Family) -> Vec<Bounds> {
    let table = include_str!("../src/integral/errors.md");
    let name = format!("| `{}`", family.name());
    let row = table.lines().find(|line| line.starts_with(&name)).unwrap_or_else(|| panic!("{name} has no row"));
    let bounds = |cell: &str| -> Bounds {
        let numbers: Vec<f64> = cell.split(',').map(|number| number.trim().parse().unwrap()).collect();
        numbers.try_into().unwrap_or_else(|_| panic!("{cell}: median, 99 % and all"))
    };
    row.trim_matches('|').split('|').skip(1).map(bounds).collect()
}

fn text(values: Bounds) -> String {
    values.map(|value| format!("{value:.1e}")).join(", ")
}

fn radiances(integral: &Integral, cases: &[Case]) -> (Vec<f32>, Counts) {
    let columns = Columns::new(cases);
    let mut radiances = [(); CHANNELS].map(|()| vec![f32::NAN; cases.len()]);
    let counts = columns.integrate(integral, &mut radiances).unwrap();
    (cases.iter().enumerate().map(|(i, case)| radiances[case.channel()][i]).collect(), counts)
}

/// The cases of a family, with the scenes and the radiances of those that are valid and of resolved size.
fn cases(family: Family, seed: u64, count: usize) -> (Vec<Case>, Vec<Option<(Scene, f64)>>) {
    let cases: Vec<Case> = (0..count as u64).map(|i| family.case(seed, i)).collect();
    let scene = |case: &Case| {
        let (ray, emitter, medium) = case.parts().ok()?;
        let scene = Scene::new(&ray, &emitter, &medium);
        (!case.is_extreme() && !grazes_a_cone(&scene, &ray, &emitter)).then(|| (scene, scene.radiance()))
    };
    let scenes = cases.iter().map(scene).collect();
    (cases, scenes)
}

/// The errors of the cases of which f32 has the radiance, ascending; the others are held to be small, and invalid ones 0.
fn errors(cases: &[Case], scenes: &[Option<(Scene, f64)>], radiances: &[f32], place: &str) -> Vec<f64> {
    let mut errors = Vec::new();
    for ((case, scene), &found) in cases.iter().zip(scenes).zip(radiances) {
        assert!(found.is_finite() && found >= 0.0, "{place}: {found} of {case:?}");
        let found = f64::from(found);
        match scene {
            Some((scene, radiance)) if is_comparable(scene, *radiance) => errors.push((found / radiance - 1.0).abs()),
            // Too small for f32, or for its digits: 0, or about as small.
            Some((_, radiance)) => {
                let most = if *radiance > 0.0 { 2.0 * radiance + 1e-37 } else { 0.0 };
                assert!(found <= most, "{place}: {found:e} is not {radiance:e}, {case:?}");
            }
            None if case.scene().is_err() => assert_eq!(found, 0.0, "{place}: {case:?}"),
            None => {}
        }
    }
    errors.sort_unstable_by(f64::total_cmp);
    errors
}

#[test]
fn errors_are_as_stated_in_every_family() {
    let mut broken = Vec::new();
    for (family, seed) in Family::ALL.into_iter().flat_map(|family| SEEDS.map(|seed| (family, seed))) {
        // Of the same rays.
        if family == Family::Variate {
            continue;
        }
        let (cases, scenes) = cases(family, seed, RAYS);
        let stated = stated(family);
        assert_eq!(stated.len(), Nodes::ALL.len());
        for (&nodes, bounds) in Nodes::ALL.iter().zip(stated) {
            let place = format!("{:16} {nodes:2} nodes, seed {seed}", family.name());
            let (radiances, _) = radiances(&Integral::new(nodes), &cases);
            let errors = errors(&cases, &scenes, &radiances, &place);
            assert!(errors.len() > RAYS / 64, "{place}: {} rays compared", errors.len());
            let figures = [0.5, 0.99, 1.0].map(|p| quantile(&errors, p));
            let line = format!("{place}: {} of {}", text(figures), text(bounds));
            println!("{line}");
            if figures.iter().zip(bounds).any(|(figure, bound)| *figure > bound) {
                broken.push(line);
            }
        }
    }
    assert!(broken.is_empty(), "{broken:#?}");
}

/// Where they are not, light is misjudged: next to the plane of the emitter.
#[test]
fn geometry_in_f32_costs_few_digits_in_ordinary_scenes() {
    let fast = Integral::new(Nodes::Twelve).with_precision(Precision::Fast);
    assert_eq!((fast.nodes(), fast.precision()), (Nodes::Twelve, Precision::Fast));
    for family in [Family::Generic, Family::FarAway, Family::Phase, Family::Medium, Family::Ray] {
        let (cases, scenes) = cases(family, SEEDS[0], RAYS);
        let find = |integral: &Integral| {
            let (radiances, _) = radiances(integral, &cases);
            let compared = scenes.iter().zip(radiances).filter_map(|(scene, found)| {
                let (scene, radiance) = scene.as_ref()?;
                is_comparable(scene, *radiance).then(|| (f64::from(found) / radiance - 1.0).abs())
            });
            let mut errors: Vec<f64> = compared.collect();
            errors.sort_unstable_by(f64::total_cmp);
            quantile(&errors, 0.99)
        };
        let [exact, fast] = [Integral::new(Nodes::Twelve), fast].map(|integral| find(&integral));
        println!("{:10} {exact:.1e} {fast:.1e}", family.name());
        assert!(fast <= exact + 1.2e-5, "{}: {fast:e}, exact {exact:e}", family.name());
    }
}

/// By Gauss and Legendre's rule over the distance, in pieces a quarter of a decade wide around the foot of the
/// perpendicular and behind both ends, halved where the falloff of a spot begins or ends; and how far the rounding of the distances may move it, relative.
fn radiance_over_distance(scene: &Scene) -> Option<(f64, f64)> {
    const RATIO: f64 = 1.778_279_41;
    let (t_a, t_b) = scene.lit()?;
    let (length, t_h) = (t_b - t_a, scene.t_h());
    let finest = 1e-6 * scene.h().min(length).min(1.0 / scene.mu_t());
    let farthest = length.max((t_b - t_h).abs()).max((t_a - t_h).abs());
    let away = std::iter::successors(Some(finest), |x| Some(x * RATIO)).take_while(|&x| x < farthest);
    let mut ends: Vec<f64> = away.flat_map(|x| [t_a + x, t_b - x, t_h - x, t_h + x]).chain([t_h]).collect();
    ends.retain(|t| (t_a..t_b).contains(t));
    ends.extend([t_a, t_b]);
    ends.sort_by(f64::total_cmp);
    let radiance = integrate_pieces(|t| scene.integrand(t), &ends, 1e-11);
    let near = t_a.max(t_b.min(t_a + 1e3 * scene.h()));
    let rounding = f64::EPSILON * near.max(t_h.abs()) / scene.h().min(length);
    Some((radiance, rounding))
}

/// On peaks, next to emitters and on infinite rays: two quadratures that share the integrand alone.
#[test]
fn the_oracle_is_the_integral_over_distance() {
    for (family, seed) in Family::ALL.into_iter().flat_map(|family| SEEDS.map(|seed| (family, seed))) {
        let (cases, scenes) = cases(family, seed, RAYS / 16);
        let mut compared = 0;
        for (case, scene) in cases.iter().zip(scenes) {
            let Some((scene, radiance)) = scene.filter(|(_, radiance)| *radiance > 1e-200) else { continue };
            let Some((expected, rounding)) = radiance_over_distance(&scene) else { continue };
            let error = (radiance / expected - 1.0).abs();
            let allowed = 1e-9 + 8.0 * rounding;
            assert!(error <= allowed, "{}, seed {seed}: {radiance:e} is not {expected:e}, {case:?}", family.name());
            compared += 1;
        }
        assert!(compared > 10, "{}, seed {seed}: {compared} compared", family.name());
    }
}

/// A ray from the origin along z.
fn along_z(t_max: f32) -> Ray {
    Ray::new(Vec3::ZERO, Vec3::Z, 0.0, t_max).unwrap()
}

fn near(value: f64, exact: f64, share: f64) -> bool {
    (value - exact).abs() <= share * exact
}

/// Beside the peak the radiance is proportional to `1 - |g|`, on it to `1/(1 - |g|)^2` or so.
#[test]
fn peaks_have_their_height_up_to_g_1() {
    let (beside, on) = (Vec3::new(1.0, 0.0, 5.0), Vec3::new(5e-4, 0.0, 10.0));
    for (lamp, t_max, g, expected) in [
        (beside, 10.0, 0.9999, 7.83e-6),
        (beside, 10.0, 0.99999, 7.84e-7),
        (beside, 10.0, 1.0, 0.0),
        (beside, 10.0, -1.0, 0.0),
        (on, 8.0, 0.9999, 8417.0),
        (on, 8.0, 1.0, 0.0),
    ] {
        let (ray, emitter) = (along_z(t_max), Emitter::point(lamp).unwrap());
        let medium = Medium::new(0.1, 0.3, g).unwrap();
        let radiance = Scene::new(&ray, &emitter, &medium).radiance();
        assert!(near(radiance, expected, 1e-3), "quadrature: {radiance:e} is not {expected:e}, g = {g}, {lamp}");
        for (&nodes, allowed) in Nodes::ALL.iter().zip([0.02, 2e-3, 2e-4, 1e-5]) {
            let found = f64::from(Integral::new(nodes).radiance_one(&ray, &emitter, &medium));
            assert!(near(found, radiance, allowed), "{nodes} nodes: {found:e} is not {radiance:e}, g = {g}, {lamp}");
        }
    }
}

/// Rays that start at, before and behind the emitter, for every `g`; with twelve nodes. Next to an emitter that shines across
/// the ray the backward peak is at `h`, where N is, and at `h (1 - g)/(1 + g)`: one map cannot serve both as well.
#[test]
fn every_g_is_right() {
    let sizes = [0.0, 0.3, 0.6, 0.9, 0.99, 0.999, 0.9999, 0.999_99, 1.0 - f32::EPSILON / 2.0];
    for g in sizes.into_iter().flat_map(|g| [g, -g]) {
        let medium = Medium::new(0.2, 0.5, g).unwrap();
        for (height, along) in [(1.0, 0.0), (1.0, 4.0), (0.1, -3.0), (1e-3, 4.0), (3.0, 20.0), (0.0, 4.0)] {
            for (normal, t_max) in [(None, 9.0), (Some(Vec3::NEG_X), 9.0), (Some(Vec3::Z), f32::INFINITY)] {
                let (ray, position) = (along_z(t_max), Vec3::new(height, 0.0, along));
                let emitter = normal.map_or(Emitter::point(position), |n| Emitter::point_normal(position, n)).unwrap();
                let scene = Scene::new(&ray, &emitter, &medium);
                let (radiance, found) =
                    (scene.radiance(), Integral::new(Nodes::Twelve).radiance_one(&ray, &emitter, &medium));
                let error = (f64::from(found) - radiance).abs();
                let two_scales = g < -0.7 && height == 1e-3 && normal == Some(Vec3::NEG_X);
                assert!(
                    error <= if two_scales { 3e-3 } else { 1e-4 } * radiance,
                    "g = {g}, {emitter:?}, t_max = {t_max}: {found:e} is not {radiance:e}"
                );
            }
        }
    }
}

/// Without attenuation the integral is that of `1/r^2`: an angle.
#[test]
fn a_medium_that_hardly_attenuates_is_elementary() {
    let mu_s = 1e-25f32;
    let medium = Medium::new(0.0, mu_s, 0.0).unwrap();
    for (height, along, t_max) in [(1.0, 0.0, f32::INFINITY), (2.0, 3.0, f32::INFINITY), (0.5, 2.0, 4.0)] {
        let emitter = Emitter::point(Vec3::new(height, 0.0, along)).unwrap();
        let angle = f64::from((t_max - along) / height).atan() + f64::from(along / height).atan();
        let expected = f64::from(mu_s) * angle / (4.0 * std::f64::consts::PI * f64::from(height));
        let found = f64::from(Integral::new(Nodes::Twelve).radiance_one(&along_z(t_max), &emitter, &medium));
        assert!(near(found, expected, 1e-6), "{found:e} is not {expected:e}, lamp at {height}, {along}");
    }
}

#[test]
fn no_light_is_none() {
    let (lamp, fog) = (Vec3::new(1.0, 0.0, 3.0), Medium::new(0.1, 0.3, 0.5).unwrap());
    let point = Emitter::point(lamp).unwrap();
    let back = Emitter::point_normal(lamp, Vec3::X).unwrap();
    let vacuum = Medium::new(0.0, 0.0, 0.5).unwrap();
    let absorber = Medium::new(1.0, 0.0, 0.5).unwrap();
    let wall = Medium::new(1e4, 1e4, 0.5).unwrap();
    let (ray, endless) = (along_z(9.0), along_z(f32::INFINITY));
    let empty = Ray::new(Vec3::ZERO, Vec3::Z, 2.0, 2.0).unwrap();
    for &nodes in Nodes::ALL {
        let integral = Integral::new(nodes);
        for (ray, emitter, medium) in [
            (ray, back, fog),
            (empty, point, fog),
            (ray, point, vacuum),
            (endless, point, vacuum),
            (endless, point, absorber),
            (endless, point, wall),
        ] {
            assert_eq!(
                integral.radiance_one(&ray, &emitter, &medium),
                0.0,
                "{nodes}: {ray:?}, {emitter:?}, {medium:?}"
            );
        }
        assert!(integral.radiance_one(&ray, &point, &fog) > 0.0);
    }
}

/// All extremes of everything at once.
#[test]
fn what_leaves_f32_is_finite_and_not_negative() {
    let media = [0.0, 1e-38, 1e-20, 1.0, 1e9, 1e18, 1.5e38];
    let lengths = [0.0, 1e-30, 1e-18, 1e-6, 1.0, 1e9, 1e18];
    let mut seen = 0;
    for (mu, g) in media.into_iter().flat_map(|mu| [-1.0, -0.999_999_9, 0.0, 0.9, 1.0].map(|g| (mu, g))) {
        let medium = Medium::new(mu, mu, g).unwrap();
        for (height, along) in lengths.into_iter().flat_map(|height| lengths.map(|along| (height, along))) {
            let position = Vec3::new(height, 0.0, along);
            for emitter in [Emitter::point(position)]
                .into_iter()
                .chain([Vec3::NEG_X, Vec3::Z, Vec3::NEG_Z].map(|n| Emitter::point_normal(position, n)))
            {
                for t_max in [1e-18, 1.0, 1e18, f32::INFINITY] {
                    let emitter = emitter.unwrap();
                    let found = Integral::new(Nodes::Twelve).radiance_one(&along_z(t_max), &emitter, &medium);
                    assert!(found.is_finite() && found >= 0.0, "{found}: {medium:?}, {emitter:?}, t_max = {t_max}");
                    if (1e-20..=1e9).contains(&mu) {
                        let radiance = Scene::new(&along_z(t_max), &emitter, &medium).radiance();
                        assert!(
                            f64::from(found) <= 2.0 * radiance + 1e-37,
                            "{found:e} is not {radiance:e}: {medium:?}, {emitter:?}, t_max = {t_max}"
                        );
                    }
                    seen += usize::from(found > 0.0);
                }
            }
        }
    }
    assert!(seen > 100, "{seen} are lit");
}

#[test]
fn every_ray_is_counted() {
    let (cases, scenes) = cases(Family::Ray, 8, RAYS);
    let lit = scenes.iter().flatten().filter(|(_, radiance)| *radiance > 0.0).count();
    let invalid = cases.iter().filter(|case| case.scene().is_err()).count();
    assert!(lit > RAYS / 8 && invalid > RAYS / 8);
    for &nodes in Nodes::ALL {
        let (_, counts) = radiances(&Integral::new(nodes), &cases);
        assert_eq!((counts.sampled, counts.invalid), (lit, invalid), "{nodes}");
        assert_eq!(counts.empty, RAYS - lit - invalid, "{nodes}");
    }
}

/// Random rays, some of them with spots, and the bits of each alone.
struct Alone {
    columns: scenes::Columns,
    bits: Vec<u32>,
}

impl Alone {
    fn new(integral: &Integral, n: usize) -> Self {
        let mut random = Random::new(8);
        let cases: Vec<scenes::Case> = (0..n).map(|_| random.case_or_spot()).collect();
        let one = |case: &scenes::Case| integral.radiance_one(&case.ray, &case.emitter, &case.medium).to_bits();
        let bits = cases.iter().map(one).collect();
        Self { columns: scenes::Columns::new(cases.into_iter().map(|case| (case, 0.0))), bits }
    }

    /// Asserts that the rays of a range have in a batch of their own the bits that they have alone.
    fn hold(&self, integral: &Integral, range: Range<usize>, place: &str) {
        let (rays, emitters) = (self.columns.rays(range.clone()), self.columns.emitters(range.clone()));
        let media = self.columns.media(range.clone());
        let mut found = vec![f32::NAN; range.len()];
        let counts = integral.radiance(&rays, &emitters, &media, &mut found).unwrap();
        assert_eq!(counts.sampled + counts.empty, range.len());
        for (i, value) in range.clone().zip(found) {
            assert_eq!(value.to_bits(), self.bits[i], "ray {i} of {range:?} is {value}, {place}");
        }
    }
}

#[test]
fn any_length_place_and_backend_and_one_by_one() {
    for backend in Backend::available() {
        for &nodes in Nodes::ALL {
            let integral = Integral::new(nodes).with_backend(backend);
            let alone = Alone::new(&integral, 2 * CHUNK + 9);
            let place = format!("{nodes} nodes on {}", backend.name());
            for n in (0..=70).chain(CHUNK - 9..=CHUNK + 9).chain([2 * CHUNK + 9]) {
                alone.hold(&integral, 0..n, &place);
            }
            for start in 0..40 {
                alone.hold(&integral, start..100, &place);
            }
        }
    }
}

#[cfg(feature = "rayon")]
#[test]
fn any_number_of_threads() {
    let integral = Integral::new(Nodes::Eight);
    let alone = Alone::new(&integral, 11 * CHUNK + 7);
    for n in [1, 2, 3] {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(n).build().unwrap();
        pool.install(|| alone.hold(&integral, 0..alone.bits.len(), &format!("{n} threads")));
    }
}

/// One for all is the same for each.
#[test]
fn one_emitter_and_medium_for_all() {
    let mut random = Random::new(9);
    for emitter in [random.case().emitter, random.spot()] {
        let case = scenes::Case { emitter, ..random.case() };
        let rows = (0..99).map(|_| (scenes::Case { ray: random.case().ray, ..case }, 0.0));
        let columns = scenes::Columns::new(rows);
        let integral = Integral::new(Nodes::Six);
        let find = |emitters: &Emitters<'_>, media: &Media<'_>| {
            let mut found = vec![f32::NAN; columns.len()];
            integral.radiance(&columns.rays(0..99), emitters, media, &mut found).unwrap();
            found
        };
        let each = find(&columns.emitters(0..99), &columns.media(0..99));
        assert_eq!(find(&Emitters::one(case.emitter), &Media::one(case.medium)), each);
        assert!(each.iter().any(|radiance| *radiance > 0.0), "{emitter:?}");
    }
}

#[test]
fn a_column_of_another_length_is_named() {
    let zero = [0.0; 3];
    let one = [1.0; 3];
    let rays = Rays::new([&zero; 3], [&zero, &zero, &one], &zero, &one);
    let emitters = Emitters::one(Emitter::point(Vec3::X).unwrap());
    let media = Media::one(Medium::new(0.1, 0.1, 0.0).unwrap());
    let mut out = [f32::NAN; 2];
    let result = Integral::new(Nodes::Eight).radiance(&rays, &emitters, &media, &mut out);
    assert_eq!(result.unwrap_err().to_string(), "radiance has 2 elements, expected 3");
    let short = Rays::new(rays.origin, rays.direction, &zero[1..], rays.t_max);
    let result = Integral::new(Nodes::Eight).radiance(&short, &emitters, &media, &mut out);
    assert_eq!(result.unwrap_err().to_string(), "rays.t_min has 2 elements, expected 3");
    assert!(out.iter().all(|value| value.is_nan()));
}

#[test]
fn nodes_that_are_not_offered_are_refused() {
    let error: UnknownNodes = "5".parse::<Nodes>().unwrap_err();
    assert_eq!(error.to_string(), "no integral has '5' nodes; there are 4, 6, 8, 12");
}
