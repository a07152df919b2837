//! Families of inputs that are known to break renderers, and a generic one.

use crate::draw::{Draw, EPS};
use airlight::oracle::{Coloured, Scene};
use airlight::{Counts, Emitter, Emitters, Error, FARTHEST, Integral, Media, Medium, Ray, Rays};
use glam::{DVec3, Vec3};
use std::fmt;
use std::str::FromStr;

/// A family of rays, named for what is hard about them.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Family {
    /// Rays in a box of side 10 around the emitter, any normal, `mu_t = 0.7`, `g` 0 or 0.9.
    Generic,
    /// The same with `u` at and next to 0 and 1.
    Variate,
    /// The emitter on the ray or next to it, also at its ends.
    NearEmitter,
    /// The emitter 100 to 1e6 m away from a segment of 1 to 10 m.
    FarAway,
    /// `t_max` from 1e4 m to infinity.
    InfiniteRays,
    /// Subtended angles from 1e-9 rad, single-ulp and empty intervals.
    ShortIntervals,
    /// Normals along and across the ray, ends at and next to the dark side, emitters that show their back.
    Cosine,
    /// `g` from -1 to 1, ends included.
    Phase,
    /// `mu_t` from 0 to 1e4 per m, and invalid media.
    Medium,
    /// Directions and normals that are not quite units, signed zeros, origins far out, fields that are not numbers.
    Ray,
    /// Every field an arbitrary bit pattern.
    RandomBits,
    /// `1 - |g|` from 2^-24 to 1e-3, and the emitter on the ray or next to it.
    Peaks,
    /// Spots: cones of 0 to 90 degrees and of a tenth of a degree, edges hard and soft; apex on the ray or next to it, axes along
    /// the ray, rays along the side of the cone, and invalid cosines.
    Spot,
    /// Three channels whose `mu_t` differ up to a hundredfold, equal ones and ones that do not scatter among them, and
    /// invalid coefficients; in a box, next to the emitter, and on infinite rays.
    Colour,
}

impl Family {
    /// All of them.
    pub const ALL: [Self; 14] = [
        Self::Generic,
        Self::Variate,
        Self::NearEmitter,
        Self::FarAway,
        Self::InfiniteRays,
        Self::ShortIntervals,
        Self::Cosine,
        Self::Phase,
        Self::Medium,
        Self::Ray,
        Self::RandomBits,
        Self::Peaks,
        Self::Spot,
        Self::Colour,
    ];

    /// Its name on the command line and in JSON.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Generic => "generic",
            Self::Variate => "variate",
            Self::NearEmitter => "near-emitter",
            Self::FarAway => "far-away",
            Self::InfiniteRays => "infinite-rays",
            Self::ShortIntervals => "short-intervals",
            Self::Cosine => "cosine",
            Self::Phase => "phase",
            Self::Medium => "medium",
            Self::Ray => "ray",
            Self::RandomBits => "random-bits",
            Self::Peaks => "peaks",
            Self::Spot => "spot",
            Self::Colour => "colour",
        }
    }

    /// Case number `index` of the family under a seed.
    #[must_use]
    pub fn case(self, seed: u64, index: u64) -> Case {
        let mut draw = Draw::new(seed, self as u64, index);
        match self {
            Self::Generic => Case::generic(&mut draw),
            Self::Variate => Case { u: draw.pick(&[0.0, EPS, 1.0 - EPS, 1.0, 1e-30]), ..Case::generic(&mut draw) },
            Self::NearEmitter => Case::near_emitter(&mut draw),
            Self::FarAway => Case::far_away(&mut draw),
            Self::InfiniteRays => Case::infinite(&mut draw),
            Self::ShortIntervals => Case::short(&mut draw),
            Self::Cosine => Case::cosine(&mut draw),
            Self::Phase => {
                let g = draw.pick(&[0.0, 1e-8, -1e-8, 0.6, -0.6, 0.9, -0.9, 0.99, -0.99, 0.999, -0.999, 1.0, -1.0]);
                Case { g, ..Case::generic(&mut draw) }
            }
            Self::Medium => Case::medium(&mut draw),
            Self::Ray => Case::ray(&mut draw),
            Self::RandomBits => Case::random_bits(&mut draw),
            Self::Peaks => {
                let g = draw.pick(&[1.0, -1.0]) * (1.0 - draw.log_between(EPS, 1e-3));
                Case { g, ..Case::near_emitter(&mut draw) }
            }
            Self::Spot => Case::spot(&mut draw),
            Self::Colour => Case::colour(&mut draw),
        }
    }
}

/// The error of parsing a [`Family`]: the text names none.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct UnknownFamily(String);

impl fmt::Display for UnknownFamily {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "no family is called '{}'; there are {}", self.0, Family::ALL.map(Family::name).join(", "))
    }
}

impl std::error::Error for UnknownFamily {}

impl FromStr for Family {
    type Err = UnknownFamily;
    fn from_str(name: &str) -> Result<Self, UnknownFamily> {
        Self::ALL.into_iter().find(|family| family.name() == name).ok_or_else(|| UnknownFamily(name.to_owned()))
    }
}

/// One ray with its emitter, medium and variate, unvalidated as in columns.
#[derive(Clone, Copy, Debug)]
pub struct Case {
    origin: Vec3,
    direction: Vec3,
    t_min: f32,
    t_max: f32,
    position: Vec3,
    /// (0, 0, 0) for a point emitter; the axis of a spot.
    normal: Vec3,
    /// -1 without a cone.
    cos_outer: f32,
    cos_inner: f32,
    /// In a coloured medium, those of the channel under test.
    mu_a: f32,
    mu_s: f32,
    g: f32,
    colour: Option<Colour>,
    /// The variate.
    pub u: f32,
}

/// How many channels coloured media of cases have.
pub const CHANNELS: usize = 3;

/// The coefficients of all channels, and the one under test.
#[derive(Clone, Copy, Debug)]
struct Colour {
    mu_a: [f32; CHANNELS],
    mu_s: [f32; CHANNELS],
    channel: usize,
}

impl Case {
    /// A ray with its emitter and medium.
    #[must_use]
    pub(crate) fn new(ray: &Ray, emitter: &Emitter, medium: &Medium) -> Self {
        Self {
            origin: ray.origin().into(),
            direction: ray.direction().into(),
            t_min: ray.t_min(),
            t_max: ray.t_max(),
            position: emitter.position().into(),
            normal: emitter.normal().or(emitter.cone().map(|cone| cone.axis())).unwrap_or_default().into(),
            cos_outer: emitter.cone().map_or(NO_CONE, |cone| cone.cos_outer()),
            cos_inner: emitter.cone().map_or(NO_CONE, |cone| cone.cos_inner()),
            mu_a: medium.mu_a(),
            mu_s: medium.mu_s(),
            g: medium.g(),
            colour: None,
            u: 0.5,
        }
    }

    /// The ray, the emitter and the medium, if they are valid; in a coloured medium the channel under test.
    ///
    /// # Errors
    /// Whatever the constructors find.
    pub fn parts(&self) -> Result<(Ray, Emitter, Medium), Error> {
        let ray = Ray::new(self.origin, self.direction, self.t_min, self.t_max)?;
        let emitter = emitter(self.position, self.normal, [self.cos_outer, self.cos_inner])?;
        let medium = self.whole_medium()?;
        Ok((ray, emitter, medium.channel(self.channel()).unwrap_or(medium)))
    }

    /// The medium with all its channels.
    ///
    /// # Errors
    /// As its constructor.
    pub fn whole_medium(&self) -> Result<Medium, Error> {
        match self.colour {
            Some(Colour { mu_a, mu_s, .. }) => Medium::coloured(mu_a, mu_s, self.g),
            None => Medium::new(self.mu_a, self.mu_s, self.g),
        }
    }

    /// The channel under test; 0 in a grey medium.
    #[must_use]
    pub fn channel(&self) -> usize {
        self.colour.map_or(0, |colour| colour.channel)
    }

    /// The scene of the oracle with all channels, if the case is a valid one.
    ///
    /// # Errors
    /// As [`parts`](Self::parts).
    pub fn coloured(&self) -> Result<Coloured, Error> {
        let (ray, emitter, _) = self.parts()?;
        Ok(Coloured::new(&ray, &emitter, &self.whole_medium()?))
    }

    /// The same in a coloured medium.
    #[must_use]
    pub(crate) fn with_channels(self, mu_a: [f32; CHANNELS], mu_s: [f32; CHANNELS], channel: usize) -> Self {
        Self { mu_a: mu_a[channel], mu_s: mu_s[channel], colour: Some(Colour { mu_a, mu_s, channel }), ..self }
    }

    fn is_spot(&self) -> bool {
        (self.cos_outer, self.cos_inner) != (NO_CONE, NO_CONE)
    }

    /// The scene of the oracle, if the case is a valid one; in a coloured medium that of the channel under test.
    ///
    /// # Errors
    /// As [`parts`](Self::parts).
    pub fn scene(&self) -> Result<Scene, Error> {
        let (ray, emitter, medium) = self.parts()?;
        Ok(Scene::new(&ray, &emitter, &medium))
    }

    /// Whether a coordinate is beyond what is promised to be told from invalid, `mu_s` so small that its products leave f32,
    /// or `mu_t` the inverse of no length that is resolved.
    #[must_use]
    pub fn is_extreme(&self) -> bool {
        let farthest = self.origin.abs().max_element().max(self.position.abs().max_element());
        farthest > FARTHEST || (self.mu_s > 0.0 && self.mu_s < 1e-30) || self.mu_a + self.mu_s > FARTHEST
    }

    /// The same in another medium.
    #[must_use]
    pub(crate) fn within(self, medium: &Medium) -> Self {
        Self { mu_a: medium.mu_a(), mu_s: medium.mu_s(), g: medium.g(), ..self }
    }

    /// A case of the generic box.
    pub(crate) fn generic(draw: &mut Draw) -> Self {
        let normal = if draw.below(8) == 0 { Vec3::ZERO } else { draw.direction() };
        Self {
            origin: Vec3::from_array([0; 3].map(|_| draw.between(-5.0, 5.0))),
            direction: draw.direction(),
            t_min: 0.0,
            t_max: draw.between(1.0, 20.0),
            position: Vec3::ZERO,
            normal,
            cos_outer: NO_CONE,
            cos_inner: NO_CONE,
            mu_a: 0.5,
            mu_s: 0.2,
            g: draw.pick(&[0.0, 0.9]),
            colour: None,
            u: draw.uniform(),
        }
    }

    /// A generic medium and variate.
    fn any(draw: &mut Draw) -> Self {
        let mu_t = draw.log_between(1e-2, 1e1);
        let mu_s = mu_t * draw.uniform();
        Self { mu_a: mu_t - mu_s, mu_s, g: draw.between(-0.95, 0.95), ..Self::generic(draw) }
    }

    /// The emitter at distance `h` from the ray's line and `t_h` along it: exactly so along an axis, else rounded.
    fn placed(self, draw: &mut Draw, h: f32, t_h: f32) -> Self {
        if draw.below(2) == 0 {
            let axis = draw.below(3) as usize;
            let unit = |k: usize| Vec3::AXES[k % 3];
            let sign = draw.pick(&[1.0, -1.0]);
            let direction = unit(axis) * sign;
            Self { origin: unit(axis + 1) * h - direction * t_h, direction, position: Vec3::ZERO, ..self }
        } else {
            let direction = draw.direction();
            let across = direction.as_dvec3().cross(draw.direction().as_dvec3()).normalize_or(DVec3::X);
            let to = direction.as_dvec3() * f64::from(t_h) + across * f64::from(h);
            let origin = if draw.below(2) == 0 { Vec3::ZERO } else { draw.direction() * draw.between(0.0, 3.0) };
            Self { origin, direction, position: (origin.as_dvec3() + to).as_vec3(), ..self }
        }
    }

    fn near_emitter(draw: &mut Draw) -> Self {
        let length = draw.log_between(0.1, 100.0);
        let t_min = draw.pick(&[0.0, 0.0, 1.0]) * length;
        let t_max = t_min + length;
        let h = match draw.below(8) {
            0 => 0.0,
            1 => 1e-40,
            _ => length * draw.log_between(1e-7, 0.1),
        };
        let t_h = match draw.below(6) {
            0 => t_min,
            1 => t_max,
            2 => t_min + length * draw.between(-0.5, 1.5),
            _ => t_min + length * draw.uniform(),
        };
        Self { t_min, t_max, ..Self::any(draw) }.placed(draw, h, t_h)
    }

    fn far_away(draw: &mut Draw) -> Self {
        let away = draw.log_between(1e2, 1e6) * draw.pick(&[1.0, -1.0]);
        let h = draw.log_between(1e-3, 1e4);
        let t_min = draw.pick(&[0.0, 0.0, 2.0]);
        let t_max = t_min + draw.between(1.0, 10.0);
        let mu_t = draw.log_between(1e-8, 1e-1);
        Self { t_min, t_max, mu_a: 0.5 * mu_t, mu_s: 0.5 * mu_t, ..Self::any(draw) }.placed(draw, h, away)
    }

    fn infinite(draw: &mut Draw) -> Self {
        let h = draw.log_between(1e-3, 1e2);
        let t_h = draw.log_between(1e-2, 1e3) * draw.pick(&[1.0, 0.0, -1.0]);
        let t_max = draw.pick(&[1e4, 1e8, f32::MAX, f32::INFINITY]);
        Self { t_max, ..Self::any(draw) }.placed(draw, h, t_h)
    }

    fn short(draw: &mut Draw) -> Self {
        let h = draw.log_between(1e-2, 1e1);
        let t_h = draw.between(-10.0, 10.0);
        let t_min = if draw.below(4) == 0 { draw.between(5e5, 2e6) } else { draw.between(0.0, 10.0) };
        let angle = draw.log_between(1e-9, 1e-5);
        let from = t_min - t_h;
        let t_max = match draw.below(8) {
            0 => t_min,
            1 => t_min.next_down(),
            2 | 3 => t_min.next_up(),
            _ => t_min + angle * (h * h + from * from) / h,
        };
        // Short intervals next to the origin are shorter still in metres.
        let t_min = if draw.below(4) == 0 { 0.0 } else { t_min };
        let t_max = if t_min == 0.0 { angle * (h * h + t_h * t_h) / h } else { t_max };
        Self { t_min, t_max, ..Self::any(draw) }.placed(draw, h, t_h)
    }

    fn cosine(draw: &mut Draw) -> Self {
        // Along an axis, so that n.d and the distance to the dark side are exact.
        let (h, t_h) = (draw.log_between(1e-2, 1e1), draw.between(-10.0, 10.0));
        let length = draw.log_between(0.1, 100.0);
        let mut case = Self { t_max: length, ..Self::any(draw) }.placed(draw, h, t_h);
        let d = case.direction;
        let across = (case.origin + d * t_h - case.position).normalize_or(Vec3::X);
        let along = d * draw.pick(&[1.0, -1.0]);
        match draw.below(8) {
            0 => case.normal = across + d * draw.pick(&[0.0, -0.0, 1e-8, -1e-8]),
            1 => case.normal = -across + d * draw.pick(&[0.0, 1e-8, -1e-8]),
            2 => case.normal = along,
            // N = 0 near an end: the normal is square to the line from the emitter to it.
            3..=5 => {
                let t = draw.pick(&[0.0, f32::from_bits(1), EPS, 1.0 - EPS, 1.0, 1.0 + 2.0 * EPS, 0.5]) * length;
                let to = (case.origin + d * t - case.position).normalize_or(d);
                let side = draw.pick(&[1.0, -1.0]);
                case.normal = ((d - to * to.dot(d)) * side).normalize_or(along);
            }
            6 => case.normal = Vec3::ZERO,
            _ => {}
        }
        case
    }

    fn medium(draw: &mut Draw) -> Self {
        let mu_t = match draw.below(12) {
            0 => 0.0,
            1 => 1e-30,
            2 => draw.pick(&[f32::INFINITY, -1.0, f32::NAN]),
            _ => draw.log_between(1e-6, 1e4),
        };
        let mu_s = mu_t * draw.pick(&[0.0, 0.5, 1.0]);
        let t_max = if draw.below(4) == 0 { f32::INFINITY } else { draw.between(1.0, 20.0) };
        let mu_a = if mu_t.is_finite() { mu_t - mu_s } else { mu_t };
        Self { mu_a, mu_s, t_max, ..Self::generic(draw) }
    }

    fn ray(draw: &mut Draw) -> Self {
        let mut case = Self::any(draw);
        match draw.below(5) {
            0 => {
                case.direction *= draw.between(0.9991, 1.0009);
                case.normal *= draw.between(0.9991, 1.0009);
            }
            1 => {
                let sign = draw.pick(&[1.0, -1.0]);
                case.direction = Vec3::AXES[draw.below(3) as usize] * Vec3::new(sign, -sign, sign);
            }
            2 => {
                let out = draw.direction() * 1e6;
                case.origin += out;
                case.position += out;
            }
            3 => {
                let bad = draw.pick(&[f32::NAN, f32::INFINITY, f32::NEG_INFINITY]);
                let k = draw.below(3) as usize;
                match draw.below(7) {
                    0 => case.origin[k] = bad,
                    1 => case.direction[k] = bad,
                    2 => case.position[k] = bad,
                    3 => case.normal[k] = bad,
                    4 => case.t_min = bad,
                    5 => case.t_max = f32::NAN,
                    _ => case.u = bad,
                }
            }
            _ => case.direction *= draw.pick(&[0.0, 0.9, 1.1, f32::MAX]),
        }
        case
    }

    fn random_bits(draw: &mut Draw) -> Self {
        let case = Self::any(draw);
        // Every field a bit pattern, or half of them: else hardly a direction would be one.
        let all = draw.below(4) == 0;
        let mut any = |value: f32| if all || draw.below(2) == 0 { f32::from_bits(draw.next() as u32) } else { value };
        let mut vector = |v: Vec3| Vec3::new(any(v.x), any(v.y), any(v.z));
        let (origin, position) = (vector(case.origin), vector(case.position));
        let (direction, normal) = (case.direction, case.normal);
        let wild = draw.below(8) == 0;
        let mut any = |value: f32| if all || draw.below(2) == 0 { f32::from_bits(draw.next() as u32) } else { value };
        let mut vector = |v: Vec3| if all || wild { Vec3::new(any(v.x), any(v.y), any(v.z)) } else { v };
        let (direction, normal) = (vector(direction), vector(normal));
        let mut positive = |value: f32| any(value).abs();
        let (t_min, t_max) = (positive(case.t_min), positive(case.t_max));
        let (mu_a, mu_s) = (positive(case.mu_a), positive(case.mu_s));
        let (g, u) = (any(case.g), any(case.u));
        Self { origin, direction, t_min, t_max, position, normal, mu_a, mu_s, g, u, ..case }
    }

    /// The spot of a cone with this cosine, with an edge from hard to as soft as can be.
    pub(crate) fn with_cone(self, draw: &mut Draw, axis: Vec3, cos_outer: f32) -> Self {
        let share = [0.0, 0.3, 1.0, draw.uniform()][draw.below(4) as usize];
        Self { normal: axis, cos_outer, cos_inner: (cos_outer + (1.0 - cos_outer) * share).min(1.0), ..self }
    }

    fn spot(draw: &mut Draw) -> Self {
        let kind = draw.below(4);
        let case = match kind {
            0 => Self::near_emitter(draw),
            1 => Self::infinite(draw),
            _ => Self::any(draw),
        };
        let half_angle = match draw.below(8) {
            0 => 0.1,
            1 => 90.0,
            2 => draw.pick(&[0.0, 0.1, 89.9]),
            _ => draw.log_between(0.1, 90.0),
        };
        let outer = if half_angle == 90.0 { 0.0 } else { f64::from(half_angle).to_radians().cos() as f32 };
        let d = case.direction;
        let t = case.t_min + (case.t_max.min(100.0) - case.t_min) * draw.uniform();
        let towards = (case.origin + d * t - case.position).normalize_or(d);
        let across = d.cross(draw.direction()).normalize_or(Vec3::X);
        let sine = (1.0 - outer * outer).max(0.0).sqrt();
        let axis = match draw.below(8) {
            0 => draw.direction(),
            1 => d * draw.pick(&[1.0, -1.0]),
            // Along the side of the cone, which an infinite ray would meet where no light is left.
            2 if kind != 1 => d * outer + across * sine,
            // The edge next to an end of the ray or at any other place of it.
            3 => towards * outer + towards.cross(draw.direction()).normalize_or(across) * sine,
            _ => towards + draw.direction() * (sine * draw.uniform()),
        };
        let mut case = case.with_cone(draw, axis.normalize_or(d), outer);
        match draw.below(32) {
            0 => case.cos_outer = draw.pick(&[f32::NAN, -0.5, 1.5, f32::INFINITY]),
            1 => case.cos_inner = draw.pick(&[f32::NAN, -1.0, 1.5, f32::NEG_INFINITY]),
            2 => case.normal *= draw.pick(&[0.0, 0.9995, 1.0005, 1.1]),
            _ => {}
        }
        case
    }

    fn colour(draw: &mut Draw) -> Self {
        let case = match draw.below(4) {
            0 => Self::near_emitter(draw),
            1 => Self::infinite(draw),
            _ => Self::any(draw),
        };
        let equal = draw.below(8) == 0;
        let mut mu_a = [case.mu_a; CHANNELS];
        let mut mu_s = [case.mu_s; CHANNELS];
        for c in if equal { 0..0 } else { 0..CHANNELS } {
            let mu_t = (case.mu_a + case.mu_s) * draw.log_between(0.1, 10.0);
            mu_s[c] = mu_t * if draw.below(8) == 0 { 0.0 } else { draw.uniform() };
            mu_a[c] = mu_t - mu_s[c];
        }
        let (bad, c) = (draw.pick(&[-0.1, f32::NAN, f32::INFINITY]), draw.below(CHANNELS as u64) as usize);
        match draw.below(64) {
            0 => mu_a[c] = bad,
            1 => mu_s[c] = bad,
            _ => {}
        }
        case.with_channels(mu_a, mu_s, draw.below(CHANNELS as u64) as usize)
    }
}

/// The cosine that stands for no cone.
pub const NO_CONE: f32 = -1.0;

/// What a row of columns describes: a spot, or without a cone an emitter with this normal, or with none.
///
/// # Errors
/// As the constructor of [`Emitter`].
pub fn emitter(position: Vec3, axis: Vec3, cosines: [f32; 2]) -> Result<Emitter, Error> {
    match cosines {
        [NO_CONE, NO_CONE] if axis == Vec3::ZERO => Emitter::point(position),
        [NO_CONE, NO_CONE] => Emitter::point_normal(position, axis),
        [outer, inner] => Emitter::spot(position, axis, outer, inner),
    }
}

/// Columns of many cases.
#[derive(Debug, Default)]
pub struct Columns {
    origin: [Vec<f32>; 3],
    direction: [Vec<f32>; 3],
    t_min: Vec<f32>,
    t_max: Vec<f32>,
    position: [Vec<f32>; 3],
    normal: [Vec<f32>; 3],
    /// `cos_outer` and `cos_inner`, if there are spots.
    cones: Option<[Vec<f32>; 2]>,
    mu_a: Vec<f32>,
    mu_s: Vec<f32>,
    g: Vec<f32>,
    /// `mu_a` and `mu_s` of all channels, if there are coloured media.
    channels: Option<[[Vec<f32>; CHANNELS]; 2]>,
    /// The variates.
    pub u: Vec<f32>,
}

impl Columns {
    /// The cases as columns.
    #[must_use]
    pub fn new(cases: &[Case]) -> Self {
        let column = |field: fn(&Case) -> f32| cases.iter().map(field).collect::<Vec<_>>();
        let columns = |field: fn(&Case) -> Vec3| [0, 1, 2].map(|k| cases.iter().map(|case| field(case)[k]).collect());
        Self {
            origin: columns(|case| case.origin),
            direction: columns(|case| case.direction),
            t_min: column(|case| case.t_min),
            t_max: column(|case| case.t_max),
            position: columns(|case| case.position),
            normal: columns(|case| case.normal),
            cones: cases
                .iter()
                .any(Case::is_spot)
                .then(|| [column(|case| case.cos_outer), column(|case| case.cos_inner)]),
            mu_a: column(|case| case.mu_a),
            mu_s: column(|case| case.mu_s),
            g: column(|case| case.g),
            channels: cases.iter().any(|case| case.colour.is_some()).then(|| of_channels(cases)),
            u: column(|case| case.u),
        }
    }

    /// The rays.
    #[must_use]
    pub fn rays(&self) -> Rays<'_> {
        let (origin, direction) = (self.origin.each_ref(), self.direction.each_ref());
        Rays::new(origin.map(Vec::as_slice), direction.map(Vec::as_slice), &self.t_min, &self.t_max)
    }

    /// Their emitters.
    #[must_use]
    pub fn emitters(&self) -> Emitters<'_> {
        match &self.cones {
            Some([outer, inner]) => Emitters::each_spot(self.position(), self.normal(), outer, inner),
            None => Emitters::each(self.position(), self.normal()),
        }
    }

    /// The positions of these.
    #[must_use]
    pub fn position(&self) -> [&[f32]; 3] {
        self.position.each_ref().map(Vec::as_slice)
    }

    /// Their normals, or axes.
    #[must_use]
    pub fn normal(&self) -> [&[f32]; 3] {
        self.normal.each_ref().map(Vec::as_slice)
    }

    /// The cosines of their cones, if there are spots.
    #[must_use]
    pub fn cones(&self) -> Option<[&[f32]; 2]> {
        self.cones.as_ref().map(|cones| cones.each_ref().map(Vec::as_slice))
    }

    /// Their media; of coloured ones the channels under test.
    #[must_use]
    pub fn media(&self) -> Media<'_> {
        let [mu_a, mu_s, g] = self.medium();
        Media::each(mu_a, mu_s, g)
    }

    /// Those with all their channels, if there are coloured ones.
    #[must_use]
    pub fn coloured_media(&self) -> Option<Media<'_>> {
        let [mu_a, mu_s] = self.channels.as_ref()?.each_ref().map(|columns| columns.each_ref().map(Vec::as_slice));
        Some(Media::each_coloured(mu_a, mu_s, &self.g))
    }

    /// Writes the radiances, in all channels of coloured media; of grey ones the first column alone.
    ///
    /// # Errors
    /// As [`Integral::radiance`].
    pub fn integrate(&self, integral: &Integral, radiances: &mut [Vec<f32>; CHANNELS]) -> Result<Counts, Error> {
        let (rays, emitters, columns) = (self.rays(), self.emitters(), radiances.each_mut().map(Vec::as_mut_slice));
        match self.coloured_media() {
            Some(media) => integral.radiance_coloured(&rays, &emitters, &media, columns),
            None => integral.radiance(&rays, &emitters, &self.media(), &mut radiances[0]),
        }
    }

    /// `mu_a`, `mu_s` and `g` of these.
    #[must_use]
    pub fn medium(&self) -> [&[f32]; 3] {
        [&self.mu_a, &self.mu_s, &self.g]
    }
}

/// `mu_a` and `mu_s` of all channels; those of a grey medium are equal.
fn of_channels(cases: &[Case]) -> [[Vec<f32>; CHANNELS]; 2] {
    let columns =
        |of: fn(&Case) -> [f32; CHANNELS]| std::array::from_fn(|c| cases.iter().map(|case| of(case)[c]).collect());
    [
        columns(|case| case.colour.map_or([case.mu_a; CHANNELS], |colour| colour.mu_a)),
        columns(|case| case.colour.map_or([case.mu_s; CHANNELS], |colour| colour.mu_s)),
    ]
}
