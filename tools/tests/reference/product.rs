//! The product densities over `v` of the half angle: the integrand at the knots, the line, and its pdf and CDF.

use super::number::{Big, big, exp, pi};
use super::scene::Scene;
use std::array::from_fn;
use std::sync::LazyLock;

/// The numbers of knots of the strategies.
pub(super) const COUNTS: [usize; 4] = [3, 5, 9, 17];

/// How far inside the ends the integrand is looked at, in widths of the segment.
const INSIDE: f64 = 0.125;
/// How much of the next knot the line counts against what is seen there: where it goes straight on, and at a dark end.
const OF_NEXT: [f64; 2] = [INSIDE / (1.0 - INSIDE), 0.25];
/// The least share of what is seen there that it keeps.
const LEAST_AT_END: [f64; 2] = [0.25, 0.0625];
/// The same between the ends.
const LEAST: f64 = 0.5;

/// `X = t' + r`, and with it `v`: `(1 + e) Y/(Y + Y_c)` of `Y = X - X_a`.
pub(super) struct Product<'a> {
    scene: &'a Scene,
    x_a: Big,
    y_b: Big,
    y_c: Big,
    g: Big,
    /// Whether the ends have less than a 4096th of the cosine.
    dark: [bool; 2],
}

impl<'a> Product<'a> {
    pub(super) fn new(scene: &'a Scene, [t_a, t_b]: &[Big; 2]) -> Self {
        // A phase function without width is no density: that of |g| = 1 has the width of the f32 next below.
        let most = big(f64::from(1f32.next_down()));
        let g = scene.g.clone().min(most.clone()).max(-most);
        let (x_a, x_b) = (x(scene, t_a), x(scene, t_b));
        let reach = big(1.5) * &x_a + big(1.25) * &scene.h * (big(1.0) - &g) / (big(1.0) + &g);
        let y_c = (big(1.0) / (big(0.45) * &scene.mu_t + big(1.0) / reach)).max(big(1e-18));
        Self { scene, y_b: x_b - &x_a, x_a, y_c, g, dark: dark(scene, [t_a, t_b]) }
    }

    /// The pdf and the CDF at `t` with so many knots.
    pub(super) fn at(&self, t: &Big, count: usize) -> (Big, Big) {
        let v = knots(count);
        let f = self.line(v);
        let areas: Vec<Big> = (1..count).map(|i| (&v[i] - &v[i - 1]) * (&f[i - 1] + &f[i]) / big(2.0)).collect();
        let total = areas.iter().fold(big(0.0), |sum, area| sum + area);

        let x = x(self.scene, t);
        let y = &x - &self.x_a;
        let at = (&self.y_b + &self.y_c) * &y / (&self.y_b * (&y + &self.y_c));
        let i = (1..count - 1).filter(|&i| v[i] <= at).count();
        let from_lower = &at - &v[i];
        let here = &f[i] + (&f[i + 1] - &f[i]) * &from_lower / (&v[i + 1] - &v[i]);
        let below = areas[..i].iter().fold(big(0.0), |sum, area| sum + area);
        let cdf = (below + (&f[i] + &here) * from_lower / big(2.0)) / &total;
        // dv/dX, and dX/dt = X/r
        let sum = &y + &self.y_c;
        let slope = (&self.y_b + &self.y_c) * &self.y_c / (&self.y_b * &sum * &sum) * &x / self.scene.r(t);
        (here / total * slope, cdf)
    }

    /// `T rho N dtheta/dv` but for constants.
    fn integrand(&self, v: &Big) -> Big {
        let Self { scene, x_a, y_b, y_c, g, dark: _ } = self;
        let rest = y_c / y_b + big(1.0) - v;
        let y = y_c * v / &rest;
        let x = x_a + &y;
        let (h2, x2) = (&scene.h * &scene.h, &x * &x);
        let (r, t_prime) = ((&x2 + &h2) / (big(2.0) * &x), (&x2 - &h2) / (big(2.0) * &x));
        let s = big(1.0) + g * g + big(2.0) * g * &t_prime / &r;
        let n = scene.normal.as_ref().map_or(big(1.0), |[alpha_h, beta]| (alpha_h + beta * t_prime) / &r);
        // dtheta = h dt/r^2 = h dX/(X r), dX = Y_c (1 + e) dv/rest^2
        exp(&(-&scene.mu_t * y)) * n / (&s * s.sqrt() * x * r * &rest * &rest)
    }

    /// Below the integrand by a twenty-fourth of its second difference times the squares of the widths; at the ends
    /// straight on from the next knot through the place inside, or lower.
    fn line(&self, v: &[Big]) -> Vec<Big> {
        let (zero, last) = (big(0.0), v.len() - 1);
        let mut seen = v.to_vec();
        seen[0] = big(INSIDE) * &v[1];
        seen[last] = big(1.0) - big(INSIDE) * (big(1.0) - &v[last - 1]);
        let f: Vec<Big> = seen.iter().map(|v| self.integrand(v).max(zero.clone())).collect();
        let slope = |i: usize, j: usize| (&f[j] - &f[i]) / (&seen[j] - &seen[i]);
        let line = |i: usize| {
            if i == 0 || i == last {
                let (dark, next) = if i == 0 { (self.dark[0], 1) } else { (self.dark[1], last - 1) };
                let beyond = big(1.0) / (big(1.0) - big(INSIDE));
                let end = beyond * &f[i] - big(OF_NEXT[usize::from(dark)]) * &f[next];
                return end.max(big(LEAST_AT_END[usize::from(dark)]) * &f[i]);
            }
            let second = big(2.0) * (slope(i, i + 1) - slope(i - 1, i)) / (&seen[i + 1] - &seen[i - 1]);
            let [lower, upper] = [&v[i] - &v[i - 1], &v[i + 1] - &v[i]];
            let lowered = &f[i] - second * (&lower * &lower + &upper * &upper) / big(24.0);
            lowered.max(big(LEAST) * &f[i])
        };
        let line: Vec<Big> = (0..=last).map(line).collect();
        // Nothing to go by, in f64: uniform.
        let sum = line.iter().fold(zero.clone(), |sum, f| sum + f);
        if sum > zero { line } else { vec![big(1.0); v.len()] }
    }
}

/// Compared with `|alpha| + |beta|`, or below a right angle with the sum of the cosines at the ends.
fn dark(scene: &Scene, ends: [&Big; 2]) -> [bool; 2] {
    let Some([alpha_h, beta]) = &scene.normal else { return [false; 2] };
    let t_prime = ends.map(|t| t - &scene.t_h);
    let dot = &scene.h * &scene.h + &t_prime[0] * &t_prime[1];
    let n = [0, 1].map(|end| (alpha_h + beta * &t_prime[end]) / scene.r(ends[end]));
    let abs = |x: Big| if x < big(0.0) { -x } else { x };
    let size = if dot < big(0.0) { abs(alpha_h / &scene.h) + abs(beta.clone()) } else { &n[0] + &n[1] };
    n.map(|n| n < big(1.0 / 4096.0) * &size)
}

fn x(scene: &Scene, t: &Big) -> Big {
    t - &scene.t_h + scene.r(t)
}

/// `0.65 x + 0.35 (1 - cos(pi x))/2` at equal steps, rounded to f32.
fn knots(count: usize) -> &'static [Big] {
    static KNOTS: LazyLock<[Vec<Big>; COUNTS.len()]> = LazyLock::new(|| {
        from_fn(|k| {
            let at = |i: usize| {
                let x = big(i as f64) / big((COUNTS[k] - 1) as f64);
                let v = big(0.65) * &x + big(0.175) * (big(1.0) - (pi() * x).cos());
                big(f64::from(v.to_f64().value() as f32))
            };
            (0..COUNTS[k]).map(at).collect()
        })
    });
    let k = COUNTS.iter().position(|&c| c == count).expect("a strategy has so many");
    &KNOTS[k]
}
