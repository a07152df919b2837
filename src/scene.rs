//! One ray, one emitter, one medium: what a single-scattering integral is made of.

use crate::Error;
use glam::Vec3;

/// Largest coordinate or distance that is resolved \[m\]. A finite or infinite `t_max` beyond it means this distance.
pub const FARTHEST: f32 = 1e18;

/// How far from 1 the length of a direction or a normal may be.
pub const UNIT_TOLERANCE: f32 = 1e-3;

/// The part `[t_min, t_max]` of the ray `x(t) = origin + t direction` that lies in the medium.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Ray {
    origin: [f32; 3],
    direction: [f32; 3],
    t_min: f32,
    t_max: f32,
}

impl Ray {
    /// A ray from `origin` \[m\] along `direction`, in the medium from `t_min` to `t_max` \[m\].
    ///
    /// `t_max` may be infinite. `t_min = t_max` is an empty ray: it has no sample.
    ///
    /// # Errors
    /// [`Error::Value`] unless the coordinates of `origin` are at most [`FARTHEST`] in size, `direction` has length 1
    /// within [`UNIT_TOLERANCE`] (its exact length does not matter: distances are in metres all the same) and
    /// `0 <= t_min <= t_max`, `t_min <= FARTHEST`.
    pub fn new(
        origin: impl Into<[f32; 3]>,
        direction: impl Into<[f32; 3]>,
        t_min: f32,
        t_max: f32,
    ) -> Result<Self, Error> {
        let (origin, direction) = (origin.into(), direction.into());
        check_position("origin", origin)?;
        check_unit("direction", direction)?;
        Error::unless((0.0..=FARTHEST).contains(&t_min), "t_min", t_min, "0 <= t_min <= 1e18")?;
        Error::unless(t_min <= t_max, "t_max", t_max, "t_min <= t_max")?;
        Ok(Self { origin, direction, t_min, t_max })
    }

    /// Where the ray starts \[m\].
    #[must_use]
    pub fn origin(&self) -> [f32; 3] {
        self.origin
    }
    /// Where it goes, of unit length.
    #[must_use]
    pub fn direction(&self) -> [f32; 3] {
        self.direction
    }
    /// Where it enters the medium \[m\].
    #[must_use]
    pub fn t_min(&self) -> f32 {
        self.t_min
    }
    /// Where it leaves the medium \[m\].
    #[must_use]
    pub fn t_max(&self) -> f32 {
        self.t_max
    }
}

/// A point that lights the medium, with a normal (a point-normal emitter: a spot on a surface) or without one.
///
/// With a normal the emitted radiant intensity is proportional to the cosine `N = max(0, normal.(x - position)/r)`;
/// without one `N = 1`. Radiance, area and power are factors of the caller.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Emitter {
    position: [f32; 3],
    normal: Option<[f32; 3]>,
}

impl Emitter {
    /// An emitter that shines alike in all directions.
    ///
    /// # Errors
    /// [`Error::Value`] if a coordinate is NaN or larger than [`FARTHEST`] in size.
    pub fn point(position: impl Into<[f32; 3]>) -> Result<Self, Error> {
        let position = position.into();
        check_position("position", position)?;
        Ok(Self { position, normal: None })
    }

    /// A point of a surface with the unit normal `normal`; it shines to the side of its normal alone. Within the
    /// tolerance its length scales the cosine, and with it the weights.
    ///
    /// # Errors
    /// [`Error::Value`] if a coordinate is NaN or larger than [`FARTHEST`] in size, or if the length of the normal is
    /// not 1 within [`UNIT_TOLERANCE`].
    pub fn point_normal(position: impl Into<[f32; 3]>, normal: impl Into<[f32; 3]>) -> Result<Self, Error> {
        let (position, normal) = (position.into(), normal.into());
        check_position("position", position)?;
        check_unit("normal", normal)?;
        Ok(Self { position, normal: Some(normal) })
    }

    /// Where it is \[m\].
    #[must_use]
    pub fn position(&self) -> [f32; 3] {
        self.position
    }
    /// Its unit normal, if it has one.
    #[must_use]
    pub fn normal(&self) -> Option<[f32; 3]> {
        self.normal
    }
}

/// A homogeneous medium with the Henyey-Greenstein phase function.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Medium {
    mu_a: f32,
    mu_s: f32,
    g: f32,
}

impl Medium {
    /// Absorption coefficient `mu_a` and scattering coefficient `mu_s` \[1/m\], mean cosine `g` \[1\].
    ///
    /// `g > 0` scatters forward: light from an emitter behind the air reaches the eye.
    ///
    /// # Errors
    /// [`Error::Value`] unless `mu_a` and `mu_s` are finite and not negative, their sum is finite, and `-1 <= g <= 1`.
    #[doc(alias = "sigma_a")]
    #[doc(alias = "sigma_s")]
    pub fn new(mu_a: f32, mu_s: f32, g: f32) -> Result<Self, Error> {
        const EXTENT: &str = "a finite value >= 0";
        Error::unless((0.0..=f32::MAX).contains(&mu_a), "mu_a", mu_a, EXTENT)?;
        Error::unless((0.0..=f32::MAX).contains(&mu_s), "mu_s", mu_s, EXTENT)?;
        Error::unless((mu_a + mu_s).is_finite(), "mu_t", mu_a + mu_s, EXTENT)?;
        Error::unless((-1.0..=1.0).contains(&g), "g", g, "-1 <= g <= 1")?;
        Ok(Self { mu_a, mu_s, g })
    }

    /// Absorption coefficient \[1/m\].
    #[must_use]
    #[doc(alias = "sigma_a")]
    pub fn mu_a(&self) -> f32 {
        self.mu_a
    }
    /// Scattering coefficient \[1/m\].
    #[must_use]
    #[doc(alias = "sigma_s")]
    pub fn mu_s(&self) -> f32 {
        self.mu_s
    }
    /// Extinction coefficient `mu_a + mu_s` \[1/m\].
    #[must_use]
    #[doc(alias = "sigma_t")]
    pub fn mu_t(&self) -> f32 {
        self.mu_a + self.mu_s
    }
    /// Mean cosine of the scattering angle \[1\].
    #[must_use]
    pub fn g(&self) -> f32 {
        self.g
    }
}

fn check_position(field: &'static str, p: [f32; 3]) -> Result<(), Error> {
    for c in p {
        Error::unless(c.abs() <= FARTHEST, field, c, "coordinates of at most 1e18 in size")?;
    }
    Ok(())
}

fn check_unit(field: &'static str, v: [f32; 3]) -> Result<(), Error> {
    let length = Vec3::from(v).length();
    Error::unless((length - 1.0).abs() <= UNIT_TOLERANCE, field, length, "length 1 within 1e-3")
}
