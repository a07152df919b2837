//! How exactly a sampler computes.

use std::fmt;
use std::str::FromStr;

/// How exactly a [`Sampler`](crate::Sampler) computes: each variant is a contract, held by `airlight accuracy`.
///
/// Both are valid for every input: what they return is finite and in range, and the pdf is that of the density that is
/// sampled.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub enum Precision {
    /// As exact as f32 can hold, on every input.
    #[default]
    Exact,
    /// Geometry in f32 alone: as exact on ordinary scenes as single precision is, and faster.
    Fast,
}

impl Precision {
    /// Both.
    pub const ALL: &'static [Self] = &[Self::Exact, Self::Fast];

    /// Its name on the command line and in JSON.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Exact => "exact",
            Self::Fast => "fast",
        }
    }
}

impl fmt::Display for Precision {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.pad(self.name())
    }
}

/// The name of no precision.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct UnknownPrecision(String);

impl fmt::Display for UnknownPrecision {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "no precision is called '{}'; there are exact, fast", self.0)
    }
}

impl std::error::Error for UnknownPrecision {}

impl FromStr for Precision {
    type Err = UnknownPrecision;
    fn from_str(name: &str) -> Result<Self, UnknownPrecision> {
        Self::ALL.iter().copied().find(|p| p.name() == name).ok_or_else(|| UnknownPrecision(name.to_owned()))
    }
}
