//! The lit part of a ray as an arc of directions seen from the emitter: section 2 of `docs/mathematics.md`.

use super::cone::Cone;
use std::f64::consts::FRAC_PI_2;

/// `m = r N = alpha h + beta t'` of an emitter with a normal, linear along the ray (2.4).
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Normal {
    pub(super) alpha_h: f64,
    pub(super) beta: f64,
    /// Its value at `t = 0` \[m\]: `alpha h - beta t_h`, not computed as this difference of large numbers.
    pub(super) at_0: f64,
}

impl Normal {
    /// `r N` \[m\], from the nearer of `t = 0` and the foot; negative on the dark side.
    pub(super) fn height(&self, t: f64, t_prime: f64) -> f64 {
        if t.abs() < t_prime.abs() { self.at_0 + self.beta * t } else { self.alpha_h + self.beta * t_prime }
    }
}

/// A direction of the arc, by its angles from the start and to the end \[rad\].
///
/// Each is the width less the other, but has no digits near the other end that way.
#[derive(Clone, Copy, Debug)]
pub(super) struct Angle {
    pub(super) from_a: f64,
    pub(super) to_b: f64,
}

impl Angle {
    /// The angle from `lower` to `upper`, as the difference of the smaller numbers.
    pub(super) fn between(lower: Self, upper: Self) -> f64 {
        if lower.to_b < upper.from_a { lower.to_b - upper.to_b } else { upper.from_a - lower.from_a }
    }

    /// `lower` at `s` = 0, `upper` at `s` = 1.
    pub(super) fn lerp(lower: Self, upper: Self, s: f64) -> Self {
        let mix = |x: f64, y: f64| (1.0 - s) * x + s * y;
        Self { from_a: mix(lower.from_a, upper.from_a), to_b: mix(lower.to_b, upper.to_b) }
    }
}

/// The cone of a spot, and the angles by which the ends of an arc are inside \[rad\].
#[derive(Clone, Copy, Debug, PartialEq)]
struct Spot {
    cone: Cone,
    /// From the lower edge of the cone to the start of the arc, and from the end of the arc to the upper edge.
    before_a: f64,
    after_b: f64,
}

/// The lit part of a ray, from `t_a` to `t_b`: where `N > 0`, or inside the cone.
///
/// `psi = pi/2 + theta` and `chi = pi/2 - theta` are the ray's angles with the line to the emitter. They resolve the far ends of a
/// long ray, where `theta` is nearly -pi/2 and pi/2.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Arc {
    pub(super) t_a: f64,
    pub(super) t_b: f64,
    /// `t_a - t_h` and `t_b - t_h`.
    pub(super) a: f64,
    pub(super) b: f64,
    pub(super) h: f64,
    pub(super) t_h: f64,
    psi_a: f64,
    chi_b: f64,
    /// The subtended angle `theta_b - theta_a`.
    width: f64,
    /// `N` and `dN/dtheta` at both ends.
    cosines: Option<[(f64, f64); 2]>,
    spot: Option<Spot>,
}

impl Arc {
    /// The part of `[t_min, t_max]` with `N > 0`, if there is one.
    pub(super) fn new(h: f64, t_h: f64, (t_min, t_max): (f64, f64), normal: Option<Normal>) -> Option<Self> {
        let (mut t_a, mut t_b, mut a, mut b) = (t_min, t_max, t_min - t_h, t_max - t_h);
        let (mut height_a, mut height_b) = (1.0, 1.0);
        if let Some(n) = normal {
            (height_a, height_b) = (n.height(t_a, a), n.height(t_b, b));
            if height_a <= 0.0 && height_b <= 0.0 {
                return None;
            }
            let (horizon, from_foot) = (-n.at_0 / n.beta, -n.alpha_h / n.beta);
            if height_a <= 0.0 {
                (t_a, a, height_a) = (horizon, from_foot, 0.0);
            }
            if height_b <= 0.0 {
                (t_b, b, height_b) = (horizon, from_foot, 0.0);
            }
        }
        let (r_a, r_b) = (a.hypot(h), b.hypot(h));
        let cosines = normal.map(|n| {
            // dN/dtheta = beta cos theta - alpha sin theta
            let slope = |t_prime: f64, r: f64| (n.beta * h - n.alpha_h * (t_prime / h)) / r;
            [(height_a / r_a, slope(a, r_a)), (height_b / r_b, slope(b, r_b))]
        });
        Self::between(h, t_h, [(t_a, a), (t_b, b)]).map(|arc| Self { cosines, ..arc })
    }

    /// The part of `[t_min, t_max]` inside a cone, if there is one.
    pub(super) fn in_cone(h: f64, t_h: f64, (t_min, t_max): (f64, f64), cone: Cone) -> Option<Self> {
        let ends @ [start, end] = cone.clip([(t_min, t_min - t_h), (t_max, t_max - t_h)]);
        let spot = Spot { cone, before_a: cone.before(h, start), after_b: cone.after(h, end) };
        Self::between(h, t_h, ends).map(|arc| Self { spot: Some(spot), ..arc })
    }

    /// The arc between two points, each given by its `t` and `t'` \[m\], if the second is behind the first: without normal or cone.
    fn between(h: f64, t_h: f64, [(t_a, a), (t_b, b)]: [(f64, f64); 2]) -> Option<Self> {
        if t_a >= t_b {
            return None;
        }
        let width = subtended(h, length((t_a, a), (t_b, b)), a, b);
        let (psi_a, chi_b) = (h.atan2(-a), h.atan2(b));
        Some(Self { t_a, t_b, a, b, h, t_h, psi_a, chi_b, width, cosines: None, spot: None })
    }

    pub(super) fn start(&self) -> Angle {
        Angle { from_a: 0.0, to_b: self.width }
    }

    pub(super) fn end(&self) -> Angle {
        Angle { from_a: self.width, to_b: 0.0 }
    }

    /// The direction `s` \[rad\] after the start.
    pub(super) fn after(&self, s: f64) -> Angle {
        Angle { from_a: s, to_b: self.width - s }
    }

    /// The direction whose angles from the start and to the end have the ratio `exp(s)`.
    pub(super) fn at_odds(&self, s: f64) -> Angle {
        Angle { from_a: self.width / (1.0 + (-s).exp()), to_b: self.width / (1.0 + s.exp()) }
    }

    pub(super) fn width(&self) -> f64 {
        self.width
    }

    /// The direction of the point at `t` \[m\] between `t_a` and `t_b`.
    pub(super) fn at(&self, t: f64) -> Angle {
        let t_prime = t - self.t_h;
        let (after_a, before_b) = self.offsets(t);
        Angle {
            from_a: subtended(self.h, after_a, self.a, t_prime),
            to_b: subtended(self.h, before_b, t_prime, self.b),
        }
    }

    /// The distances of the point at `t` \[m\] between `t_a` and `t_b` from the start and to the end \[m\].
    pub(super) fn offsets(&self, t: f64) -> (f64, f64) {
        let at = (t, t - self.t_h);
        (length((self.t_a, self.a), at), length(at, (self.t_b, self.b)))
    }

    /// `t_b - t_a` \[m\].
    pub(super) fn length(&self) -> f64 {
        length((self.t_a, self.a), (self.t_b, self.b))
    }

    /// The distance \[m\] of the point in a direction, from the nearer end by the law of sines.
    pub(super) fn t(&self, angle: Angle) -> f64 {
        let cos_theta = self.cos_theta(angle);
        let after_a = self.a.hypot(self.h) * angle.from_a.sin() / cos_theta;
        let before_b = self.b.hypot(self.h) * angle.to_b.sin() / cos_theta;
        if after_a <= before_b { (self.t_a + after_a).min(self.t_b) } else { (self.t_b - before_b).max(self.t_a) }
    }

    /// `theta` \[rad\] of a direction.
    pub(super) fn theta(&self, angle: Angle) -> f64 {
        self.psi(angle) - FRAC_PI_2
    }

    /// `cos theta = h/r`.
    pub(super) fn cos_theta(&self, angle: Angle) -> f64 {
        self.psi(angle).min(self.chi(angle)).sin()
    }

    /// `1 + sign sin theta`.
    pub(super) fn one_plus_sin_theta(&self, sign: f64, angle: Angle) -> f64 {
        let complement = if sign > 0.0 { self.psi(angle) } else { self.chi(angle) };
        2.0 * (0.5 * complement).sin().powi(2)
    }

    /// `N`, from the end where it is smaller, or 1 without a normal.
    pub(super) fn cosine(&self, angle: Angle) -> f64 {
        let Some([(n_a, slope_a), (n_b, slope_b)]) = self.cosines else { return 1.0 };
        let n = if n_a < n_b {
            n_a * angle.from_a.cos() + slope_a * angle.from_a.sin()
        } else {
            n_b * angle.to_b.cos() - slope_b * angle.to_b.sin()
        };
        n.max(0.0)
    }

    /// The falloff `S`, or 1 if the emitter is no spot.
    pub(super) fn falloff(&self, angle: Angle) -> f64 {
        self.spot.map_or(1.0, |spot| spot.cone.falloff(spot.before_a + angle.from_a, angle.to_b + spot.after_b))
    }

    /// The directions of the arc where the falloff is not smooth, ascending.
    pub(super) fn kinks(&self) -> Vec<Angle> {
        let Some(Spot { cone, before_a, after_b }) = self.spot else { return vec![] };
        let Some(penumbra) = cone.penumbra() else { return vec![] };
        let (first, last) = (penumbra - before_a, penumbra - after_b);
        let kinks = [self.after(first), Angle { from_a: self.width - last, to_b: last }];
        kinks.into_iter().filter(|kink| 0.0 < kink.from_a && 0.0 < kink.to_b).collect()
    }

    /// The integral of `N` over the directions from `lower` to `upper`: twice the sine of half the angle between them,
    /// times `N` in the middle.
    pub(super) fn integral_of_cosine(&self, lower: Angle, upper: Angle) -> f64 {
        let width = Angle::between(lower, upper);
        if self.cosines.is_none() {
            return width;
        }
        2.0 * (0.5 * width).sin() * self.cosine(Angle::lerp(lower, upper, 0.5))
    }

    fn psi(&self, angle: Angle) -> f64 {
        self.psi_a + angle.from_a
    }

    fn chi(&self, angle: Angle) -> f64 {
        self.chi_b + angle.to_b
    }
}

/// The distance \[m\] between two points, each given by its `t` and `t'`, as the difference of the smaller numbers.
///
/// An end where `N = 0` next to an emitter has more digits in `t'` than in `t`. Differences of `t` from the start and to such an end
/// would not add up to the difference of `t'`: the point would have two places.
pub(super) fn length((t_0, t_prime_0): (f64, f64), (t_1, t_prime_1): (f64, f64)) -> f64 {
    let near = t_prime_0.abs().max(t_prime_1.abs()) < t_0.abs().max(t_1.abs());
    if near { (t_prime_1 - t_prime_0).max(0.0) } else { t_1 - t_0 }
}

/// (2.6): the angle at the emitter between the points at `a` and `b` from the foot of the perpendicular, `length` apart \[m\].
pub(super) fn subtended(h: f64, length: f64, a: f64, b: f64) -> f64 {
    (h * length).atan2(h * h + a * b)
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::f64::consts::PI;

    fn assert_close(value: f64, expected: f64, relative: f64) {
        assert!(
            (value - expected).abs() <= relative * expected.abs(),
            "{value:e} is not {expected:e} within {relative}"
        );
    }

    #[test]
    fn half_a_turn_by_hand() {
        let arc = Arc::new(1.0, 1.0, (0.0, 2.0), None).unwrap();
        assert_close(arc.width(), 0.5 * PI, 1e-15);
        let foot = arc.at(1.0);
        assert_close(foot.from_a, 0.25 * PI, 1e-15);
        assert_close(foot.to_b, 0.25 * PI, 1e-15);
        assert_close(arc.cos_theta(foot), 1.0, 1e-15);
        assert!(arc.theta(foot).abs() < 1e-15);
        assert_close(arc.t(foot), 1.0, 1e-15);
        assert_close(arc.one_plus_sin_theta(1.0, arc.end()), 1.0 + 0.5f64.sqrt(), 1e-15);
        assert_close(arc.one_plus_sin_theta(-1.0, arc.end()), 1.0 - 0.5f64.sqrt(), 1e-15);
        assert_close(arc.integral_of_cosine(arc.start(), foot), 0.25 * PI, 1e-15);
        let down = Normal { alpha_h: 1.0, beta: 0.0, at_0: 1.0 };
        let arc = Arc::new(1.0, 1.0, (0.0, 2.0), Some(down)).unwrap();
        assert_close(arc.integral_of_cosine(arc.start(), foot), 0.5f64.sqrt(), 1e-15);
    }

    #[test]
    fn an_angle_between_directions_has_all_its_digits() {
        let arc = Arc::new(1.0, 5.0, (0.0, 11.0), None).unwrap();
        let near_the_end = Angle { from_a: arc.width(), to_b: 1e-20 };
        assert_eq!(Angle::between(near_the_end, arc.end()), 1e-20);
        assert_eq!(Angle::between(arc.start(), arc.at_odds(-50.0)), arc.width() / (1.0 + 50f64.exp()));
    }

    /// On a long ray past a near emitter, both ends are resolved, and so is what lies between.
    #[test]
    fn a_direction_has_its_distance() {
        for h in [1e-9, 1e-3, 1.0] {
            let arc = Arc::new(h, 5.0, (0.0, 11.0), None).unwrap();
            for from_end in [1e-9, 1e-3, 1.0, 4.0] {
                assert_close(arc.t(arc.at(from_end)), from_end, 1e-14);
                assert_close(11.0 - arc.t(arc.at(11.0 - from_end)), from_end, 1e-14 + 1e-14 / from_end);
            }
        }
        let arc = Arc::new(1.0, 5.0, (0.0, 1e18), None).unwrap();
        for t in [1.0, 1e3, 1e9, 1e15] {
            assert_close(arc.t(arc.at(t)), t, 1e-14);
        }
    }

    /// N is 0 at the emitter's horizon; beside it, it is no difference of large numbers.
    #[test]
    fn the_cosine_is_exact_at_either_horizon() {
        for sign in [-1.0, 1.0] {
            let normal = Normal { alpha_h: 0.8, beta: 0.6 * sign, at_0: 0.8 };
            let horizon = -0.8 / (0.6 * sign);
            // from t_h = 0 on, t is t'
            let arc = Arc::new(1.0, 0.0, (-9.0, 9.0), Some(normal)).unwrap();
            assert_eq!(if sign > 0.0 { arc.t_a } else { arc.t_b }, horizon);
            assert_eq!(arc.cosine(if sign > 0.0 { arc.start() } else { arc.end() }), 0.0);
            for away in [1e-9, 1e-6, 1e-3, 1.0] {
                let t = horizon + sign * away;
                let exact = 0.6 * (t - horizon).abs() / t.hypot(1.0);
                assert_close(arc.cosine(arc.at(t)), exact, 1e-14);
            }
        }
    }

    #[test]
    fn what_the_normal_turns_away_from_is_dark() {
        let arc = |alpha_h, beta| Arc::new(1.0, 0.0, (1.0, 9.0), Some(Normal { alpha_h, beta, at_0: alpha_h }));
        assert_eq!(arc(-1.0, 0.0), None);
        assert_eq!(arc(0.0, 0.0), None);
        assert_eq!(arc(0.0, -1.0), None);
        assert_eq!(arc(0.8, -0.8), None); // lit up to t = 1
        assert_eq!(arc(0.8, -0.4).map(|arc| (arc.t_a, arc.t_b)), Some((1.0, 2.0)));
        assert_eq!(Arc::new(1.0, 0.0, (1.0, 1.0), None), None);
    }
}
