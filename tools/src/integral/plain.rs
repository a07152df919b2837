//! The integral as it is written in a minute, in scalar f64: equal steps, and Gauss and Legendre's rule in the angle.

use airlight::{Emitter, FARTHEST, Medium, Ray};
use glam::{DVec3, Vec3};
use std::f64::consts::PI;

/// Equal steps of a rule that has them.
const STEPS: usize = 64;

/// A ray as its emitter sees it.
#[derive(Clone, Copy, Debug)]
pub(super) struct Line {
    h: f64,
    t_h: f64,
    t_min: f64,
    /// The lit part, from the foot of the perpendicular on; empty where the first is not less than the second.
    a: f64,
    b: f64,
    /// `N r` at the foot and its slope, with a normal; of a spot that of the cosine to its axis.
    cosine: Option<(f64, f64)>,
    /// The cosines of a spot, outer and inner.
    cone: Option<[f64; 2]>,
    mu_s: f64,
    mu_t: f64,
    g: f64,
}

fn vector(v: [f32; 3]) -> DVec3 {
    Vec3::from(v).as_dvec3()
}

impl Line {
    pub(super) fn new((ray, emitter, medium): &(Ray, Emitter, Medium)) -> Self {
        let d = vector(ray.direction()).normalize();
        let w = vector(emitter.position()) - vector(ray.origin());
        let t_h = w.dot(d);
        let foot = d * t_h - w;
        let (t_min, t_max) = (f64::from(ray.t_min()), f64::from(ray.t_max().min(FARTHEST)));
        let (mut a, mut b) = (t_min - t_h, t_max - t_h);
        let h = foot.length();
        let axis = emitter.cone().map(|cone| vector(cone.axis()).normalize());
        let cosine = emitter.normal().map(vector).or(axis).map(|n| (n.dot(foot), n.dot(d)));
        let cone = emitter.cone().map(|cone| [cone.cos_outer(), cone.cos_inner()].map(f64::from));
        if let Some(cosine) = cosine {
            let (start, end) = inside(cosine, cone.map_or(0.0, |[outer, _]| outer), h);
            (a, b) = (a.max(start), b.min(end));
        }
        let [mu_s, mu_t, g] = [medium.mu_s(), medium.mu_t(), medium.g()].map(f64::from);
        Self { h, t_h, t_min, a, b, cosine, cone, mu_s, mu_t, g }
    }

    /// `mu_s T rho N` at `t' = t - t_h`, and `r^2`.
    fn integrand(&self, t_prime: f64) -> (f64, f64) {
        let r2 = self.h * self.h + t_prime * t_prime;
        let r = r2.sqrt();
        let transmittance = (-self.mu_t * (t_prime + self.t_h - self.t_min + r)).exp();
        let d = 1.0 + self.g * self.g + 2.0 * self.g * (t_prime / r);
        let rho = (1.0 - self.g * self.g) / (4.0 * PI * d * d.sqrt());
        let cosine = self.cosine.map_or(1.0, |(at_foot, slope)| ((at_foot + slope * t_prime) / r).max(0.0));
        let n = self.cone.map_or(cosine, |cone| falloff(cosine, cone));
        (self.mu_s * transmittance * rho * n, r2)
    }

    fn over_t(&self, t_prime: f64) -> f64 {
        let (f, r2) = self.integrand(t_prime);
        f / r2
    }

    fn over_angle(&self, theta: f64) -> f64 {
        self.integrand(self.h * theta.tan()).0 / self.h
    }
}

/// Where the cosine, `m/r` with `m = at_foot + slope t'`, is above `c`: `m^2 - c^2 (h^2 + t'^2)` is a quadratic in `t'`, positive
/// in both halves of the double cone.
fn inside((at_foot, slope): (f64, f64), c: f64, h: f64) -> (f64, f64) {
    const NOWHERE: (f64, f64) = (f64::INFINITY, f64::NEG_INFINITY);
    let (square, half, rest) = (slope * slope - c * c, at_foot * slope, at_foot * at_foot - c * c * h * h);
    let root = (half * half - square * rest).max(0.0).sqrt();
    let [first, second] = [(-half - root) / square, (root - half) / square];
    if square > 0.0 {
        // A line that is steeper than the cone meets both halves.
        if slope > 0.0 { (second, f64::INFINITY) } else { (f64::NEG_INFINITY, first) }
    } else if root > 0.0 && at_foot - slope * half / square > 0.0 {
        (second, first)
    } else {
        NOWHERE
    }
}

/// Smoothstep between the cosines of a spot; 1 above both.
fn falloff(cosine: f64, [outer, inner]: [f64; 2]) -> f64 {
    let s = if cosine < inner { ((cosine - outer) / (inner - outer)).max(0.0) } else { 1.0 };
    s * s * (3.0 - 2.0 * s)
}

/// A rule: places in \[0, 1\] of the interval and their weights.
#[derive(Clone, Debug)]
pub(super) struct Plain {
    pub(super) name: &'static str,
    in_angle: bool,
    places: Vec<(f64, f64)>,
}

impl Plain {
    /// The middles of equal steps in the angle at the emitter.
    pub(super) fn steps_in_angle() -> Self {
        Self { name: "steps-in-angle", in_angle: true, places: steps() }
    }

    /// The middles of equal steps along the ray.
    pub(super) fn steps_in_t() -> Self {
        Self { name: "steps-in-t", in_angle: false, places: steps() }
    }

    /// Gauss and Legendre's rule in the angle.
    pub(super) fn gauss_in_angle(nodes: usize) -> Self {
        Self { name: "gauss-in-angle", in_angle: true, places: (0..nodes).map(|i| gauss_legendre(nodes, i)).collect() }
    }

    /// How many evaluations it takes.
    pub(super) fn nodes(&self) -> usize {
        self.places.len()
    }

    pub(super) fn radiance(&self, line: &Line) -> f64 {
        if line.a >= line.b {
            return 0.0;
        }
        let sum = |a: f64, b: f64, f: &dyn Fn(f64) -> f64| -> f64 {
            (b - a) * self.places.iter().map(|(x, weight)| weight * f(a + (b - a) * x)).sum::<f64>()
        };
        if self.in_angle {
            let angle = |t_prime: f64| t_prime.atan2(line.h);
            sum(angle(line.a), angle(line.b), &|theta| line.over_angle(theta))
        } else {
            sum(line.a, line.b, &|t_prime| line.over_t(t_prime))
        }
    }
}

fn steps() -> Vec<(f64, f64)> {
    let width = 1.0 / STEPS as f64;
    (0..STEPS).map(|i| ((i as f64 + 0.5) * width, width)).collect()
}

/// A node of the rule on \[0, 1\] and its weight, by Newton's method on the Legendre polynomial.
fn gauss_legendre(nodes: usize, index: usize) -> (f64, f64) {
    let n = nodes as f64;
    let polynomial = |x: f64| {
        let (mut below, mut p) = (1.0, x);
        for k in 2..=nodes {
            let k = k as f64;
            (below, p) = (p, ((2.0 * k - 1.0) * x * p - (k - 1.0) * below) / k);
        }
        (p, n * (x * p - below) / (x * x - 1.0))
    };
    let mut x = (PI * (index as f64 + 0.75) / (n + 0.5)).cos();
    for _ in 0..8 {
        let (p, slope) = polynomial(x);
        x -= p / slope;
    }
    let (_, slope) = polynomial(x);
    (0.5 * (1.0 - x), 1.0 / ((1.0 - x * x) * slope * slope))
}

#[cfg(test)]
mod tests {
    use super::*;
    use airlight::oracle::Scene;
    use airlight_tools::scenes::Set;

    #[test]
    fn gauss_is_exact_for_polynomials() {
        for nodes in [4, 12] {
            let places = Plain::gauss_in_angle(nodes).places;
            for degree in 0..2 * nodes as i32 {
                let sum: f64 = places.iter().map(|(x, weight)| weight * x.powi(degree)).sum();
                assert!((sum * f64::from(degree + 1) - 1.0).abs() < 1e-13, "{nodes} nodes, degree {degree}");
            }
        }
    }

    #[test]
    fn every_rule_is_near_the_integral() {
        for (case, _) in Set::Tame.cases(1, 50).into_iter().chain(Set::Spot.cases(1, 50)) {
            let parts = case.parts().unwrap();
            let (line, radiance) = (Line::new(&parts), Scene::new(&parts.0, &parts.1, &parts.2).radiance());
            let many: Vec<(f64, f64)> = (0..48).map(|i| gauss_legendre(48, i)).collect();
            for rule in [Plain::steps_in_angle(), Plain::steps_in_t()] {
                let rule = Plain { places: many.clone(), ..rule };
                let error = (rule.radiance(&line) / radiance - 1.0).abs();
                assert!(error < 0.03, "{}: {error}, {case:?}", rule.name);
            }
        }
    }
}
