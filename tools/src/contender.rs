//! What is compared: the strategies, and the best that the paper has.

use airlight::Strategy;
use airlight::oracle::{Coloured, Scene};
use std::fmt;
use std::str::FromStr;

/// The product densities.
pub const PRODUCTS: [Strategy; 4] = [Strategy::Product3, Strategy::Product5, Strategy::Product9, Strategy::Product17];

/// A density whose variance is measured.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Contender {
    /// One that can be sampled.
    Strategy(Strategy),
    /// The Taylor density of the phase function times `N`, with a quadratic Bezier warp for the transmittance: for
    /// reference, in the oracle alone.
    PaperBest,
}

impl Contender {
    /// All of them.
    #[must_use]
    pub fn all() -> Vec<Self> {
        Strategy::ALL.iter().copied().map(Self::Strategy).chain([Self::PaperBest]).collect()
    }

    /// Its name on the command line and in JSON.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Strategy(strategy) => strategy.name(),
            Self::PaperBest => "paper-best",
        }
    }

    /// Its relative variance, if anything is lit.
    #[must_use]
    pub fn variance(self, scene: &Scene) -> Option<f64> {
        match self {
            Self::Strategy(strategy) => scene.relative_variance(strategy),
            Self::PaperBest => scene.relative_variance_of_paper_best(),
        }
    }

    /// The mean of it over the channels of a medium, if anything is lit. None of the paper's best in more than one channel:
    /// it follows the transmittance of one.
    #[must_use]
    pub fn mean_variance(self, scene: &Coloured) -> Option<f64> {
        match (self, scene.channels()) {
            (_, [grey]) => self.variance(grey),
            (Self::Strategy(strategy), channels) => {
                Some(scene.relative_variance(strategy)?.iter().sum::<f64>() / channels.len() as f64)
            }
            (Self::PaperBest, _) => None,
        }
    }
}

/// The name of none.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct UnknownContender(String);

impl fmt::Display for UnknownContender {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let names: Vec<&str> = Contender::all().into_iter().map(Contender::name).collect();
        write!(f, "no strategy is called '{}'; there are {}", self.0, names.join(", "))
    }
}

impl std::error::Error for UnknownContender {}

impl FromStr for Contender {
    type Err = UnknownContender;
    fn from_str(name: &str) -> Result<Self, UnknownContender> {
        Self::all().into_iter().find(|c| c.name() == name).ok_or_else(|| UnknownContender(name.to_owned()))
    }
}
