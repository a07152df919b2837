//! The density nearly proportional to the whole integrand `T rho N S`, linear between knots of the variable `v` of [`Warp`]:
//! section 6 of `docs/mathematics.md`.

use super::arc::Arc;
use super::scene::{Scene, phase};
use super::warp::{Variable, Warp, half_angle};
use std::f64::consts::PI;

/// Constants chosen by measurement for the least variance. The kernel has the same.
mod chosen {
    /// The scale of the variable: `1/Y_c = EXTINCTION mu_t + 1/(START X_a + PEAK h (1-g)/(1+g))`, where `h (1-g)/(1+g)`
    /// is the `X` at which the phase function turns.
    pub(super) const EXTINCTION: f64 = 0.45;
    pub(super) const START: f64 = 1.5;
    pub(super) const PEAK: f64 = 1.25;
    /// The share of equal spacing in the knots; the rest is that of Chebyshev's points, denser towards the ends.
    pub(super) const EQUAL: f64 = 0.65;
    /// The place where the integrand is evaluated instead of an end: its distance from the end, in widths of the segment.
    pub(super) const INSIDE: f64 = 0.125;
    /// An end with less than this share of the cosine is dark. The next constant is the factor of the next knot at a dark end (6.14).
    pub(super) const DARK: f64 = 1.0 / 4096.0;
    pub(super) const NEXT_TO_DARK: f64 = 0.25;
    /// The least value of the line, as a share of the integrand, at a dark end, at any other end, and at an inner knot.
    pub(super) const LEAST_IN_THE_DARK: f64 = 0.0625;
    pub(super) const LEAST_AT_END: f64 = 0.25;
    pub(super) const LEAST: f64 = 0.5;
    /// The largest `|g|` of the density, the f32 next below 1: at 1 the phase function has no width.
    pub(super) const LARGEST_G: f64 = 1.0 - f32::EPSILON as f64 / 2.0;
}

/// The density at a knot, and its integral up to there.
#[derive(Clone, Copy, Debug)]
struct Knot {
    at: Variable,
    f: f64,
    below: f64,
}

/// The density of one scene.
#[derive(Clone, Debug)]
pub(super) struct Product {
    warp: Warp,
    knots: Vec<Knot>,
}

impl Product {
    /// The density with `count` knots.
    pub(super) fn new(scene: &Scene, arc: Arc, count: usize) -> Self {
        Self::mixture(scene, &[scene.mu_t], arc, count)
    }

    /// The mixture in equal parts of the densities for several values of `mu_t` \[1/m\], all at the knots of the scene's own.
    pub(super) fn mixture(scene: &Scene, mu_t: &[f64], arc: Arc, count: usize) -> Self {
        let g = scene.g.clamp(-chosen::LARGEST_G, chosen::LARGEST_G);
        let y_c = scale(&arc, scene.mu_t, g);
        let warp = Warp::new(arc, y_c);
        let at = knots(count);
        let dark = dark(scene, &arc);
        let mut f = vec![0.0; count];
        for &mu_t in mu_t {
            let integrand = |at| {
                // T relative to the start.
                let transmittance = (-mu_t * warp.y(at)).exp();
                transmittance * over_v(&arc, &warp, g, at)
            };
            let mut line = lines(&at, dark, integrand);
            let sum: f64 = line.iter().sum();
            if !(sum > 0.0 && sum.is_finite()) {
                line.fill(1.0);
            }
            let mass = masses(&at, &line)[count - 1];
            f.iter_mut().zip(line).for_each(|(f, line)| *f += line / mass);
        }
        let below = masses(&at, &f);
        let knots = at.iter().zip(f).zip(below).map(|((&at, f), below)| Knot { at, f, below }).collect();
        Self { warp, knots }
    }

    pub(super) fn cdf(&self, t: f64) -> f64 {
        let at = self.warp.at(t);
        let (lower, upper) = self.segment(|knot| knot.at.v <= at.v);
        let f = lerp(lower, upper, at);
        ((lower.below + 0.5 * (lower.f + f) * (at.v - lower.at.v)) / self.total()).min(1.0)
    }

    /// The pdf over `theta` \[1/rad\] at `t` \[m\].
    pub(super) fn pdf(&self, t: f64) -> f64 {
        self.pdf_at(self.warp.at(t))
    }

    /// The same at a value of the variable.
    pub(super) fn pdf_at(&self, at: Variable) -> f64 {
        let (lower, upper) = self.segment(|knot| knot.at.v <= at.v);
        lerp(lower, upper, at) / self.total() / self.warp.slope(at)
    }

    pub(super) fn draw(&self, u: f64) -> f64 {
        let target = u * self.total();
        let (lower, upper) = self.segment(|knot| knot.below <= target);
        let width = upper.at.v - lower.at.v;
        let mass = (target - lower.below) / width;
        // The root of f_i tau + (f_{i+1} - f_i) tau^2/2 = mass, without cancellation.
        let root = (lower.f * lower.f + 2.0 * (upper.f - lower.f) * mass).max(0.0).sqrt();
        let tau = if mass > 0.0 { (2.0 * mass / (lower.f + root)).min(1.0) } else { 0.0 };
        self.warp.t(Variable { v: lower.at.v + tau * width, to_1: upper.at.to_1 + (1.0 - tau) * width })
    }

    /// The variable in which the density is piecewise linear.
    pub(super) fn warp(&self) -> &Warp {
        &self.warp
    }

    /// The values of the variable at the knots.
    pub(super) fn knots(&self) -> impl Iterator<Item = f64> {
        self.knots.iter().map(|knot| knot.at.v)
    }

    /// The distances \[m\] of the inner knots.
    pub(super) fn kinks(&self) -> Vec<f64> {
        self.knots[1..self.knots.len() - 1].iter().map(|knot| self.warp.t(knot.at)).collect()
    }

    /// The knots on both sides of a place: the last knot that `is_below` it, and the next.
    fn segment(&self, is_below: impl Fn(&Knot) -> bool) -> (&Knot, &Knot) {
        let i = self.knots.partition_point(is_below).clamp(1, self.knots.len() - 1);
        (&self.knots[i - 1], &self.knots[i])
    }

    fn total(&self) -> f64 {
        self.knots[self.knots.len() - 1].below
    }
}

/// (6.1): `Y_c` \[m\]. Its least value is part of the definition, as that of `h` is.
fn scale(arc: &Arc, mu_t: f64, g: f64) -> f64 {
    let turn = arc.h * (1.0 - g) / (1.0 + g);
    let reach = chosen::START * half_angle(arc.h, arc.a) + chosen::PEAK * turn;
    (1.0 / (chosen::EXTINCTION * mu_t + 1.0 / reach)).max(1e-18)
}

/// Which ends are dark: `N` is small compared with `|alpha| + |beta|` or, if the arc is less than a right angle, with the sum of the
/// cosines at the ends; or `S` is small.
fn dark(scene: &Scene, arc: &Arc) -> [bool; 2] {
    let ends = [arc.start(), arc.end()];
    let [n_a, n_b] = ends.map(|end| arc.cosine(end));
    let size = if arc.width() > 0.5 * PI { scene.alpha().abs() + scene.beta().abs() } else { n_a + n_b };
    ends.map(|end| arc.cosine(end) < chosen::DARK * size || arc.falloff(end) < chosen::DARK)
}

/// The integrals of the line through the values `f` at the knots, from the first up to each.
fn masses(knots: &[Variable], f: &[f64]) -> Vec<f64> {
    let mut below = vec![0.0; f.len()];
    for i in 1..f.len() {
        below[i] = below[i - 1] + 0.5 * (knots[i].v - knots[i - 1].v) * (f[i - 1] + f[i]);
    }
    below
}

/// (6.6): the knots, rounded to f32, so that the kernel has the same.
fn knots(count: usize) -> Vec<Variable> {
    let chebyshev = |s: f64| 0.5 * (1.0 - (PI * s).cos());
    let v = |s: f64| f64::from((chosen::EQUAL * s + (1.0 - chosen::EQUAL) * chebyshev(s)) as f32);
    let mut knots: Vec<Variable> = (0..count).map(|k| Variable::new(v(k as f64 / (count - 1) as f64))).collect();
    knots[count - 1] = Variable::new(1.0);
    knots
}

/// (6.11)-(6.14): the values at the knots of a line that follows `f` with little variance.
///
/// The chord of a curve that bends upwards lies above it, by a twelfth of `width^2 f''` in the mean. Lowered by that much, as by
/// least squares, it leaves a sixth of the variance. At an end, where `N`, `S` or `T` may vanish over no length at all, `f` does not
/// represent its segment; a line through a place inside does. Where `N` or `S` vanishes, this line ends at about 0, as a difference
/// without digits: a lower line is taken there, so that the least share decides.
fn lines(knots: &[Variable], dark: [bool; 2], f: impl Fn(Variable) -> f64) -> Vec<f64> {
    let last = knots.len() - 1;
    let (first, to_1) = (chosen::INSIDE * knots[1].v, chosen::INSIDE * knots[last - 1].to_1);
    let mut seen = knots.to_vec();
    seen[0] = Variable::new(first);
    seen[last] = Variable { v: 1.0 - to_1, to_1 };
    let f: Vec<f64> = seen.iter().map(|&at| f(at)).collect();

    let extended = |end: usize, next: usize, dark: bool| {
        let beyond = chosen::INSIDE / (1.0 - chosen::INSIDE);
        let (of_next, least) =
            if dark { (chosen::NEXT_TO_DARK, chosen::LEAST_IN_THE_DARK) } else { (beyond, chosen::LEAST_AT_END) };
        ((1.0 + beyond) * f[end] - of_next * f[next]).max(least * f[end])
    };
    let lowered = |i: usize| {
        let slope = |i: usize, j: usize| (f[j] - f[i]) / (seen[j].v - seen[i].v);
        let second = 2.0 * (slope(i, i + 1) - slope(i - 1, i)) / (seen[i + 1].v - seen[i - 1].v);
        let (lower, upper) = (knots[i].v - knots[i - 1].v, knots[i + 1].v - knots[i].v);
        (f[i] - second * (lower * lower + upper * upper) / 24.0).max(chosen::LEAST * f[i])
    };
    let inner = (1..last).map(lowered);
    std::iter::once(extended(0, 1, dark[0])).chain(inner).chain([extended(last, last - 1, dark[1])]).collect()
}

/// `rho N S dtheta/dv`.
fn over_v(arc: &Arc, warp: &Warp, g: f64, at: Variable) -> f64 {
    let angle = warp.angle(at);
    phase(g, arc, angle) * arc.cosine(angle) * arc.falloff(angle) * warp.slope(at)
}

/// Linear between two knots.
fn lerp(lower: &Knot, upper: &Knot, at: Variable) -> f64 {
    let width = upper.at.v - lower.at.v;
    let (from_lower, to_upper) = (at.v - lower.at.v, at.to_1 - upper.at.to_1);
    ((lower.f * to_upper + upper.f * from_lower) / width).max(0.0)
}
