//! The densities that can be sampled, one file each.

pub(crate) mod equi_angular;
pub(crate) mod point_normal;
pub(crate) mod product;
mod taylor;
pub(crate) mod taylor_phase;
pub(crate) mod taylor_transmittance;
pub(crate) mod transmittance;

use crate::Precision;
use std::fmt;
use std::str::FromStr;

/// Which density over distance is sampled.
///
/// # Choosing a strategy
///
/// | you have | take | as measured |
/// |---|---|---|
/// | one sample per ray and emitter | `Product5`, the default | twice the cost of `EquiAngular`; in four rendered scenes, shadows included, 1.5 to 11 times as efficient, and within a seventh of the best strategy of each |
/// | several samples per ray and emitter | `Product9` | the set-up is shared: with 8 samples one of them costs 0.9 of a single sample of `EquiAngular`, and its median variance is a ninth of that of `Product5` |
/// | no occluders | none: the [`Integral`](crate::Integral) | no noise, for the cost of a sample of `Product9` |
/// | many lights to choose from | [`Integral::choose`](crate::Integral::choose) with four nodes, `Product5` for the sample | what chooses is off by 0.004 % in the median of ordinary scenes |
/// | thin medium, `abs(g)` below 0.3, and the sampler shows in a profile | `PointNormal`, or `EquiAngular` for emitters without a normal | half the cost of `Product5`; its variance is bounded by that of phase function and transmittance, which then vary little |
/// | a dense medium, `abs(g)` above 0.5, or emitters seen from behind | none but a product density | the relative variance of all others has no bound: above 1 for a third of a broad set of scenes |
/// | a second density to combine with (multiple importance sampling) | `Transmittance` | knows no emitter, and so misses no other light |
/// | a comparison with the paper | `TaylorTransmittance`, `TaylorPhase` | 1.4 to 1.6 times the cost of `Product5` and a larger variance in all but single cases |
///
/// Relative variance is that of one weight over the square of its mean: `airlight variance --set broad`. Costs:
/// `airlight profile`, on AVX2. Rendered scenes, at equal time: `airlight render --compare`. More knots than 5 lessen the
/// variance of the density, but with shadows that is no longer what noise is made of: there 9 and 17 knots gain less
/// than 5 % or nothing.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
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
    #[default]
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

    /// Whether a sampler of it can have this precision. All are exact; fast are those of which the geometry is most of the
    /// work: `EquiAngular` and `PointNormal`. The others would gain less than a fifth.
    #[must_use]
    pub fn has_precision(self, precision: Precision) -> bool {
        precision == Precision::Exact || matches!(self, Self::EquiAngular | Self::PointNormal)
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
