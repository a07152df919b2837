//! The variable `v` of the product density: sections 5 and 6.1 of `docs/mathematics.md`.
//!
//! `X = t' + r = h tan(pi/4 + theta/2)`, so that `T` is proportional to `exp(-mu_t X)`. `Y = X - X_a` is mapped by
//! `Y = Y_c v/(e + 1 - v)`, `e = Y_c/Y_b`, which maps `[0, 1]` to `[0, Y_b]` and, if `Y_b` is far, half of it to about `Y_c`: all
//! features of the integrand then have about the same width.

use super::arc::{Angle, Arc};

/// A value of the variable, by its distances from 0 and from 1.
///
/// Each is 1 less the other, but has no digits near the other end that way.
#[derive(Clone, Copy, Debug)]
pub(super) struct Variable {
    pub(super) v: f64,
    pub(super) to_1: f64,
}

impl Variable {
    pub(super) fn new(v: f64) -> Self {
        Self { v, to_1: 1.0 - v }
    }
}

/// The map between `v` and the places of an arc.
#[derive(Clone, Copy, Debug)]
pub(super) struct Warp {
    arc: Arc,
    x_a: f64,
    x_b: f64,
    y_b: f64,
    y_c: f64,
    e: f64,
}

impl Warp {
    /// The map whose scale is `y_c` \[m\].
    pub(super) fn new(arc: Arc, y_c: f64) -> Self {
        let [x_a, x_b] = [arc.a, arc.b].map(|t_prime| half_angle(arc.h, t_prime));
        let y_b = rise(arc.h, arc.length(), arc.a, arc.b);
        Self { arc, x_a, x_b, y_b, y_c, e: y_c / y_b }
    }

    /// `Y` \[m\].
    pub(super) fn y(&self, at: Variable) -> f64 {
        self.y_c * at.v / (self.e + at.to_1)
    }

    /// `Y_b - Y` \[m\].
    fn y_to_end(&self, at: Variable) -> f64 {
        self.y_b * (1.0 + self.e) * at.to_1 / (self.e + at.to_1)
    }

    /// The value of the variable at `t` \[m\] between the ends.
    pub(super) fn at(&self, t: f64) -> Variable {
        let t_prime = t - self.arc.t_h;
        let (after_a, before_b) = self.arc.offsets(t);
        let y = rise(self.arc.h, after_a, self.arc.a, t_prime);
        let to_y_b = rise(self.arc.h, before_b, t_prime, self.arc.b);
        Variable { v: (1.0 + self.e) * y / (y + self.y_c), to_1: self.e * to_y_b / (y + self.y_c) }
    }

    /// The distance \[m\] of a place, from the nearer end.
    pub(super) fn t(&self, at: Variable) -> f64 {
        let (after_a, before_b) = self.offsets(at);
        if after_a <= before_b {
            (self.arc.t_a + after_a).min(self.arc.t_b)
        } else {
            (self.arc.t_b - before_b).max(self.arc.t_a)
        }
    }

    /// The direction of a place: twice the difference of two half angles, whose tangents are `X/h`.
    ///
    /// All terms are positive: next to a near emitter `t'` of the place would have lost its digits.
    pub(super) fn angle(&self, at: Variable) -> Angle {
        let (h, y) = (self.arc.h, self.y(at));
        let x = self.x_a + y;
        let between = |rise: f64, x_end: f64| 2.0 * (h * rise).atan2(h * h + x_end * x);
        Angle { from_a: between(y, self.x_a), to_b: between(self.y_to_end(at), self.x_b) }
    }

    /// `dtheta/dv` \[rad\]: `dX/dtheta = X/cos theta`.
    pub(super) fn slope(&self, at: Variable) -> f64 {
        let dy_dv = self.y_c * (1.0 + self.e) / (self.e + at.to_1).powi(2);
        self.arc.cos_theta(self.angle(at)) / (self.x_a + self.y(at)) * dy_dv
    }

    /// The distances of a place from the start and to the end \[m\]: `t' = (X - h^2/X)/2`.
    fn offsets(&self, at: Variable) -> (f64, f64) {
        let h = self.arc.h;
        let y = self.y(at);
        let to_y_b = self.y_to_end(at);
        let x = self.x_a + y;
        (0.5 * y * (1.0 + h / x * (h / self.x_a)), 0.5 * to_y_b * (1.0 + h / x * (h / self.x_b)))
    }
}

/// `X = t' + r` \[m\].
pub(super) fn half_angle(h: f64, t_prime: f64) -> f64 {
    let r = h.hypot(t_prime);
    if t_prime > 0.0 { t_prime + r } else { h / (r - t_prime) * h }
}

/// (5.8): `X(b) - X(a)` \[m\] of two places `length` apart, without cancellation.
fn rise(h: f64, length: f64, a: f64, b: f64) -> f64 {
    length * (half_angle(h, a) + half_angle(h, b)) / (h.hypot(a) + h.hypot(b))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn assert_close(value: f64, expected: f64, relative: f64) {
        assert!(
            (value - expected).abs() <= relative * expected.abs(),
            "{value:e} is not {expected:e} within {relative}"
        );
    }

    #[test]
    fn by_hand() {
        // h = 4 from t' = -3 to 3: X from 2 to 8
        let warp = Warp::new(Arc::new(4.0, 3.0, (0.0, 6.0), None).unwrap(), 3.0);
        assert_close(warp.y(Variable::new(1.0)), 6.0, 1e-15);
        // half of 3/(0.5 + 1/2)
        let middle = Variable::new(0.5);
        assert_close(warp.y(middle), 1.5, 1e-15);
        // X = 3.5, t' = (3.5 - 16/3.5)/2
        assert_close(warp.t(middle), 3.0 + 0.5 * (3.5 - 16.0 / 3.5), 1e-15);
        assert_eq!((warp.t(Variable::new(0.0)), warp.t(Variable::new(1.0))), (0.0, 6.0));
    }

    #[test]
    fn there_and_back_from_either_end() {
        for (h, t_h, t_b) in [(1.0, 5.0, 11.0), (1e-6, 5.0, 11.0), (1.0, -1e3, 1e18), (1e3, 1e3, 1e-3)] {
            let arc = Arc::new(h, t_h, (0.0, t_b), None).unwrap();
            for y_c in [1e-3, 1.0, 1e3] {
                let warp = Warp::new(arc, y_c);
                for v in [1e-9, 1e-3, 0.5, 0.999] {
                    let at = Variable::new(v);
                    let back = warp.at(warp.t(at));
                    // the effect of the rounding of t
                    let slope = warp.slope(at) * h.hypot(warp.t(at) - t_h).powi(2) / h;
                    let rounding = 1e-13 + 4.0 * f64::EPSILON * warp.t(at) / slope;
                    assert!((back.v - v).abs() <= rounding, "{} is not {v}, h = {h}, y_c = {y_c}", back.v);
                    assert!((back.to_1 - at.to_1).abs() <= rounding, "{} is not 1 - {v}", back.to_1);
                }
            }
        }
    }

    /// Where `t_h` is 1e8 times `h`, a place next to the foot has 8 digits of `t'` and all of its direction.
    #[test]
    fn a_direction_past_a_near_emitter_has_all_its_digits() {
        let arc = Arc::new(1e-6, 96.0, (0.0, 100.0), None).unwrap();
        let warp = Warp::new(arc, 1e-6);
        for v in [0.1, 0.3, 0.5, 0.7, 0.9] {
            let at = Variable::new(v);
            let half_angle = ((warp.x_a + warp.y(at)) / arc.h).atan();
            assert_close(arc.one_plus_sin_theta(1.0, warp.angle(at)), 2.0 * half_angle.sin().powi(2), 1e-14);
            assert_close(arc.one_plus_sin_theta(-1.0, warp.angle(at)), 2.0 * half_angle.cos().powi(2), 1e-14);
        }
    }

    #[test]
    fn the_slope_is_that_of_the_angle() {
        let warp = Warp::new(Arc::new(0.3, 5.0, (0.0, 11.0), None).unwrap(), 0.7);
        for v in [0.01, 0.5, 0.99] {
            let [low, high] = [v - 1e-5, v + 1e-5].map(|v| warp.angle(Variable::new(v)));
            assert_close(warp.slope(Variable::new(v)), Angle::between(low, high) / 2e-5, 1e-7);
        }
    }
}
