//! One ray, one emitter, one medium: what a single-scattering integral is made of.

mod colour;
mod cone;

pub use cone::Cone;

use crate::Error;
pub(crate) use colour::{Colour, MOST_CHANNELS};
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

/// A point that lights the medium: alike in all directions, as a piece of a surface with a normal (a point-normal emitter),
/// or into a cone (a spot).
///
/// With a normal the emitted radiant intensity is proportional to the cosine `N = max(0, normal.(x - position)/r)`;
/// without one `N = 1`. That of a spot is proportional to the falloff of its [`Cone`]. Radiance, area and power are factors
/// of the caller.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Emitter {
    position: [f32; 3],
    normal: Option<[f32; 3]>,
    cone: Option<Cone>,
}

impl Emitter {
    /// An emitter that shines alike in all directions.
    ///
    /// # Errors
    /// [`Error::Value`] if a coordinate is NaN or larger than [`FARTHEST`] in size.
    pub fn point(position: impl Into<[f32; 3]>) -> Result<Self, Error> {
        let position = position.into();
        check_position("position", position)?;
        Ok(Self { position, normal: None, cone: None })
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
        Ok(Self { position, normal: Some(normal), cone: None })
    }

    /// A point that shines into the [`Cone`] around the unit vector `axis`, in full up to the angle whose cosine is
    /// `cos_inner`, not at all beyond that of `cos_outer`, and smoothly in between. [There](Cone) stands how the spots of
    /// Blender, glTF and pbrt are given this way.
    ///
    /// What is outside the outer cone is dark: `Strategy::Transmittance` samples the whole ray, every other density the part
    /// inside. The falloff between the cones is in weights, [`evaluate`](crate::Sampler::evaluate) and
    /// [`radiance`](crate::Integral::radiance), and the product densities follow it; the others do not.
    ///
    /// # Errors
    /// [`Error::Value`] if a coordinate is NaN or larger than [`FARTHEST`] in size, if the length of the axis is not 1
    /// within [`UNIT_TOLERANCE`] (its exact length does not matter), or unless `0 <= cos_outer <= cos_inner <= 1`.
    pub fn spot(
        position: impl Into<[f32; 3]>,
        axis: impl Into<[f32; 3]>,
        cos_outer: f32,
        cos_inner: f32,
    ) -> Result<Self, Error> {
        let position = position.into();
        check_position("position", position)?;
        Ok(Self { position, normal: None, cone: Some(Cone::new(axis.into(), cos_outer, cos_inner)?) })
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
    /// Its cone, if it is a spot.
    #[must_use]
    pub fn cone(&self) -> Option<Cone> {
        self.cone
    }
}

/// A homogeneous medium with the Henyey-Greenstein phase function: grey, or with coefficients of its own for each channel of
/// a colour.
///
/// `mu_a`, `mu_s` and `mu_t` of a coloured medium are those of the grey one that its densities are made for: the means over
/// the channels that scatter. So a channel that does not scatter changes nothing for the others. If none scatters they are
/// the means over all.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Medium {
    mu_a: f32,
    mu_s: f32,
    g: f32,
    colour: Option<Colour>,
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
        Ok(Self { mu_a, mu_s, g, colour: None })
    }

    /// A medium of 1, 3 or 4 channels, with `mu_a` and `mu_s` \[1/m\] of each and one mean cosine `g` \[1\]. Of one channel
    /// it is that of [`new`](Self::new).
    ///
    /// All channels share the distances of the samples. The densities [`Product5`](crate::Strategy::Product5) and
    /// [`Product9`](crate::Strategy::Product9) are the means of those that the channels that scatter have, so that each of them is
    /// sampled well; the other densities are those of the mean medium. Weights, integrands and radiances are per channel.
    ///
    /// # Errors
    /// [`Error::Value`] if there are not 1, 3 or 4 channels, or where `new` has it, for any channel; also unless the means
    /// of `mu_a` and `mu_s` have a finite sum.
    pub fn coloured<const C: usize>(mu_a: [f32; C], mu_s: [f32; C], g: f32) -> Result<Self, Error> {
        Error::unless(matches!(C, 1 | 3 | 4), "channels", C as f32, "1, 3 or 4")?;
        for (mu_a, mu_s) in mu_a.into_iter().zip(mu_s) {
            Self::new(mu_a, mu_s, g)?;
        }
        let colour = Colour::new(&mu_a, &mu_s);
        let (mean_a, mean_s) = colour.mean();
        let grey = Self::new(mean_a, mean_s, g)?;
        Ok(Self { colour: (C > 1).then_some(colour), ..grey })
    }

    /// `mu_a` and `mu_s` of all channels, of a grey medium the same in each.
    pub(crate) fn coefficients(&self) -> ([f32; MOST_CHANNELS], [f32; MOST_CHANNELS]) {
        self.colour.map_or(([self.mu_a; MOST_CHANNELS], [self.mu_s; MOST_CHANNELS]), |colour| colour.coefficients())
    }

    /// How many channels it has; 1 if it is grey.
    #[must_use]
    pub fn channels(&self) -> usize {
        self.colour.map_or(1, |colour| colour.count())
    }
    /// The grey medium of channel `c`, if there is one: itself for `c = 0` if it is grey.
    #[must_use]
    pub fn channel(&self, c: usize) -> Option<Self> {
        match &self.colour {
            None => (c == 0).then_some(*self),
            Some(colour) => colour.channel(c).map(|(mu_a, mu_s)| Self { mu_a, mu_s, g: self.g, colour: None }),
        }
    }
    /// The grey medium whose coefficients are the means over the channels that scatter; itself if it is grey.
    #[must_use]
    pub fn mean(&self) -> Self {
        Self { colour: None, ..*self }
    }

    /// Absorption coefficient \[1/m\]; of a coloured medium the mean.
    #[must_use]
    #[doc(alias = "sigma_a")]
    pub fn mu_a(&self) -> f32 {
        self.mu_a
    }
    /// Scattering coefficient \[1/m\]; of a coloured medium the mean.
    #[must_use]
    #[doc(alias = "sigma_s")]
    pub fn mu_s(&self) -> f32 {
        self.mu_s
    }
    /// Extinction coefficient `mu_a + mu_s` \[1/m\]; of a coloured medium the sum of the means.
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
