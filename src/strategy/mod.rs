//! The densities that can be sampled, one file each.

pub(crate) mod equi_angular;
pub(crate) mod point_normal;
pub(crate) mod product;
mod taylor;
pub(crate) mod taylor_phase;
pub(crate) mod taylor_transmittance;
pub(crate) mod transmittance;

pub(crate) use taylor::Taylor;

use std::fmt;
use std::str::FromStr;

/// Which density over distance is sampled.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub enum Strategy {
    /// Proportional to the transmittance along the ray, `exp(-mu_t t)`, on `[t_min, t_max]`.
    Transmittance,
    /// Proportional to `1/r^2`: uniform in the angle at the emitter.
    EquiAngular,
    /// Proportional to `N/r^2`.
    PointNormal,
    /// Proportional to `N/r^2` times the Taylor polynomial of the transmittance.
    TaylorTransmittance,
    /// Proportional to `N/r^2` times the Taylor polynomial of the phase function.
    TaylorPhase,
    /// Nearly proportional to the whole integrand, known at 3 points and followed by lines in a warped variable.
    Product3,
    /// The same with 5 points.
    Product5,
    /// The same with 9 points.
    Product9,
    /// The same with 17 points.
    Product17,
}

impl Strategy {
    /// All of them, from the simplest on.
    pub const ALL: &'static [Self] = &[
        Self::Transmittance,
        Self::EquiAngular,
        Self::PointNormal,
        Self::TaylorTransmittance,
        Self::TaylorPhase,
        Self::Product3,
        Self::Product5,
        Self::Product9,
        Self::Product17,
    ];

    /// Whether it is made of the whole integrand, so that [`Sampler::radiance`](crate::Sampler::radiance) can be asked.
    #[must_use]
    pub fn has_radiance(self) -> bool {
        matches!(self, Self::Product3 | Self::Product5 | Self::Product9 | Self::Product17)
    }

    /// Its name on the command line, in JSON and in prose.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Transmittance => "transmittance",
            Self::EquiAngular => "equi-angular",
            Self::PointNormal => "point-normal",
            Self::TaylorTransmittance => "taylor-transmittance",
            Self::TaylorPhase => "taylor-phase",
            Self::Product3 => "product-3",
            Self::Product5 => "product-5",
            Self::Product9 => "product-9",
            Self::Product17 => "product-17",
        }
    }
}

impl fmt::Display for Strategy {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.pad(self.name())
    }
}

/// The name of no strategy.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct UnknownStrategy(String);

impl fmt::Display for UnknownStrategy {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "no strategy is called '{}'; there are", self.0)?;
        for (i, s) in Strategy::ALL.iter().enumerate() {
            write!(f, "{} {s}", if i == 0 { "" } else { "," })?;
        }
        Ok(())
    }
}

impl std::error::Error for UnknownStrategy {}

impl FromStr for Strategy {
    type Err = UnknownStrategy;
    fn from_str(name: &str) -> Result<Self, UnknownStrategy> {
        Self::ALL.iter().copied().find(|s| s.name() == name).ok_or_else(|| UnknownStrategy(name.to_owned()))
    }
}
