//! Sets of scenes on which variances and integrals are compared.

use crate::draw::Draw;
use crate::families::{CHANNELS, Case, Family};
use airlight::oracle::{Coloured, Scene};
use airlight::{Emitter, Error, Medium, Ray};
use glam::Vec3;

/// A set of random scenes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Set {
    /// `h` 1e-4 to 1e2 m, the emitter beside, before or behind a ray of 1e-3 to 1e4 m or without end, `mu_t h` 1e-4 to
    /// 100, `g` -0.95 to 0.99, with no normal, any, one that is dark near an end of the ray, or one along it.
    Broad,
    /// The family `generic`: rays in a box of side 10 around the emitter, any normal, `mu_t` 0.7 per m, `g` 0 or 0.9.
    Generic,
    /// The same in `mu_t` 4 per m, `g` 0 to 0.95.
    Dense,
    /// `h` 0.1 to 10 m, rays of 0.5 to 20 m, `mu_t h` up to 3, `g` 0 to 0.9, with no normal or any.
    Tame,
    /// The rays of `generic` with spots: any axis, half-angles of 2 to 60 degrees, edges from hard to soft.
    Spot,
    /// The rays of `generic` in media of three channels, `mu_t` 0.49, 0.7 and 0.98 per m.
    Colour,
    /// The same with 0.21, 0.7 and 2.1 per m.
    ColourStrong,
    /// Camera rays through a box of side 4 m with the emitter in its middle, `mu_a` 0.5 and `mu_s` 0.2 per m.
    Canonical {
        /// Mean cosine 0.9, else 0.
        forward: bool,
        /// With a normal, any.
        normal: bool,
    },
}

impl Set {
    /// Its name in tables and in JSON.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Broad => "broad",
            Self::Generic => "generic",
            Self::Dense => "dense",
            Self::Tame => "tame",
            Self::Spot => "spot",
            Self::Colour => "colour",
            Self::ColourStrong => "colour-strong",
            Self::Canonical { forward: false, normal: false } => "canonical-g0-point",
            Self::Canonical { forward: false, normal: true } => "canonical-g0-point-normal",
            Self::Canonical { forward: true, normal: false } => "canonical-g0.9-point",
            Self::Canonical { forward: true, normal: true } => "canonical-g0.9-point-normal",
        }
    }

    /// What a name on the command line stands for: `canonical` for four sets.
    #[must_use]
    pub fn named(name: &str) -> Option<Vec<Self>> {
        let canonical = [(false, false), (false, true), (true, false), (true, true)]
            .map(|(forward, normal)| Self::Canonical { forward, normal });
        match name {
            "broad" => Some(vec![Self::Broad]),
            "generic" => Some(vec![Self::Generic]),
            "dense" => Some(vec![Self::Dense]),
            "tame" => Some(vec![Self::Tame]),
            "spot" => Some(vec![Self::Spot]),
            "colour" => Some(vec![Self::Colour]),
            "colour-strong" => Some(vec![Self::ColourStrong]),
            "canonical" => Some(canonical.to_vec()),
            _ => canonical.into_iter().find(|set| set.name() == name).map(|set| vec![set]),
        }
    }

    /// The first `count` scenes under a seed of which something is lit.
    #[must_use]
    pub fn scenes(self, seed: u64, count: usize) -> Vec<Scene> {
        self.lit(seed).map(|(_, scene)| scene).take(count).collect()
    }

    /// The same with all channels of coloured media.
    #[must_use]
    pub fn coloured(self, seed: u64, count: usize) -> Vec<Coloured> {
        self.lit(seed).filter_map(|(case, _)| case.coloured().ok()).take(count).collect()
    }

    /// The same with the f32 values that describe them.
    #[must_use]
    pub fn cases(self, seed: u64, count: usize) -> Vec<(Case, Scene)> {
        self.lit(seed).take(count).collect()
    }

    fn lit(self, seed: u64) -> impl Iterator<Item = (Case, Scene)> {
        let case = move |index| self.case(seed, index).and_then(|case| Some((case, case.scene().ok()?)));
        (0..).filter_map(case).filter(|(_, scene)| scene.lit().is_some())
    }

    fn case(self, seed: u64, index: u64) -> Option<Case> {
        match self {
            Self::Generic => Ok(Family::Generic.case(seed, index)),
            Self::Spot => Ok(spot(&mut Draw::new(seed, 68, index))),
            Self::Colour => Ok(colour(&mut Draw::new(seed, 69, index), [0.7, 1.0, 1.4])),
            Self::ColourStrong => Ok(colour(&mut Draw::new(seed, 70, index), [0.3, 1.0, 3.0])),
            Self::Dense => dense(&mut Draw::new(seed, 67, index)),
            Self::Broad => broad(&mut Draw::new(seed, 64, index)),
            Self::Tame => tame(&mut Draw::new(seed, 65, index)),
            Self::Canonical { forward, normal } => {
                canonical(&mut Draw::new(seed, 66, index), if forward { 0.9 } else { 0.0 }, normal)
            }
        }
        .ok()
    }
}

fn dense(draw: &mut Draw) -> Result<Case, Error> {
    let case = Case::generic(draw);
    Ok(case.within(&Medium::new(0.0, 4.0, draw.between(0.0, 0.95))?))
}

fn spot(draw: &mut Draw) -> Case {
    let (case, axis) = (Case::generic(draw), draw.direction());
    let half_angle = f64::from(draw.between(2.0, 60.0));
    case.with_cone(draw, axis, half_angle.to_radians().cos() as f32)
}

fn colour(draw: &mut Draw, ratios: [f32; CHANNELS]) -> Case {
    Case::generic(draw).with_channels(ratios.map(|x| 0.5 * x), ratios.map(|x| 0.2 * x), 1)
}

fn broad(draw: &mut Draw) -> Result<Case, Error> {
    let h = draw.log_between(1e-4, 1e2);
    let mu_t = draw.log_between(1e-4, 1e2) / h;
    let g = draw.between(-0.95, 0.99);
    let length = if draw.below(4) == 0 { f32::INFINITY } else { draw.log_between(1e-3, 1e4) };
    // beside, before and behind; by the length of the ray, or by h
    let foot = if length.is_finite() && draw.below(2) == 0 {
        length * draw.between(-1.0, 2.0)
    } else {
        h * draw.pick(&[-1.0, 1.0]) * draw.log_between(1e-3, 1e3)
    };
    let (a, b) = (-foot, length.min(1e3 * h.max(foot.abs())) - foot);
    let near = |end: f32, draw: &mut Draw| end + draw.between(-0.1, 0.1) * (b - a);
    let normal = match draw.below(5) {
        0 => None,
        1 => Some(draw.direction()),
        2 => Some(dark_at(near(a, draw), h, draw)),
        3 => Some(dark_at(near(b, draw), h, draw)),
        _ => Some(Vec3::X * draw.pick(&[-1.0, 1.0])),
    };
    along_x(length, (foot, h), normal, Medium::new(0.0, mu_t, g)?)
}

fn tame(draw: &mut Draw) -> Result<Case, Error> {
    let h = draw.log_between(0.1, 10.0);
    let mu_t = draw.between(0.0, 3.0) / h;
    let g = draw.between(0.0, 0.9);
    let length = draw.log_between(0.5, 20.0);
    let foot = length * draw.between(-0.5, 1.5);
    let normal = (draw.below(2) == 0).then(|| draw.direction());
    along_x(length, (foot, h), normal, Medium::new(0.0, mu_t, g)?)
}

fn canonical(draw: &mut Draw, g: f32, with_normal: bool) -> Result<Case, Error> {
    const HALF_SIDE: f32 = 2.0;
    let camera = 6.0 * draw.direction();
    let mut coordinate = || draw.between(-HALF_SIDE, HALF_SIDE);
    let direction = (Vec3::new(coordinate(), coordinate(), coordinate()) - camera).normalize();
    let faces = [-HALF_SIDE, HALF_SIDE].map(|face| (Vec3::splat(face) - camera) / direction);
    let (t_min, t_max) = (faces[0].min(faces[1]).max_element(), faces[0].max(faces[1]).min_element());
    let ray = Ray::new(camera, direction, t_min, t_max)?;
    let normal = with_normal.then(|| draw.direction());
    Ok(Case::new(&ray, &emitter(Vec3::ZERO, normal)?, &Medium::new(0.5, 0.2, g)?))
}

/// A normal whose emitter is dark at `t'` \[m\] and on one side of it.
fn dark_at(t_prime: f32, h: f32, draw: &mut Draw) -> Vec3 {
    draw.pick(&[-1.0, 1.0]) * Vec3::new(h, t_prime, 0.0).normalize()
}

/// A ray from the origin along x, with the emitter `h` \[m\] beside it at `foot` \[m\].
pub(crate) fn along_x(length: f32, (foot, h): (f32, f32), normal: Option<Vec3>, medium: Medium) -> Result<Case, Error> {
    let ray = Ray::new(Vec3::ZERO, Vec3::X, 0.0, length)?;
    Ok(Case::new(&ray, &emitter(Vec3::new(foot, h, 0.0), normal)?, &medium))
}

fn emitter(position: Vec3, normal: Option<Vec3>) -> Result<Emitter, Error> {
    normal.map_or_else(|| Emitter::point(position), |n| Emitter::point_normal(position, n))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_are_found_again() {
        let names = ["broad", "generic", "dense", "tame", "spot", "colour", "colour-strong", "canonical"];
        for set in names.iter().flat_map(|name| Set::named(name).unwrap()) {
            assert_eq!(Set::named(set.name()), Some(vec![set]));
        }
        assert_eq!(Set::named("narrow"), None);
    }

    #[test]
    fn the_sets_are_what_they_say() {
        for scene in Set::Broad.scenes(1, 1000) {
            assert!((0.99e-4..1.01e2).contains(&scene.h()) && (0.99e-4..1.01e2).contains(&(scene.mu_t() * scene.h())));
        }
        for scene in Set::Tame.scenes(1, 1000) {
            assert!(scene.mu_t() * scene.h() <= 3.0001 && scene.interval().1 <= 20.001);
        }
        for (case, _) in Set::Spot.cases(1, 1000) {
            let cone = case.parts().unwrap().1.cone().unwrap();
            assert!((0.4999..0.9994).contains(&cone.cos_outer()), "{cone:?}");
        }
        for scene in Set::named("canonical").unwrap().into_iter().flat_map(|set| set.scenes(1, 250)) {
            let (t_min, t_max) = scene.interval();
            // no chord of the box is longer than its diagonal, no point of it farther from the middle than a corner
            assert!(t_max - t_min <= 48f64.sqrt() + 1e-5);
            assert!(scene.r(t_min).max(scene.r(t_max)) <= 12f64.sqrt() + 1e-5);
        }
    }

    #[test]
    fn an_emitter_is_dark_at_its_horizon() {
        let normal = dark_at(3.0, 0.5, &mut Draw::new(0, 0, 0));
        let scene = along_x(9.0, (2.0, 0.5), Some(normal), Medium::new(0.0, 1.0, 0.0).unwrap());
        let scene = scene.and_then(|case| case.scene()).unwrap();
        assert!(scene.cosine(5.0) < 1e-6);
        assert!((scene.cosine(4.9) > 0.0) != (scene.cosine(5.1) > 0.0));
    }
}
