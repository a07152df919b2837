//! A search for the scene on which a density does worst.

use crate::contender::Contender;
use crate::draw::Draw;
use crate::scenes::along_x;
use airlight::Medium;
use airlight::oracle::Scene;
use glam::Vec3;
use serde::Serialize;
use std::array::from_fn;
use std::fmt;

/// Scenes drawn blindly for each climb; it starts from the worst.
const DRAWN: u64 = 24;
/// Steps of a climb.
const STEPS: u64 = 200;

/// A scene by what its density depends on, lengths in units of `h`.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Place {
    /// `mu_t h`.
    pub mu_t: f32,
    /// Mean cosine.
    pub g: f32,
    /// `t_h - t_min`.
    pub foot: f32,
    /// `t_max - t_min`, none if infinite.
    pub length: Option<f32>,
    /// The normal along the ray and towards it.
    pub normal: Option<[f32; 2]>,
}

impl Place {
    /// Its scene, if there is one.
    #[must_use]
    pub fn scene(&self) -> Option<Scene> {
        let normal = self.normal.map(|[along, towards]| Vec3::new(along, -towards, 0.0));
        let medium = Medium::new(0.0, self.mu_t, self.g).ok()?;
        along_x(self.length.unwrap_or(f32::INFINITY), (self.foot, 1.0), normal, medium)
            .and_then(|case| case.scene())
            .ok()
    }
}

impl fmt::Display for Place {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let length = self.length.unwrap_or(f32::INFINITY);
        write!(f, "mu_t h {:.4e}, g {:.4}, t_h/h {:.5e}, length/h {length:.5e}, ", self.mu_t, self.g, self.foot)?;
        match self.normal {
            Some([along, towards]) => write!(f, "beta {along:.6}, alpha {towards:.6}"),
            None => write!(f, "no normal"),
        }
    }
}

/// How bad a scene is.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Worst {
    /// The relative variance.
    pub variance: f64,
    /// Where.
    pub place: Place,
}

/// What is climbed on: numbers in [-1, 1] for the logarithm of `mu_t h` up to 1e3, `g`, the ends of the ray, and where
/// the emitter's plane meets it.
#[derive(Clone, Copy)]
struct Coordinates {
    numbers: [f32; 5],
    /// The side of the plane that is lit; 0 without a normal.
    side: f32,
}

/// The largest `asinh(t'/h)`, for a `t'` of 4000 h.
const REACH: f32 = 9.0;

impl Coordinates {
    fn draw(draw: &mut Draw) -> Self {
        let mut numbers = from_fn(|_| draw.between(-1.0, 1.0));
        let side = draw.pick(&[0.0, -1.0, 1.0]);
        // often at an end of the ray
        match draw.below(4) {
            0 => numbers[4] = numbers[2],
            1 => numbers[1] = numbers[1].signum(),
            _ => {}
        }
        Self { numbers, side }
    }

    /// A step of about `size` along some of the coordinates.
    fn step(&self, size: f32, draw: &mut Draw) -> Self {
        let mut stepped = *self;
        let chosen = 1 + draw.below(31);
        for (_, number) in stepped.numbers.iter_mut().enumerate().filter(|(i, _)| (chosen >> i) & 1 == 1) {
            // a heavy tail, for a look elsewhere
            let far = size * draw.pick(&[-1.0, 1.0]) * draw.log_between(0.01, 3.0);
            *number = (*number + far).clamp(-1.0, 1.0);
        }
        stepped
    }

    fn place(&self, largest_g: f32) -> Place {
        let [m, g, start, length, plane] = self.numbers;
        let foot = -(REACH * start).sinh();
        // 1e-4 h to 1e6 h, and beyond that without end
        let length = 10f32.powf(1.5 + 5.5 * length);
        let normal = |side: f32| {
            let n = side * Vec3::new(1.0, -(REACH * plane).sinh(), 0.0).normalize();
            [n.x, n.y]
        };
        Place {
            mu_t: 10f32.powf(-0.5 + 3.5 * m),
            g: largest_g * g,
            foot,
            length: (length < 1e6).then_some(length),
            normal: (self.side != 0.0).then(|| normal(self.side)),
        }
    }
}

/// One climb, to a local maximum of the variance for `|g|` up to `largest_g` and `mu_t h` up to 1e3.
///
/// None if nothing that was drawn is lit.
#[must_use]
pub fn climb(contender: Contender, largest_g: f32, seed: u64, index: u64) -> Option<Worst> {
    let mut draw = Draw::new(seed, 67, index);
    let judge = |coordinates: Coordinates| {
        let place = coordinates.place(largest_g);
        let variance = contender.variance(&place.scene()?)?;
        Some((coordinates, Worst { variance, place }))
    };
    let worse = |a: &(Coordinates, Worst), b: &(Coordinates, Worst)| a.1.variance.total_cmp(&b.1.variance);
    let drawn: Vec<Coordinates> = (0..DRAWN).map(|_| Coordinates::draw(&mut draw)).collect();
    let mut at = drawn.into_iter().filter_map(judge).max_by(worse)?;
    let mut size = 0.1;
    for _ in 0..STEPS {
        let next = judge(at.0.step(size, &mut draw)).filter(|next| worse(next, &at).is_gt());
        // one success in five keeps the size
        size = if next.is_some() { (size * 1.5).min(0.5) } else { (size * 0.9).max(1e-5) };
        at = next.unwrap_or(at);
    }
    Some(at.1)
}

#[cfg(test)]
mod tests {
    use super::*;
    use airlight::Strategy;

    #[test]
    fn a_climb_keeps_within_its_bounds_and_can_be_repeated() {
        let contender = Contender::Strategy(Strategy::Product5);
        for index in 0..4 {
            let worst = climb(contender, 0.9, 5, index).unwrap();
            assert!(worst.place.g.abs() <= 0.9 && worst.place.mu_t <= 1.001e3);
            assert_eq!(contender.variance(&worst.place.scene().unwrap()), Some(worst.variance));
            assert_eq!(climb(contender, 0.9, 5, index), Some(worst));
        }
    }
}
