//! The density proportional to the whole integrand `T rho N`, linear between its values at some knots of the variable
//! `v` of [`Warp`].

use super::arc::Arc;
use super::scene::{Scene, phase};
use super::warp::{Variable, Warp, half_angle};
use std::f64::consts::PI;

/// What was chosen by measurement, for the least variance. The kernel has the same numbers.
mod chosen {
    /// The scale of the variable: `1/Y_c = EXTINCTION mu_t + 1/(START X_a + PEAK h (1-g)/(1+g))`, where `h (1-g)/(1+g)`
    /// is the `X` at which the phase function turns.
    pub(super) const EXTINCTION: f64 = 0.45;
    pub(super) const START: f64 = 1.5;
    pub(super) const PEAK: f64 = 1.25;
    /// The share of equal spacing in the knots; the rest is that of Chebyshev's points, denser towards the ends.
    pub(super) const EQUAL: f64 = 0.7;
    /// How fast the floor of the last knot sinks with `mu_t`.
    pub(super) const SINK: f64 = 1.5;
    /// The largest `|g|` that the density is made for: at 1 there would be nothing between the peaks.
    pub(super) const LARGEST_G: f64 = 1.0 - 1.0 / 4096.0;
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
        let g = scene.g.clamp(-chosen::LARGEST_G, chosen::LARGEST_G);
        let y_c = scale(&arc, scene.mu_t, g);
        let warp = Warp::new(arc, y_c);
        let at = knots(count);
        // Relative to the start.
        let transmittance = |at| (-scene.mu_t * warp.y(at)).exp();
        let mut f: Vec<f64> = at.iter().map(|&at| transmittance(at) * over_v(&arc, &warp, g, at)).collect();

        // At an end that is many free paths away nothing is left, but on the way there is.
        let (last, before) = (at[count - 1], at[count - 2]);
        let z = chosen::SINK * scene.mu_t * (warp.y(before) + y_c);
        let floor = transmittance(before) * ((1.0 - z) / (1.0 + z)).max(0.0);
        f[count - 1] = transmittance(last).max(floor) * over_v(&arc, &warp, g, last);

        let sum: f64 = f.iter().sum();
        if !(sum > 0.0 && sum.is_finite()) {
            f.fill(1.0);
        }
        let mut below = 0.0;
        let mut knots: Vec<Knot> = at.iter().zip(f).map(|(&at, f)| Knot { at, f, below: 0.0 }).collect();
        for i in 1..count {
            below += 0.5 * (knots[i].at.v - knots[i - 1].at.v) * (knots[i - 1].f + knots[i].f);
            knots[i].below = below;
        }
        Self { warp, knots }
    }

    pub(super) fn cdf(&self, t: f64) -> f64 {
        let at = self.warp.at(t);
        let (lower, upper) = self.segment(|knot| knot.at.v <= at.v);
        let f = lerp(lower, upper, at);
        ((lower.below + 0.5 * (lower.f + f) * (at.v - lower.at.v)) / self.total()).min(1.0)
    }

    /// Over `theta` \[1/rad\], at `t` \[m\].
    pub(super) fn pdf(&self, t: f64) -> f64 {
        self.pdf_at(self.warp.at(t))
    }

    /// The same at a value of the variable.
    pub(super) fn pdf_at(&self, at: Variable) -> f64 {
        let (lower, upper) = self.segment(|knot| knot.at.v <= at.v);
        lerp(lower, upper, at) / self.total() / self.warp.slope(at)
    }

    pub(super) fn invert(&self, u: f64) -> f64 {
        let target = u * self.total();
        let (lower, upper) = self.segment(|knot| knot.below <= target);
        let width = upper.at.v - lower.at.v;
        let mass = (target - lower.below) / width;
        // The root of f_i tau + (f_{i+1} - f_i) tau^2/2 = mass, without cancellation.
        let root = (lower.f * lower.f + 2.0 * (upper.f - lower.f) * mass).max(0.0).sqrt();
        let tau = if mass > 0.0 { (2.0 * mass / (lower.f + root)).min(1.0) } else { 0.0 };
        self.warp.t(Variable { v: lower.at.v + tau * width, to_1: upper.at.to_1 + (1.0 - tau) * width })
    }

    /// The variable that it is linear in, between the knots.
    pub(super) fn warp(&self) -> &Warp {
        &self.warp
    }

    /// The values of the variable at the knots.
    pub(super) fn knots(&self) -> impl Iterator<Item = f64> {
        self.knots.iter().map(|knot| knot.at.v)
    }

    /// The distances \[m\] of the knots but the ends.
    pub(super) fn kinks(&self) -> Vec<f64> {
        self.knots[1..self.knots.len() - 1].iter().map(|knot| self.warp.t(knot.at)).collect()
    }

    /// The knots around a place, the first of which is the last that `is_below` it.
    fn segment(&self, is_below: impl Fn(&Knot) -> bool) -> (&Knot, &Knot) {
        let i = self.knots.partition_point(is_below).clamp(1, self.knots.len() - 1);
        (&self.knots[i - 1], &self.knots[i])
    }

    fn total(&self) -> f64 {
        self.knots[self.knots.len() - 1].below
    }
}

/// `Y_c` \[m\], no shorter than any length.
fn scale(arc: &Arc, mu_t: f64, g: f64) -> f64 {
    let turn = arc.h * (1.0 - g) / (1.0 + g);
    let reach = chosen::START * half_angle(arc.h, arc.a) + chosen::PEAK * turn;
    (1.0 / (chosen::EXTINCTION * mu_t + 1.0 / reach)).max(1e-18)
}

/// Where the knots are.
fn knots(count: usize) -> Vec<Variable> {
    let chebyshev = |s: f64| 0.5 * (1.0 - (PI * s).cos());
    let v = |s: f64| chosen::EQUAL * s + (1.0 - chosen::EQUAL) * chebyshev(s);
    let mut knots: Vec<Variable> = (0..count).map(|k| Variable::new(v(k as f64 / (count - 1) as f64))).collect();
    knots[count - 1] = Variable::new(1.0);
    knots
}

/// `rho N dtheta/dv`.
fn over_v(arc: &Arc, warp: &Warp, g: f64, at: Variable) -> f64 {
    let angle = warp.angle(at);
    phase(g, arc, angle) * arc.cosine(angle) * warp.slope(at)
}

/// Linear between two knots.
fn lerp(lower: &Knot, upper: &Knot, at: Variable) -> f64 {
    let width = upper.at.v - lower.at.v;
    let (from_lower, to_upper) = (at.v - lower.at.v, at.to_1 - upper.at.to_1);
    ((lower.f * to_upper + upper.f * from_lower) / width).max(0.0)
}
