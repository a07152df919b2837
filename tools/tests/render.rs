//! `airlight render` as it is met from outside, and its pictures held against quadrature.

use airlight::{Emitter, Medium, Precision, Ray, Sampler, Strategy, oracle};
use airlight_tools::renderer::camera::{Camera, View};
use airlight_tools::renderer::emitter_choice::EmitterChoice;
use airlight_tools::renderer::film::{Film, Layer};
use airlight_tools::renderer::picture::Size;
use airlight_tools::renderer::scene::{Light, Object, Scene, Shape};
use airlight_tools::renderer::scenes::Name;
use airlight_tools::renderer::shadow::Shadows;
use airlight_tools::renderer::variate::{Dimension, Sequence, Variates};
use airlight_tools::renderer::{Renderer, Settings};
use glam::{DVec3, Vec3};
use serde_json::Value;
use std::f64::consts::{FRAC_1_PI, FRAC_PI_2};
use std::fs;
use std::path::Path;
use std::process::{Command, Output};
use tempfile::TempDir;

const SIZE: Size = Size { width: 12, height: 8 };
/// Side of a tile; the pictures have six.
const TILE: usize = 4;
/// Standard errors of which one in three million estimates is farther off.
const FAR: f64 = 5.0;
const SEED: u64 = 11;

fn render(arguments: &[&str]) -> Output {
    Command::new(env!("CARGO_BIN_EXE_airlight")).arg("render").args(arguments).output().unwrap()
}

/// Standard output of a run that must succeed and say nothing on standard error.
fn succeed(arguments: &[&str]) -> String {
    let output = render(arguments);
    let stderr = String::from_utf8(output.stderr).unwrap();
    assert_eq!((output.status.code(), &*stderr), (Some(0), ""), "{arguments:?}");
    String::from_utf8(output.stdout).unwrap()
}

/// Standard output of a run that must succeed and say on standard error that it writes no picture.
fn succeed_without_a_picture(arguments: &[&str]) -> String {
    let output = render(arguments);
    let stderr = String::from_utf8(output.stderr).unwrap();
    let told = "no picture is written without --out\n";
    assert_eq!((output.status.code(), &*stderr), (Some(0), told), "{arguments:?}");
    String::from_utf8(output.stdout).unwrap()
}

/// The one line on standard error of a run that must fail.
fn fail(arguments: &[&str]) -> String {
    let output = render(arguments);
    let stderr = String::from_utf8(output.stderr).unwrap();
    assert_eq!((output.status.code(), output.stdout.len()), (Some(2), 0), "{arguments:?}: {stderr}");
    assert!(stderr.starts_with("error: ") && stderr.lines().count() == 1, "{arguments:?}: {stderr}");
    stderr
}

fn text(path: &Path) -> &str {
    path.to_str().unwrap()
}

/// A ray of the renderer, and what it meets, found anew in f64.
struct Sight {
    origin: Vec3,
    direction: Vec3,
    t_max: f64,
    object: Option<usize>,
}

impl Sight {
    fn new(scene: &Scene, origin: Vec3, direction: Vec3) -> Self {
        let mut sight = Self { origin, direction, t_max: f64::INFINITY, object: None };
        for (number, object) in scene.objects.iter().enumerate() {
            if let Some(t) = meet(&object.shape, origin.as_dvec3(), direction.as_dvec3(), 0.0)
                && t < sight.t_max
            {
                (sight.t_max, sight.object) = (t, Some(number));
            }
        }
        sight
    }

    /// All rays of a pass, pixel by pixel.
    fn all(scene: &Scene, seed: u64, pass: u64) -> Vec<Self> {
        let view = View::new(&scene.camera, SIZE);
        let variates = Variates { sequence: Sequence::Independent, seed, pass, pixels: SIZE.pixels() };
        let [x, y] = [Dimension::X, Dimension::Y].map(|dimension| {
            let mut u = Vec::new();
            variates.fill(dimension, 0, SIZE.pixels(), &mut u);
            u
        });
        let through = |i: usize| view.direction((i % SIZE.width) as f32 + x[i], (i / SIZE.width) as f32 + y[i]);
        (0..SIZE.pixels()).map(|i| Self::new(scene, scene.camera.eye, through(i))).collect()
    }

    fn point(&self, t: f64) -> DVec3 {
        self.origin.as_dvec3() + t * self.direction.as_dvec3()
    }

    fn oracle(&self, scene: &Scene, light: &Light) -> oracle::Scene {
        let ray = Ray::new(self.origin, self.direction, 0.0, self.t_max as f32).unwrap();
        oracle::Scene::new(&ray, &light.emitter, &scene.medium)
    }

    /// The oracle of each channel of the medium.
    fn oracles(&self, scene: &Scene, light: &Light) -> [oracle::Scene; 3] {
        [0, 1, 2].map(|c| {
            let medium = scene.medium.channel(c).unwrap_or(scene.medium);
            self.oracle(&Scene { medium, ..scene.clone() }, light)
        })
    }

    /// The scattered radiance, where nothing casts a shadow.
    fn airlight(&self, scene: &Scene) -> DVec3 {
        let of_light = |light: &Light| {
            let radiances = self.oracles(scene, light).map(|oracle| oracle.radiance());
            DVec3::from_array(radiances) * light.intensity.as_dvec3()
        };
        scene.lights.iter().map(of_light).sum()
    }

    /// The scattered radiance with shadows, by the midpoint rule over the angle at the emitter.
    fn airlight_with_shadows(&self, scene: &Scene, steps: usize) -> DVec3 {
        let of_light = |light: &Light| {
            let ray = self.oracle(scene, light);
            let Some((t_a, t_b)) = ray.lit() else { return DVec3::ZERO };
            let step = ray.angle(t_a, t_b) / steps as f64;
            let radiance = |i: usize| {
                let theta = ray.theta(t_a) + (i as f64 + 0.5) * step;
                let t = ray.t_h() + ray.h() * theta.tan();
                let seen = theta.abs() < FRAC_PI_2 && sees(scene, self.point(t), light.emitter);
                if seen { ray.integrand(t) * ray.r(t).powi(2) / ray.h() * step } else { 0.0 }
            };
            light.intensity.as_dvec3() * (0..steps).map(radiance).sum::<f64>()
        };
        scene.lights.iter().map(of_light).sum()
    }

    /// What the surface emits, and reflects of the lights that it sees.
    fn surface(&self, scene: &Scene) -> DVec3 {
        let Some(object) = self.object.map(|number| &scene.objects[number]) else { return DVec3::ZERO };
        let mu_t = [0, 1, 2].map(|c| f64::from(scene.medium.channel(c).unwrap_or(scene.medium).mu_t()));
        let transmittance = |way: f64| DVec3::from_array(mu_t.map(|mu_t| (-mu_t * way).exp()));
        let x = self.point(self.t_max);
        let reflected = |light: &Light| {
            let (to_light, position) = (position(light.emitter) - x, position(light.emitter));
            let r = to_light.length();
            let facing = facing(object, x, self.direction.as_dvec3());
            let cosine = facing.dot(to_light / r).max(0.0);
            let from = shine(light.emitter, -to_light / r);
            let seen = f64::from(u8::from(sees(scene, x, light.emitter)));
            assert!(r > 0.0, "{position} is on a surface");
            let brightness = seen * cosine * from * FRAC_1_PI / (r * r) * transmittance(self.t_max + r);
            brightness * object.albedo.as_dvec3() * light.intensity.as_dvec3()
        };
        object.emission.as_dvec3() * transmittance(self.t_max) + scene.lights.iter().map(reflected).sum::<DVec3>()
    }
}

/// The part of its intensity that an emitter has into a direction.
fn shine(emitter: Emitter, direction: DVec3) -> f64 {
    let Some(cone) = emitter.cone() else {
        return Vec3::from(emitter.normal().unwrap()).as_dvec3().dot(direction).max(0.0);
    };
    let [outer, inner] = [cone.cos_outer(), cone.cos_inner()].map(f64::from);
    let x = Vec3::from(cone.axis()).as_dvec3().normalize().dot(direction);
    let s = ((x - outer) / (inner - outer)).clamp(0.0, 1.0);
    s * s * (3.0 - 2.0 * s)
}

fn facing(object: &Object, x: DVec3, direction: DVec3) -> DVec3 {
    let normal = match &object.shape {
        Shape::Sphere { centre, .. } => (x - centre.as_dvec3()).normalize(),
        Shape::Plane { normal, .. } => normal.as_dvec3(),
    };
    if normal.dot(direction) < 0.0 { normal } else { -normal }
}

/// The first distance beyond `nearest` at which a line meets a shape.
fn meet(shape: &Shape, origin: DVec3, direction: DVec3, nearest: f64) -> Option<f64> {
    match shape {
        Shape::Sphere { centre, radius } => {
            let w = origin - centre.as_dvec3();
            let (a, b) = (direction.length_squared(), w.dot(direction));
            let root = (b * b - a * (w.length_squared() - f64::from(*radius).powi(2))).sqrt();
            [(-b - root) / a, (-b + root) / a].into_iter().find(|t| *t > nearest)
        }
        Shape::Plane { point, normal, openings } => {
            let normal = normal.as_dvec3();
            let t = normal.dot(point.as_dvec3() - origin) / normal.dot(direction);
            let x = origin + t * direction;
            let open = openings.iter().any(|(centre, radius)| x.distance(centre.as_dvec3()) < f64::from(*radius));
            (t > nearest && t.is_finite() && !open).then_some(t)
        }
    }
}

fn position(emitter: Emitter) -> DVec3 {
    Vec3::from(emitter.position()).as_dvec3()
}

/// Whether nothing is between a point and an emitter.
fn sees(scene: &Scene, x: DVec3, emitter: Emitter) -> bool {
    let way = position(emitter) - x;
    let between = |object: &Object| meet(&object.shape, x, way, 1e-4).is_some_and(|t| t < 1.0);
    !scene.objects.iter().any(|object| object.occludes && between(object))
}

/// What the rays of each pass bring, pixel by pixel.
fn expected(scene: &Scene, passes: u64, radiance: impl Fn(&Sight) -> DVec3) -> Vec<Vec<DVec3>> {
    (0..passes).map(|pass| Sight::all(scene, SEED, pass).iter().map(&radiance).collect()).collect()
}

/// By how many standard errors each channel of each tile of a layer is off what is expected, in the mean of all passes.
/// The two have the same rays, so that what differs between them is what the renderer decides by lot.
fn deviations(scene: &Scene, settings: &Settings, layer: Layer, expected: &[Vec<DVec3>]) -> Vec<f64> {
    let mut renderer = Renderer::new(scene, SIZE, settings);
    let mut difference = |expected: &Vec<DVec3>, film: &mut Film| {
        let before = film.sum(layer).to_vec();
        renderer.pass(film).unwrap();
        let mut tiles = vec![0.0; 3 * (SIZE.width / TILE) * (SIZE.height / TILE)];
        for (i, expected) in expected.iter().enumerate() {
            let tile = i / SIZE.width / TILE * (SIZE.width / TILE) + i % SIZE.width / TILE;
            for channel in 0..3 {
                tiles[3 * tile + channel] += film.sum(layer)[i][channel] - before[i][channel] - expected[channel];
            }
        }
        tiles
    };
    let mut film = Film::new(SIZE);
    let differences: Vec<Vec<f64>> = expected.iter().map(|expected| difference(expected, &mut film)).collect();

    // Where every pass is exact but for f32, nothing is a standard error.
    let brightest =
        expected.iter().flatten().fold(0.0, |brightest: f64, radiance| brightest.max(radiance.max_element()));
    let rounding = 1e-6 * brightest * (TILE * TILE) as f64;
    let count = differences.len() as f64;
    let z = |tile: usize| {
        let mean = differences.iter().map(|tiles| tiles[tile]).sum::<f64>() / count;
        let spread = differences.iter().map(|tiles| (tiles[tile] - mean).powi(2)).sum::<f64>() / (count - 1.0);
        mean / (spread / count).sqrt().hypot(rounding)
    };
    (0..differences[0].len()).map(z).collect()
}

fn assert_near(deviations: &[f64], what: &str) {
    let largest = deviations.iter().fold(0.0, |largest: f64, z| largest.max(z.abs()));
    println!("{what}: {} channels of tiles, the largest z {largest:.2}", deviations.len());
    assert!(deviations.iter().all(|z| z.abs() < FAR), "{what}: {deviations:.2?}");
    // Not all of them exactly 0, as those of a black picture.
    assert!(largest > 0.0, "{what}: nothing is lit");
}

fn settings(strategy: Strategy, mis: bool, choice: EmitterChoice) -> Settings {
    let (sampler, shadows, variates) = (Sampler::new(strategy), Shadows::Plain, Sequence::Independent);
    let settings = Settings { sampler, mis, choice, shadows, variates, seed: SEED };
    println!("{settings:?}");
    settings
}

#[test]
fn airlight_without_occluders_is_the_quadrature_with_and_without_mis() {
    for name in Name::ALL {
        // Few lights where each has the same chance: rare samples that hold much of the mean have no standard error.
        let mut scene = name.scene().unwrap().without_occluders();
        scene.camera.field_of_view /= 12.0;
        let mut few = scene.clone();
        few.lights.truncate(4);
        let quadrature = |scene: &Scene| expected(scene, 40, |sight| sight.airlight(scene));
        let (of_few, of_all) = (quadrature(&few), quadrature(&scene));
        for (scene, expected, strategy, mis, choice) in [
            (&few, &of_few, Strategy::EquiAngular, false, EmitterChoice::Uniform),
            (&scene, &of_all, Strategy::Product5, false, EmitterChoice::Choose),
            (&scene, &of_all, Strategy::Product3, true, EmitterChoice::Choose),
        ] {
            let settings = settings(strategy, mis, choice);
            assert_near(&deviations(scene, &settings, Layer::Airlight, expected), name.name());
        }
    }
}

#[test]
fn each_channel_is_scattered_and_extinguished_by_its_own_coefficients() {
    let mut scene = Name::Spots.scene().unwrap().without_occluders();
    scene.camera.field_of_view /= 12.0;
    scene.medium = Medium::coloured([0.0, 0.05, 0.1], [0.02, 0.06, 0.12], 0.25).unwrap();
    let airlight = expected(&scene, 40, |sight| sight.airlight(&scene));
    let surface = expected(&scene, 40, |sight| sight.surface(&scene));
    for mis in [false, true] {
        let settings = settings(Strategy::Product5, mis, EmitterChoice::Choose);
        assert_near(&deviations(&scene, &settings, Layer::Airlight, &airlight), "airlight");
        assert_near(&deviations(&scene, &settings, Layer::Surface, &surface), "surface");
    }
}

#[test]
fn shafts_are_where_light_goes_through() {
    let scene = Name::Shaft.scene().unwrap();
    let expected = expected(&scene, 64, |sight| sight.airlight_with_shadows(&scene, 1000));
    for mis in [false, true] {
        let settings = settings(Strategy::EquiAngular, mis, EmitterChoice::Uniform);
        assert_near(&deviations(&scene, &settings, Layer::Airlight, &expected), "shaft");
    }
}

#[test]
fn surfaces_are_lit_by_what_they_see() {
    for name in Name::ALL {
        let scene = name.scene().unwrap();
        let expected = expected(&scene, 64, |sight| sight.surface(&scene));
        let settings = settings(Strategy::Product3, false, EmitterChoice::Uniform);
        assert_near(&deviations(&scene, &settings, Layer::Surface, &expected), name.name());
    }
}

#[test]
fn lamps_shine_through_the_medium() {
    for name in [Name::ManyLights, Name::Forward, Name::Dense] {
        let mut scene = name.scene().unwrap();
        // So near that nothing else is in the picture.
        let lamp = Vec3::from(scene.lights.last().unwrap().emitter.position());
        scene.camera = Camera { eye: lamp + Vec3::new(0.0, 1.0, 3.0), target: lamp, field_of_view: 0.5 };
        let expected = expected(&scene, 8, |sight| sight.surface(&scene));
        let settings = settings(Strategy::Product3, false, EmitterChoice::Uniform);
        let z = deviations(&scene, &settings, Layer::Surface, &expected);
        assert!(expected.iter().flatten().all(|radiance| radiance.max_element() > 0.1), "{name}: no lamp is seen");
        assert_near(&z, name.name());
    }
}

fn rendered(scene: &Scene, settings: &Settings, passes: u64) -> Film {
    let mut renderer = Renderer::new(scene, SIZE, settings);
    let mut film = Film::new(SIZE);
    (0..passes).for_each(|_| renderer.pass(&mut film).unwrap());
    film
}

/// Largest relative error of a channel that holds at least a thousandth of the brightest.
fn largest_error(picture: &[[f64; 3]], truth: &[[f64; 3]]) -> f64 {
    let brightest = truth.as_flattened().iter().copied().fold(0.0, f64::max);
    let pairs = picture.as_flattened().iter().zip(truth.as_flattened());
    pairs.filter(|(_, truth)| **truth > 1e-3 * brightest).map(|(a, b)| (a / b - 1.0).abs()).fold(0.0, f64::max)
}

#[test]
fn without_occluders_the_ratio_is_the_integral_without_noise() {
    const PASSES: u64 = 4;
    for name in Name::ALL {
        let mut scene = name.scene().unwrap().without_occluders();
        scene.camera.field_of_view /= 12.0;
        // Where the falloff of a spot begins and ends, eight nodes lose digits.
        let bound = if scene.lights.iter().any(|light| light.emitter.cone().is_some()) { 1e-2 } else { 1e-5 };
        // So few that in four passes each pixel has a light that lights it.
        scene.lights.truncate(2);
        let mut means = vec![[0.0; 3]; SIZE.pixels()];
        for pass in expected(&scene, PASSES, |sight| sight.airlight(&scene)) {
            for (mean, radiance) in means.iter_mut().zip(pass) {
                *mean = (DVec3::from_array(*mean) + radiance / PASSES as f64).to_array();
            }
        }
        for (strategy, mis, choice) in
            [(Strategy::EquiAngular, false, EmitterChoice::Uniform), (Strategy::Product5, true, EmitterChoice::Choose)]
        {
            let plain = settings(strategy, mis, choice);
            let ratio = rendered(&scene, &Settings { shadows: Shadows::Ratio, ..plain }, PASSES);
            let error = largest_error(&ratio.airlight(), &means);
            println!("{name}: {error:.1e}");
            assert!(error < bound, "{name}: {error}");
            let integral: Vec<[f64; 3]> =
                ratio.sum(Layer::Integral).iter().map(|sum| sum.map(|sum| sum / PASSES as f64)).collect();
            assert!(largest_error(&ratio.airlight(), &integral) < 1e-15, "{name}");
            assert!(largest_error(&rendered(&scene, &plain, PASSES).airlight(), &means) > 10.0 * error, "{name}");
        }
    }
}

#[test]
fn with_occluders_the_ratio_converges_to_the_picture() {
    for name in [Name::Shaft, Name::Spots] {
        let scene = name.scene().unwrap();
        for choice in [EmitterChoice::Uniform, EmitterChoice::Choose] {
            let plain = settings(Strategy::Product5, false, choice);
            let truth = rendered(&scene, &Settings { seed: SEED + 1, ..plain }, 1 << 14).airlight();
            let errors = |passes| -> Vec<f64> {
                let ratio = rendered(&scene, &Settings { shadows: Shadows::Ratio, ..plain }, passes).airlight();
                ratio.as_flattened().iter().zip(truth.as_flattened()).map(|(a, b)| a - b).collect()
            };
            let mean = |values: &[f64]| values.iter().sum::<f64>() / values.len() as f64;
            let rmse = |errors: &[f64]| mean(&errors.iter().map(|error| error * error).collect::<Vec<_>>()).sqrt();
            let (few, many) = (errors(16), errors(1 << 10));
            let bias = mean(&many) / (rmse(&many) / (SIZE.pixels() as f64).sqrt());
            println!("{name}, {choice}: rmse {:.2e}, {:.2e}; z of the bias {bias:.2}", rmse(&few), rmse(&many));
            // A root of 64 would be 8, less the error of the truth.
            assert!(rmse(&many) < rmse(&few) / 5.0 && bias.abs() < FAR, "{name}, {choice}");
        }
    }
}

/// Sobol's variates are no independent ones, and have no standard error: the errors that are left fall faster with the
/// passes than theirs, which halve where there are four times as many.
#[test]
fn low_discrepancy_variates_give_the_same_picture_with_less_error() {
    const PASSES: u64 = 64;
    for name in Name::ALL {
        let scene = name.scene().unwrap().without_occluders();
        let render = |variates, passes, seed| {
            let settings = settings(Strategy::Product5, false, EmitterChoice::Choose);
            let mut renderer = Renderer::new(&scene, SIZE, &Settings { variates, seed, ..settings });
            let mut film = Film::new(SIZE);
            (0..passes).for_each(|_| renderer.pass(&mut film).unwrap());
            film.airlight()
        };
        let truth = render(Sequence::Independent, 64 * PASSES, SEED);
        let rmse = |variates| {
            let picture = render(variates, PASSES, SEED + 1);
            let pairs = picture.iter().flatten().zip(truth.iter().flatten());
            (pairs.map(|(a, b)| (a - b).powi(2)).sum::<f64>() / (3 * picture.len()) as f64).sqrt()
        };
        let [sobol, independent] = [Sequence::Sobol, Sequence::Independent].map(rmse);
        println!("{name}: {sobol:.2e}, independent {independent:.2e}");
        assert!(sobol < 0.7 * independent, "{name}: {sobol}, independent {independent}");
    }
}

/// The picture of an EXR file, decoded.
fn exr(path: &Path) -> (usize, Vec<[f32; 3]>) {
    let image = exr::prelude::read_first_rgba_layer_from_file(
        path,
        |size, _| (size.width(), vec![[0.0; 3]; size.area()]),
        |(width, pixels), place, (red, green, blue, _): (f32, f32, f32, f32)| {
            pixels[place.y() * *width + place.x()] = [red, green, blue];
        },
    )
    .unwrap();
    image.layer_data.channel_data.pixels
}

/// The levels of a PNG file and its size.
fn png(path: &Path) -> ((u32, u32), Vec<u8>) {
    let mut reader = png::Decoder::new(std::io::BufReader::new(fs::File::open(path).unwrap())).read_info().unwrap();
    let mut levels = vec![0; reader.output_buffer_size().unwrap()];
    let info = reader.next_frame(&mut levels).unwrap();
    assert_eq!((info.color_type, info.bit_depth), (png::ColorType::Rgb, png::BitDepth::Eight));
    ((info.width, info.height), levels)
}

#[test]
fn the_same_seed_is_the_same_picture_for_any_number_of_threads() {
    let folder = TempDir::new().unwrap();
    let picture = |name: &str, seed: &str, threads: &str| {
        let out = folder.path().join(format!("{name}-{seed}-{threads}.exr"));
        // More pixels than a wave has.
        let arguments = ["--scene", name, "--size", "240x150", "--spp", "2", "--mis", "--seed", seed];
        succeed(&[&arguments[..], &["--threads", threads, "--out", text(&out)]].concat());
        fs::read(out).unwrap()
    };
    for name in Name::ALL.map(Name::name) {
        assert!(picture(name, "1", "1") == picture(name, "1", "2"), "{name}: threads");
        assert!(picture(name, "1", "2") != picture(name, "2", "2"), "{name}: seeds");
    }
}

#[test]
fn a_png_is_an_exr_through_the_tone_curve() {
    let folder = TempDir::new().unwrap();
    for name in Name::ALL {
        let files = ["p.exr", "p.png"].map(|file| folder.path().join(file));
        for file in &files {
            succeed(&["--scene", name.name(), "--size", "50x20", "--spp", "4", "--out", text(file)]);
        }
        let ((exr_width, linear), (size, levels)) = (exr(&files[0]), png(&files[1]));
        assert_eq!((exr_width, linear.len(), size), (50, 1000, (50, 20)));
        let exposure = f64::from(name.scene().unwrap().exposure);
        for (linear, level) in linear.as_flattened().iter().zip(&levels) {
            let x = f64::from(*linear) * exposure;
            let filmic = (x * (2.51 * x + 0.03) / (x * (2.43 * x + 0.59) + 0.14)).clamp(0.0, 1.0);
            let shown = if filmic <= 0.003_130_8 { 12.92 * filmic } else { 1.055 * filmic.powf(1.0 / 2.4) - 0.055 };
            assert!((f64::from(*level) - 255.0 * shown).abs() < 1.001, "{name}: {linear} is shown as {level}");
        }
        assert!(levels.iter().any(|level| *level > 64), "{name} is dark");
    }
}

#[test]
fn json_tells_what_was_rendered() {
    let json = succeed_without_a_picture(&[
        "--size",
        "20x10",
        "--spp",
        "3",
        "--mis",
        "--strategy",
        "product-9",
        "--json",
        "-",
    ]);
    let figures: Value = serde_json::from_str(&json).unwrap();
    let mut keys: Vec<&String> = figures.as_object().unwrap().keys().collect();
    keys.sort();
    let expected = "airlight_share height lights mis msamples_per_s passes precision radiance samples scene seconds seed shadows \
                    strategy threads variates version width";
    assert_eq!(keys, expected.split_whitespace().collect::<Vec<_>>());
    assert_eq!((&figures["scene"], &figures["strategy"]), (&"shaft".into(), &"product-9".into()));
    assert_eq!(figures["precision"], "exact");
    assert_eq!((&figures["passes"], &figures["samples"]), (&3.into(), &(2 * 3 * 200).into()));
    assert!((0.0..=1.0).contains(&figures["airlight_share"].as_f64().unwrap()), "{json}");
}

#[test]
fn a_picture_or_a_comparison_has_the_precision_that_was_asked_for() {
    let arguments = ["--size", "20x10", "--spp", "1", "--precision", "fast", "--json", "-"];
    let json = succeed_without_a_picture(&[&arguments[..], &["--strategy", "point-normal"]].concat());
    let picture: Value = serde_json::from_str(&json).unwrap();
    assert_eq!(picture["precision"], "fast");
    let json = succeed(&[&arguments[..], &["--compare", "--reference", "2"]].concat());
    let comparison: Value = serde_json::from_str(&json).unwrap();
    let names = |row: &Value| ["strategy", "precision"].map(|key| row[key].as_str().unwrap().to_owned());
    let fast = Strategy::ALL.iter().filter(|strategy| strategy.has_precision(Precision::Fast));
    assert_eq!(
        comparison["results"].as_array().unwrap().iter().map(names).collect::<Vec<_>>(),
        fast.map(|strategy| [strategy.name(), "fast"].map(str::to_owned)).collect::<Vec<_>>()
    );
}

#[test]
fn time_is_spent_on_whole_passes() {
    let json = succeed_without_a_picture(&["--size", "20x10", "--time", "0.05", "--json", "-"]);
    let figures: Value = serde_json::from_str(&json).unwrap();
    let passes = figures["passes"].as_u64().unwrap();
    assert!(passes >= 1 && figures["samples"] == 200 * passes, "{json}");
    assert!(figures["seconds"].as_f64().unwrap() >= 0.05, "{json}");
}

#[test]
fn a_comparison_has_every_strategy_and_a_sheet() {
    let folder = TempDir::new().unwrap();
    let sheet = folder.path().join("sheet.png");
    let arguments = ["--compare", "--size", "32x18", "--spp", "4", "--reference", "64", "--scene", "forward"];
    let json = succeed(&[&arguments[..], &["--json", "-", "--out", text(&sheet)]].concat());
    let figures: Value = serde_json::from_str(&json).unwrap();
    let rows = figures["results"].as_array().unwrap();
    let names: Vec<&str> = rows.iter().map(|row| row["strategy"].as_str().unwrap()).collect();
    assert_eq!(names, Strategy::ALL.iter().map(|strategy| strategy.name()).collect::<Vec<_>>());
    assert_eq!(figures["reference_passes"], 64);
    let baseline = rows.iter().find(|row| row["strategy"] == "equi-angular").unwrap();
    assert_eq!((&baseline["airlight_efficiency"], &baseline["picture_efficiency"]), (&1.0.into(), &1.0.into()));
    for row in rows {
        let cost = |row: &Value| row["picture_rmse"].as_f64().unwrap().powi(2) * row["seconds"].as_f64().unwrap();
        let efficiency = row["picture_efficiency"].as_f64().unwrap();
        assert!((efficiency * cost(row) / cost(baseline) - 1.0).abs() < 1e-9, "{row}");
    }
    // Ten pictures in rows of four, each under its name.
    assert_eq!(png(&sheet).0, (4 * 32, 3 * (18 + 12)));
    // Errors are those of the pictures, which depend on the seed alone.
    let again: Value = serde_json::from_str(&succeed(&[&arguments[..], &["--json", "-"]].concat())).unwrap();
    for (row, again) in rows.iter().zip(again["results"].as_array().unwrap()) {
        assert_eq!(row["airlight_rmse"], again["airlight_rmse"]);
    }
}

#[test]
fn a_comparison_has_every_estimate_of_shadows() {
    let arguments = ["--compare", "--size", "20x10", "--spp", "2", "--reference", "4", "--strategy", "product-5"];
    let both = ["--shadows", "plain", "--shadows", "ratio", "--json", "-"];
    let figures: Value = serde_json::from_str(&succeed(&[&arguments[..], &both].concat())).unwrap();
    let names = |row: &Value| ["strategy", "shadows"].map(|key| row[key].as_str().unwrap().to_owned());
    let rows = figures["results"].as_array().unwrap().iter().map(names);
    let expected = ["equi-angular", "product-5"].into_iter().flat_map(|s| ["plain", "ratio"].map(|e| [s, e]));
    assert!(rows.eq(expected.map(|names| names.map(str::to_owned))), "{figures}");
    assert_eq!(figures["results"][0]["airlight_efficiency"], 1.0);
}

#[test]
fn the_error_of_a_comparison_falls_with_the_samples() {
    let rmse = |spp: &str| {
        let arguments = ["--compare", "--size", "24x14", "--reference", "2048", "--scene", "dense", "--spp", spp];
        let independent = ["--strategy", "product-5", "--variates", "independent", "--json", "-"];
        let json = succeed(&[&arguments[..], &independent].concat());
        let figures: Value = serde_json::from_str(&json).unwrap();
        assert_eq!(figures["results"][1]["strategy"], "product-5");
        figures["results"][1]["airlight_rmse"].as_f64().unwrap()
    };
    let ratio = rmse("16") / rmse("256");
    println!("ratio {ratio:.2}");
    // The root of 16, and less or more by what few pixels and heavy tails leave to chance.
    assert!((3.0..5.3).contains(&ratio), "{ratio}");
}

#[test]
fn a_refused_argument_is_named() {
    let folder = TempDir::new().unwrap();
    let out = folder.path().join("p.png");
    for (arguments, expected) in [
        (&["--scene", "cave"][..], "no scene is called 'cave'; there are shaft, many-lights, forward, dense, spots"),
        (&["--time", "0"], "--time <SECONDS>': expected a number of seconds greater than 0"),
        (&["--time", "-1"], "expected a number of seconds greater than 0"),
        (&["--time", "nan"], "expected a number of seconds greater than 0"),
        (&["--time", "1e300"], "expected a number of seconds greater than 0"),
        (&["--size", "640"], "--size <WxH>': expected WIDTHxHEIGHT in pixels, each from 1 to 4096"),
        (&["--size", "0x10"], "expected WIDTHxHEIGHT"),
        (&["--size", "10x-3"], "expected WIDTHxHEIGHT"),
        (&["--size", "10x5000"], "expected WIDTHxHEIGHT"),
        (&["--size", "100000x100000"], "expected WIDTHxHEIGHT"),
        (&["--spp", "0"], "--spp <N>': expected a whole number of at least 1"),
        (&["--lights", "best"], "--lights <NAME>': expected uniform or choose"),
        (&["--shadows", "soft"], "--shadows <NAME>': expected plain or ratio"),
        (&["--shadows", "plain", "--shadows", "ratio"], "several --shadows need --compare"),
        (&["--variates", "random"], "--variates <NAME>': expected sobol or independent"),
        (&["--strategy", "best"], "no strategy is called 'best'; there are transmittance"),
        (&["--strategy", "taylor-phase", "--precision", "fast"], "the strategy taylor-phase has no fast precision"),
        (&["--strategy", "product-3", "--strategy", "product-5"], "several --strategy need --compare"),
    ] {
        let told = fail(&[&["--out", text(&out)], arguments].concat());
        assert!(told.contains(expected), "{told}");
    }
    assert_eq!(fs::read_dir(folder.path()).unwrap().count(), 0);
}

#[test]
fn an_unwritable_picture_is_refused_by_name() {
    let folder = TempDir::new().unwrap();
    for (file, expected) in [
        ("no/such/folder/p.png", "cannot write"),
        ("p.jpg", "expected a name that ends in .png or .exr"),
        ("p", "expected a name that ends in .png or .exr"),
    ] {
        let path = folder.path().join(file);
        let told = fail(&["--size", "8x8", "--spp", "1", "--out", text(&path)]);
        assert!(told.contains(expected) && told.contains(text(&path)), "{told}");
    }
    assert_eq!(fs::read_dir(folder.path()).unwrap().count(), 0);
}
