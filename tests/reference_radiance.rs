//! The formula and its constants against an independent renderer: single-scattered radiance of 768 rays in grey media, and of
//! 1152 in coloured and grey ones with spots; of the oracle, and of the kernels.

use airlight::oracle::quadrature::integrate;
use airlight::oracle::{Coloured, Scene};
use airlight::{Emitter, Emitters, Integral, Media, Medium, Nodes, Ray, Rays, Sampler, Strategy};
use glam::Vec3;
use std::fmt;

/// By how much of its length the renderer shortens a shadow ray.
const SHADOW_EPSILON: f64 = 8.94e-4;

/// One ray, in one channel.
struct Row {
    table: &'static str,
    line: usize,
    parts: (Ray, Emitter, Medium),
    scene: Scene,
    /// The same with the f32 on the other side of the exact cosine of a spot, and how near that is: from 0 at `scene`'s to 1.
    other: (Scene, f64),
    /// The emitter's scale times what the renderer counts and `Scene` does not: the transmittance up to `t_min`.
    scale: f64,
    reference: f64,
    standard_error: f64,
    quadrature: f64,
}

impl Row {
    fn name(&self) -> String {
        format!("{}, line {}", self.table, self.line)
    }

    /// Asserts that a radiance of the kernels is within the noise, once shadow rays are as short.
    fn hold(&self, found: f64, by: &dyn fmt::Display) {
        let oracle = radiance(&self.scene, 0.0);
        let corrected = if oracle == 0.0 { 1.0 } else { radiance(&self.scene, SHADOW_EPSILON) / oracle };
        let (value, name) = (self.scale * corrected * found, self.name());
        if oracle == 0.0 {
            assert_eq!(value, 0.0, "{name}: {by}");
        } else {
            let z = (self.reference - value) / self.standard_error;
            assert!(z.abs() <= 4.0, "{name}: {by} is off by {z} standard errors");
        }
    }

    /// The radiance at the exact cosine.
    fn radiance(&self) -> f64 {
        let (other, share) = &self.other;
        self.scale * ((1.0 - share) * self.scene.radiance() + share * other.radiance())
    }
}

fn rows() -> Vec<Row> {
    let (lamps, spots) = (include_str!("data/radiance.csv"), include_str!("data/spots.csv"));
    columns(lamps).map(|(line, column)| lamp(line, &column)).chain(columns(spots).flat_map(spot)).collect()
}

/// The lines of a table by their numbers.
fn columns(table: &str) -> impl Iterator<Item = (usize, Vec<f64>)> {
    let numbers = |line: &str| line.split(',').map(|s| s.parse().unwrap()).collect();
    table.lines().enumerate().skip(1).map(move |(i, line)| (i + 1, numbers(line)))
}

fn vector(column: &[f64]) -> Vec3 {
    Vec3::from([0, 1, 2].map(|k| column[k] as f32))
}

fn ray(column: &[f64]) -> Ray {
    Ray::new(vector(column), vector(&column[3..]), column[6] as f32, column[7] as f32).unwrap()
}

fn lamp(line: usize, column: &[f64]) -> Row {
    let (y, n) = (vector(&column[8..]), vector(&column[11..]));
    let emitter = if n == Vec3::ZERO { Emitter::point(y) } else { Emitter::point_normal(y, n) }.unwrap();
    let [mu_s, mu_a, g] = [14, 15, 16].map(|i| column[i] as f32);
    let parts = (ray(column), emitter, Medium::new(mu_a, mu_s, g).unwrap());
    let scene = Scene::new(&parts.0, &parts.1, &parts.2);
    Row {
        table: "radiance.csv",
        line,
        parts,
        scene,
        other: (scene, 0.0),
        scale: column[17] * before_t_min(&scene),
        reference: column[18],
        standard_error: column[19],
        quadrature: column[20],
    }
}

/// The three channels of a line.
fn spot((line, column): (usize, Vec<f64>)) -> [Row; 3] {
    let (y, axis, medium) = (vector(&column[8..]), vector(&column[11..]), medium(&column));
    let ray = ray(&column);
    let emitter = |cosine: f32| {
        if axis == Vec3::ZERO { Emitter::point(y) } else { Emitter::spot(y, axis, cosine, cosine) }.unwrap()
    };
    let scene = |cosine: f32| Coloured::new(&ray, &emitter(cosine), &medium);
    let exact = column[14].to_radians().cos();
    let nearest = exact as f32;
    let beyond = if f64::from(nearest) < exact { nearest.next_up() } else { nearest.next_down() };
    let share = (exact - f64::from(nearest)) / f64::from(beyond - nearest);
    let (scene, other) = (scene(nearest), scene(beyond));
    [0, 1, 2].map(|c| Row {
        table: "spots.csv",
        line,
        parts: (ray, emitter(nearest), medium.channel(c).unwrap()),
        scene: scene.channels()[c],
        other: (other.channels()[c], share),
        scale: before_t_min(&scene.channels()[c]),
        reference: column[22 + c],
        standard_error: column[25 + c],
        quadrature: column[28 + c],
    })
}

/// The medium of a line of three channels.
fn medium(column: &[f64]) -> Medium {
    Medium::coloured(vector(&column[18..]).into(), vector(&column[15..]).into(), column[21] as f32).unwrap()
}

/// The transmittance up to `t_min`.
fn before_t_min(scene: &Scene) -> f64 {
    (-scene.mu_t() * scene.interval().0).exp()
}

/// The radiance where shadow rays are too short by `epsilon`: the integral over theta, in the textbook form.
fn radiance(scene: &Scene, epsilon: f64) -> f64 {
    let Some((t_a, t_b)) = scene.lit() else { return 0.0 };
    let over_theta = |theta: f64| {
        let t = scene.t_h() + scene.h() * theta.tan();
        let r = scene.r(t);
        scene.integrand(t) * (scene.mu_t() * epsilon * r).exp() * r * r / scene.h()
    };
    integrate(over_theta, scene.theta(t_a), scene.theta(t_b), 1e-10)
}

#[test]
fn the_renderer_agrees_within_its_noise() {
    let (mut worst, mut squares) = (0f64, Vec::new());
    for row in rows() {
        let value = row.scale * radiance(&row.scene, SHADOW_EPSILON);
        if value == 0.0 {
            assert_eq!(row.reference, 0.0, "{}", row.name());
            continue;
        }
        let z = (row.reference - value) / row.standard_error;
        assert!(z.abs() <= 4.0, "{}: {z} standard errors", row.name());
        worst = worst.max(z.abs());
        squares.push(z * z);
    }
    let rms = (squares.iter().sum::<f64>() / squares.len() as f64).sqrt();
    println!("{} rays and channels: largest {worst:.2}, root mean square {rms:.3} standard errors", squares.len());
    assert!(worst > 2.0, "of hundreds of rows the worst is off by {worst} standard errors: too good to be true");
}

/// Every channel as a grey medium: integrals by quadrature of the kernels, and means of samples at even variates.
#[test]
fn the_kernels_agree_within_its_noise() {
    const VARIATES: u16 = 1024;
    let u: Vec<f32> = (0..VARIATES).map(|i| (f32::from(i) + 0.5) / f32::from(VARIATES)).collect();
    for row in rows() {
        let (ray, emitter, medium) = &row.parts;
        for nodes in [Nodes::Eight, Nodes::Twelve] {
            row.hold(Integral::new(nodes).radiance_one(ray, emitter, medium).into(), &nodes);
        }
        for strategy in [Strategy::Product5, Strategy::EquiAngular] {
            let weight =
                |u| Sampler::new(strategy).sample_one(ray, emitter, medium, u).map_or(0.0, |s| f64::from(s.weight));
            row.hold(u.iter().copied().map(weight).sum::<f64>() / f64::from(VARIATES), &strategy);
        }
    }
}

/// Coloured media in one call, all channels of a ray at once.
#[test]
fn the_channels_agree_within_its_noise() {
    let lines: Vec<_> = columns(include_str!("data/spots.csv")).collect();
    let media: Vec<Medium> = lines.iter().map(|(_, column)| medium(column)).collect();
    let rows: Vec<[Row; 3]> = lines.into_iter().map(spot).collect();
    let parts = |i: usize| rows[i][0].parts;
    let column = |of: &dyn Fn(&Ray) -> f32| (0..rows.len()).map(|i| of(&parts(i).0)).collect::<Vec<f32>>();
    let origin = [0, 1, 2].map(|k| column(&|ray| ray.origin()[k]));
    let direction = [0, 1, 2].map(|k| column(&|ray| ray.direction()[k]));
    let (t_min, t_max) = (column(&Ray::t_min), column(&Ray::t_max));
    let rays = Rays::new(origin.each_ref().map(|x| &x[..]), direction.each_ref().map(|x| &x[..]), &t_min, &t_max);
    let emitters: Vec<Emitter> = (0..rows.len()).map(|i| parts(i).1).collect();
    let index: Vec<u32> = (0..rows.len() as u32).collect();
    let (emitters, media) = (Emitters::table(&emitters, &index), Media::table(&media, &index));
    let mut found = [(); 3].map(|()| vec![f32::NAN; rows.len()]);
    let integral = Integral::new(Nodes::Twelve);
    integral.radiance_coloured(&rays, &emitters, &media, found.each_mut().map(|x| &mut x[..])).unwrap();
    for (i, channels) in rows.iter().enumerate() {
        for (row, found) in channels.iter().zip(&found) {
            row.hold(found[i].into(), &"12 nodes of channels");
        }
    }
}

#[test]
fn the_quadrature_agrees() {
    for row in rows() {
        let value = row.radiance();
        let error = (value - row.quadrature).abs();
        assert!(error <= 1e-5 * row.quadrature, "{}: {value:e} is not {:e}", row.name(), row.quadrature);
    }
}

#[test]
fn both_of_our_integrals_agree() {
    for row in rows() {
        let (value, expected) = (row.scene.radiance(), radiance(&row.scene, 0.0));
        assert!((value - expected).abs() <= 1e-9 * expected, "{}: {value:e} is not {expected:e}", row.name());
    }
}

#[test]
fn behind_the_disk_and_outside_the_cone_it_is_dark() {
    let rows = rows();
    let dark: Vec<&Row> = rows.iter().filter(|row| row.quadrature == 0.0).collect();
    let of = |table: &str| dark.iter().filter(|row| row.table == table).count();
    assert_eq!((of("radiance.csv"), of("spots.csv")), (124, 376));
    for row in dark {
        assert_eq!(row.scene.radiance(), 0.0, "{}", row.name());
    }
}
