//! The cone of a spot along a ray: the lit interval and the falloff there, section 8 of `docs/mathematics.md`.

use super::arc::{length, subtended};
use super::twofold::{Twofold, Vector};
use crate::scene;

/// One edge of the cone on the line of the ray.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Edge {
    /// At `t` and `t'` \[m\].
    At(f64, f64),
    /// Beyond the end of the line at infinity, by this angle at the emitter \[rad\].
    Beyond(f64),
}

/// The part of the line that is inside the outer cone.
///
/// In the plane of emitter and line the cone is a sector. With `rho` the largest cosine of `phi` in the plane,
/// `cos phi - cos_outer = 2 rho sin(before/2) sin(after/2)` (8.7), where `before` and `after` are the angles at the emitter from one
/// edge of the sector and to the other: nothing cancels, however narrow the cone.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Cone {
    lower: Edge,
    upper: Edge,
    rho: f64,
    /// `cos_inner - cos_outer`.
    fall: f64,
    /// The angle from an edge to the directions of full intensity \[rad\], if there are any and the edge is not hard.
    penumbra: Option<f64>,
}

/// The line of the ray as seen from the emitter: the direction `d`, not normalised, `w` from the emitter to the ray's origin, their
/// cross product, and the `h` of the scene.
pub(super) struct Line {
    pub(super) d: Vector,
    pub(super) w: Vector,
    pub(super) w_cross_d: Vector,
    pub(super) h: f64,
}

impl Cone {
    /// The part of the line inside the cone, if there is one.
    ///
    /// `m = a.(x - y)` is `p + q t'`, and the point is inside where `m >= c r`, which is an interval as `r` is convex. Squared (8.6),
    /// `(q^2 - c^2) t'^2 + 2 p q t' + p^2 - c^2 h^2 >= 0`, with a quarter of the discriminant `c^2 h^2 (rho^2 - c^2)`. The inside is
    /// beyond the larger root for `q > c`, below the smaller root for `q < -c`, and between the roots for `|q| < c` and `p > 0`;
    /// elsewhere `m <= -c r`. The same equation in `t` has the digits of edges near the origin.
    ///
    /// All differences are of products with twice the digits. If the emitter is on the line, they use the `h` of the scene in place
    /// of that of the positions.
    pub(super) fn new(cone: &scene::Cone, line: &Line) -> Option<Self> {
        let Line { d, w, w_cross_d: k, h } = *line;
        let a = Vector::from(cone.axis());
        let [c, c_inner] = [cone.cos_outer(), cone.cos_inner()].map(f64::from);
        let cc = Twofold::from(c) * c.into();
        let (aa, dd, kk) = (a.product(a), d.product(d), k.product(k));
        let (ad, aw, ak, pull) = (a.product(d), a.product(w), a.product(k), a.cross(d).product(k));
        let (a_length, d_length) = (a.length(), d.length());
        let true_h = k.length() / d_length;
        let on_line = h > true_h;

        let (p, q) = (pull.value() / (dd.value() * a_length), ad.value() / (a_length * d_length));
        let square = (ad * ad - cc * aa * dd).value() / (aa * dd).value();
        if square <= 0.0 && p <= 0.0 {
            return None;
        }
        // rho^2 - c^2
        let excess = if on_line {
            (p / h).powi(2) + square
        } else {
            ((Twofold::from(1.0) - cc) * aa * kk - ak * ak).value() / (aa * kk).value()
        };
        if excess <= 0.0 {
            return None;
        }
        let root = c * h * excess.sqrt();
        let lack = c * c * (h - true_h) * (h + true_h);
        let from_foot = {
            let constant = (pull * pull - cc * aa * dd * kk).value() / (aa * dd * dd).value();
            roots(square, p * q, if on_line { p * p - (c * h).powi(2) } else { constant }, root)
        };
        let from_origin = {
            let linear = (aw * ad - cc * aa * w.product(d)).value() / (aa.value() * d_length);
            let constant = (aw * aw - cc * aa * w.product(w)).value() / aa.value();
            roots(square, linear, if on_line { constant - lack } else { constant }, root)
        };
        let (alpha, rho) = (p / h, (c * c + excess).sqrt());
        let sine = excess.sqrt();
        let edge = |open: bool, side: usize| {
            if open {
                Edge::Beyond(beyond(alpha, q.abs(), c, sine, square))
            } else {
                Edge::At(from_origin[side], from_foot[side])
            }
        };
        let full = c < c_inner && c_inner < rho;
        let penumbra = full.then(|| sine.atan2(c) - ((rho - c_inner) * (rho + c_inner)).sqrt().atan2(c_inner));
        Some(Self {
            lower: edge(square >= 0.0 && q <= 0.0, 0),
            upper: edge(square >= 0.0 && q >= 0.0, 1),
            rho,
            fall: c_inner - c,
            penumbra,
        })
    }

    /// The same for a foot of the perpendicular that is `nearer` to the origin \[m\].
    pub(super) fn with_foot(self, nearer: f64) -> Self {
        let moved = |edge| match edge {
            Edge::At(t, t_prime) => Edge::At(t, t_prime + nearer),
            beyond @ Edge::Beyond(_) => beyond,
        };
        Self { lower: moved(self.lower), upper: moved(self.upper), ..self }
    }

    /// The part of an interval inside the cone; ends are given by `t` and `t'` \[m\].
    pub(super) fn clip(&self, [mut start, mut end]: [(f64, f64); 2]) -> [(f64, f64); 2] {
        if let Edge::At(t, t_prime) = self.lower
            && start.0 < t
        {
            start = (t, t_prime);
        }
        if let Edge::At(t, t_prime) = self.upper
            && t < end.0
        {
            end = (t, t_prime);
        }
        [start, end]
    }

    /// The angle from the lower edge to a point inside, given by its `t` and `t'` \[m\].
    pub(super) fn before(&self, h: f64, point: (f64, f64)) -> f64 {
        match self.lower {
            Edge::At(t, t_prime) => subtended(h, length((t, t_prime), point), t_prime, point.1),
            Edge::Beyond(angle) => angle + h.atan2(-point.1),
        }
    }

    /// The angle from a point inside to the upper edge.
    pub(super) fn after(&self, h: f64, point: (f64, f64)) -> f64 {
        match self.upper {
            Edge::At(t, t_prime) => subtended(h, length(point, (t, t_prime)), point.1, t_prime),
            Edge::Beyond(angle) => angle + h.atan2(point.1),
        }
    }

    /// The falloff `S` at a point of the line, given by its `t` and `t'` \[m\]: 0 outside.
    pub(super) fn falloff_at(&self, h: f64, point: (f64, f64)) -> f64 {
        let inside = self.clip([point; 2]) == [point; 2];
        if inside { self.falloff(self.before(h, point), self.after(h, point)) } else { 0.0 }
    }

    /// The falloff `S` in a direction inside, given its angles from the lower edge and to the upper edge.
    pub(super) fn falloff(&self, before: f64, after: f64) -> f64 {
        if self.fall == 0.0 {
            return 1.0;
        }
        let s = 2.0 * self.rho * (0.5 * before).sin() * (0.5 * after).sin() / self.fall;
        if s < 1.0 { s * s * (3.0 - 2.0 * s) } else { 1.0 }
    }

    /// The angle from an edge to the directions of full intensity \[rad\], if there are any and the edge is not hard.
    pub(super) fn penumbra(&self) -> Option<f64> {
        self.penumbra
    }
}

/// `(-b + root)/a` and `(-b - root)/a`, the zeros of `a x^2 + 2 b x + c`, neither as a difference.
fn roots(a: f64, b: f64, c: f64, root: f64) -> [f64; 2] {
    if b <= 0.0 {
        let sum = root - b;
        if sum == 0.0 { [0.0; 2] } else { [sum / a, c / sum] }
    } else {
        let sum = -b - root;
        [c / sum, sum / a]
    }
}

/// The angle by which an edge of the sector is beyond the end of the line that has the cosine `beta >= 0` with the axis \[rad\]. The
/// edge is at an angle of `atan2(sine, c)` from the axis, and `square = beta^2 - c^2`.
fn beyond(alpha: f64, beta: f64, c: f64, sine: f64, square: f64) -> f64 {
    let across = if square == 0.0 {
        0.0
    } else if alpha > 0.0 {
        square * (alpha * alpha + beta * beta) / (alpha * c + beta * sine)
    } else {
        beta * sine - alpha * c
    };
    across.atan2(alpha * sine + beta * c)
}
