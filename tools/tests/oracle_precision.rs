//! The f64 oracle against arithmetic with hundreds of bits, on every family of hard inputs.
//!
//! Every error is at most 1e-12, but for one thing: where the ray passes the emitter at a millionth of its length, and
//! next to where `N` is 0, one ulp of a distance changes a density by more. There the error is what is left beyond such
//! a change; how many scenes of a family have to be excused so is printed with the errors.
//!
//! Of `colour` it is the scene of one channel, with the density of its own: the mixture has no such reference.

mod reference;

use airlight::oracle;
use airlight::{Emitter, Medium, Ray, Strategy};
use airlight_tools::families::{Case, Family};
use glam::{DVec3, Vec3};
use rayon::prelude::*;
use reference::{Big, Densities, Scene, big};
use std::f64::consts::TAU;
use std::fmt::Write;
use std::ops::Range;

const SEED: u64 = 20;
/// Lit scenes of each family.
const SCENES: usize = 1000;
/// Every how many the radiance is integrated.
const INTEGRATED: usize = 50;
/// The largest error, relative; that of the CDF absolute.
const BOUND: f64 = 1e-12;
/// Of smaller numbers f64 has not all digits.
const TINY: f64 = 1e-290;

/// What is compared, and where its values are among those of a scene.
const QUANTITIES: [(&str, Range<usize>); 10] = [
    ("h", 0..1),
    ("t_h", 1..2),
    ("t_a", 2..3),
    ("t_b", 3..4),
    ("integrand", 4..5),
    ("radiance", 5..6),
    ("pdf", 6..11),
    ("product", 11..CDF),
    ("cdf", CDF..20),
    ("product", 20..24),
];
const CDF: usize = 15;
/// In the first ones no digit may be lost, whatever a few ulp of `t_h` do to the others.
const WITHOUT_SLACK: usize = 2;

#[test]
fn the_oracle_is_as_exact_as_f64_allows() {
    let (mut report, mut failures) = (format!("{:15}", "largest error"), Vec::new());
    QUANTITIES.iter().for_each(|(quantity, _)| write!(report, " {quantity:>9}").unwrap());
    write!(report, " {:>9}", "excused").unwrap();
    // The reference has no cones: those have a test of their own.
    for family in Family::ALL.into_iter().filter(|family| *family != Family::Spot) {
        let cases = lit_cases(family);
        let (errors, excused): (Vec<_>, Vec<_>) =
            cases.par_iter().enumerate().map(|(i, (_, case))| Comparison::new(case, i).errors()).unzip();
        write!(report, "\n{:15}", family.name()).unwrap();
        for (k, (quantity, _)) in QUANTITIES.iter().enumerate() {
            let worst = (0..cases.len()).max_by(|&i, &j| errors[i][k].total_cmp(&errors[j][k])).expect("cases");
            let ((index, case), error) = (cases[worst], errors[worst][k]);
            write!(report, " {error:9.1e}").unwrap();
            // Of arbitrary bits the light at every knot may be less than f64 can hold: then the oracle is uniform.
            let unbounded = family == Family::RandomBits && *quantity == "product";
            if error > BOUND && !unbounded {
                failures.push(format!("{family:?} {index} of seed {SEED}: {quantity} is off by {error:e}, {case:?}"));
            }
        }
        write!(report, " {:9}", excused.into_iter().filter(|excused| *excused).count()).unwrap();
    }
    println!("{report}");
    assert!(failures.is_empty(), "{}", failures.join("\n"));
}

/// A ray and a spot: cones from 0.05 to 90 degrees, the emitter from a micrometre to 10 m beside the ray.
fn spot(random: &mut impl FnMut() -> f64) -> (Ray, Emitter) {
    let mut unit = || {
        let (z, phi) = (2.0 * random() - 1.0, TAU * random());
        DVec3::new((1.0 - z * z).sqrt() * phi.cos(), (1.0 - z * z).sqrt() * phi.sin(), z)
    };
    let [direction, side, axis] = [unit(), unit(), unit()];
    let across = direction.cross(side).normalize();
    let (h, t_h) = (10f64.powf(7.0 * random() - 6.0), 20.0 * random() - 5.0);
    let position = t_h * direction - h * across;
    let half_angle = [0.1, 1.0, 10.0, 90.0][(4.0 * random()) as usize] * random().max(0.5);
    let outer = half_angle.to_radians().cos() as f32;
    let inner = outer + (1.0 - outer) * [0.0, 1.0, random() as f32][(3.0 * random()) as usize];
    // any axis, one towards the ray, one with the ray along the side of the cone, one with a cone that the ray hardly touches
    let toward = across + (8.0 * random() - 4.0) * direction;
    let along_side = direction * f64::from(outer) + across * f64::from((1.0 - outer * outer).max(0.0).sqrt());
    let (off_plane, in_plane) = (f64::from((1.0 - outer * outer).max(0.0).sqrt()), f64::from(outer));
    let touching = toward.normalize() * in_plane + direction.cross(across) * off_plane * (1.0 - 1e-6 * random());
    let axes = [axis, toward + 1e-3 * axis, along_side, touching];
    let axis = axes[(4.0 * random()) as usize].normalize().as_vec3();
    let t_max = if random() < 0.5 { f32::INFINITY } else { (20.0 * random()) as f32 };
    let ray = Ray::new(Vec3::ZERO, direction.as_vec3(), 0.0, t_max).expect("a ray");
    (ray, Emitter::spot(position.as_vec3(), axis, outer, inner).expect("a spot"))
}

/// The cosine of the angle between the axis of a spot and the point at `t`, less `c`.
fn beyond_cosine(ray: &Ray, emitter: &Emitter, t: &Big, c: f32) -> Big {
    let exact = |v: [f32; 3]| v.map(|x| big(x.into()));
    let dot = |a: &[Big; 3], b: &[Big; 3]| &a[0] * &b[0] + &a[1] * &b[1] + &a[2] * &b[2];
    let (o, d, y) = (exact(ray.origin()), exact(ray.direction()), exact(emitter.position()));
    let a = exact(emitter.cone().expect("a spot").axis());
    let reach = t / dot(&d, &d).sqrt();
    let from_y = [0, 1, 2].map(|k| &o[k] - &y[k] + &reach * &d[k]);
    dot(&a, &from_y) / (dot(&a, &a) * dot(&from_y, &from_y)).sqrt() - big(c.into())
}

/// Where the oracle clips a ray to a cone, a point 4 ulp further in is inside and one 4 ulp further out is not; and the falloff
/// has all its digits, but for what such a change of `t`, or of the ends, makes.
#[test]
fn the_cone_of_a_spot_is_as_exact_as_f64_allows() {
    let mut state = SEED;
    let mut random = || {
        state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (state >> 11) as f64 / (1u64 << 53) as f64
    };
    let medium = Medium::new(0.0, 1.0, 0.0).expect("a medium");
    let (mut clipped, mut worst) = (0, 0.0f64);
    for _ in 0..3000 {
        let (ray, emitter) = spot(&mut random);
        let cone = emitter.cone().expect("a spot");
        let scene = oracle::Scene::new(&ray, &emitter, &medium);
        let Some((t_a, t_b)) = scene.lit() else { continue };
        let ulp = |t: f64| 4.0 * f64::EPSILON * t.abs().max((t - scene.t_h()).abs());
        let (t_min, t_max) = scene.interval();
        let beyond = |t: f64| beyond_cosine(&ray, &emitter, &big(t), cone.cos_outer());
        for (t, inwards) in [(t_a, ulp(t_a)), (t_b, -ulp(t_b))] {
            let inside = beyond(t + inwards) > big(0.0);
            assert!(inside || t_b - t_a < 2.0 * inwards.abs(), "{ray:?} {emitter:?}: {t:e} is outside");
            if t_min < t && t < t_max {
                assert!(beyond(t - inwards) < big(0.0), "{ray:?} {emitter:?}: {t:e} is inside");
                clipped += 1;
            }
        }
        let t = scene.draw(Strategy::EquiAngular, 0.01 + 0.98 * random());
        let falloff = |t: f64| {
            let fall = big(f64::from(cone.cos_inner()) - f64::from(cone.cos_outer()));
            let above = beyond(t);
            let s = if above < fall { above / fall } else { big(1.0) };
            &s * &s * (big(3.0) - big(2.0) * &s)
        };
        let (exact, moved) = (falloff(t), [falloff(t - ulp(t)), falloff(t + ulp(t))]);
        let of_t = moved.iter().map(|moved| distance(moved, &exact)).sum::<f64>() / exact.to_f64().value();
        // s is a product of the angles from both edges, S at most its square
        let of_edges = 2.0 * (ulp(t_a) / (t - t_a) + ulp(t_b) / (t_b - t));
        let error = distance(&big(scene.falloff(t)), &exact) / exact.to_f64().value() - of_t - of_edges;
        assert!(error <= BOUND, "{ray:?} {emitter:?}: at {t:e} the falloff is off by {error:e}");
        worst = worst.max(error);
    }
    println!("{clipped} ends of cones; largest error of the falloff beyond that {worst:.1e}");
    assert!(clipped > 1000, "{clipped}");
}

/// The first lit cases of a family, with their numbers.
fn lit_cases(family: Family) -> Vec<(u64, Case)> {
    let cases = (0..).map(|index| (index, family.case(SEED, index)));
    cases.filter(|(_, case)| case.scene().is_ok_and(|scene| scene.lit().is_some())).take(SCENES).collect()
}

/// One scene at one point inside.
struct Comparison {
    oracle: oracle::Scene,
    reference: Scene,
    t: f64,
    integrated: bool,
}

impl Comparison {
    fn new(case: &Case, i: usize) -> Self {
        let oracle = case.scene().expect("a valid case");
        let u = if 0.0 < case.u && case.u < 1.0 { case.u.into() } else { 0.5 };
        // A point of the lit part: Strategy::Transmittance alone may sample others.
        let lit = &Strategy::ALL[1..];
        let t = oracle.draw(lit[i % lit.len()], u);
        Self { reference: Scene::new(case), oracle, t, integrated: i.is_multiple_of(INTEGRATED) }
    }

    /// The largest error of each of the [`QUANTITIES`], and whether the rounding of distances had to excuse one.
    fn errors(&self) -> ([f64; QUANTITIES.len()], bool) {
        let exact = self.exact(&self.reference, &big(self.t));
        let mut errors = worst(&self.oracle(), &exact, &[]);
        let excused = errors[WITHOUT_SLACK..].iter().any(|&error| error > BOUND);
        if excused {
            let beyond = worst(&self.oracle(), &exact, &self.within_a_few_ulp());
            errors[WITHOUT_SLACK..].copy_from_slice(&beyond[WITHOUT_SLACK..]);
        }
        (errors, excused)
    }

    fn oracle(&self) -> Vec<f64> {
        let (scene, (t_a, t_b)) = (&self.oracle, self.oracle.lit().expect("a lit scene"));
        let radiance = if self.integrated { scene.radiance() } else { 0.0 };
        [scene.h(), scene.t_h(), t_a, t_b, scene.integrand(self.t), radiance]
            .into_iter()
            .chain(Strategy::ALL.iter().map(|&strategy| scene.pdf(strategy, self.t)))
            .chain(Strategy::ALL.iter().map(|&strategy| scene.cdf(strategy, self.t)))
            .collect()
    }

    fn exact(&self, scene: &Scene, t: &Big) -> Vec<Big> {
        let lit = scene.lit().expect("what is lit for the oracle is lit");
        let radiance = if self.integrated { scene.radiance(&lit) } else { big(0.0) };
        let (pdfs, cdfs): (Vec<_>, Vec<_>) = Densities::new(scene, &lit).at(t).into_iter().unzip();
        let [t_a, t_b] = lit;
        let first = [scene.h.clone(), scene.t_h.clone(), t_a, t_b, scene.integrand(t), radiance];
        first.into_iter().chain(pdfs).chain(cdfs).collect()
    }

    /// What becomes of the exact values where the point, the emitter, or where its light begins or ends, moves along the
    /// ray by 4 ulp of `t` or `t'`: `t`, `t_h` and `lit` are rounded to f64, so no f64 oracle can tell the difference.
    fn within_a_few_ulp(&self) -> [Vec<Big>; 3] {
        let (t_a, t_b) = self.oracle.lit().expect("a lit scene");
        let t_h = self.oracle.t_h();
        let delta = |t: f64| big(4.0 * f64::EPSILON * t.abs().max((t - t_h).abs()));
        // inwards
        let moved = if self.t < 0.5 * (t_a + t_b) { big(self.t) + delta(self.t) } else { big(self.t) - delta(self.t) };
        [
            self.exact(&self.reference, &moved),
            self.exact(&self.reference.with_emitter_moved(&delta(t_h)), &big(self.t)),
            self.exact(&self.reference.with_horizon_moved(&delta(t_a).max(delta(t_b))), &big(self.t)),
        ]
    }
}

/// The largest error of each of the [`QUANTITIES`], beyond what the values `nearby` are away from the exact ones.
fn worst(values: &[f64], exact: &[Big], nearby: &[Vec<Big>]) -> [f64; QUANTITIES.len()] {
    QUANTITIES.map(|(_, values_of_it)| {
        let error = |i: usize| {
            let slack: f64 = nearby.iter().map(|near| distance(&near[i], &exact[i])).sum();
            let size = if i < CDF { exact[i].to_f64().value().abs().max(TINY) } else { 1.0 };
            (distance(&big(values[i]), &exact[i]) - slack).max(0.0) / size
        };
        values_of_it.map(error).fold(0.0, f64::max)
    })
}

fn distance(a: &Big, b: &Big) -> f64 {
    (a - b).to_f64().value().abs()
}
