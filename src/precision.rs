//! How exactly a sampler computes.

use std::fmt;
use std::str::FromStr;

/// How exactly a [`Sampler`](crate::Sampler) computes: each variant is a contract, held by `airlight accuracy`.
///
/// Both are valid for every input: what they return is finite and in range, and the pdf is that of the density that is
/// sampled, so that an estimate of your own integrand is unbiased, but for light that is misjudged; weights have the error
/// of the integrand too. Which to take:
///
/// - `Exact` unless the sampler shows in a profile;
/// - `Fast` for primary rays and finite segments that pass the emitter at more than a thousandth of their length;
/// - `Exact` for infinite rays, emitters on the ray, and distances that are compared or stored.
///
/// | error, of the strategies that have both | `Exact` | `Fast` |
/// |---|---|---|
/// | `abs(CDF(t) - u)`, ordinary scenes, 99.9 % of rays | 6e-6 | 8e-6 |
/// | the same beyond the rounding of `t` | 2^-20 at most, all scenes | 8e-6 for 99.9 %, 1e-4 for 99.99 % of rays, ordinary scenes |
/// | the same next to an emitter, and on infinite rays | 2^-20 at most | 2e-3 for 99.9 % of rays |
/// | pdf at a given `t`, ordinary scenes, 99 % of rays | 8 ulp | 32 ulp |
/// | pdf at a given `t`, ordinary scenes, 99.9 % of rays | | 1e-4, relative |
/// | taken for lit or dark wrongly | none | only where the light is below 1e-5 of that of an emitter faced squarely |
///
/// Ordinary scenes are the families `generic`, `far-away`, `phase`, `medium` and `ray` of `airlight accuracy`. Where an end
/// of the ray lies next to the plane of an emitter with a normal, `Fast` does not tell how much of the ray is lit: such an
/// interval may be a rounding long, and its CDF then means nothing.
///
/// Both find the geometry of a ray in f64 where f32 is not enough for them: `Fast` where the ray's line passes the emitter
/// at less than 2^-14 of its distance, and for unusual directions, normals and coordinates; `Exact` also where an end of the
/// ray is next to the emitter's plane. On a backend without fused multiply-add both do so everywhere, and are the same.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub enum Precision {
    /// As exact as f32 can hold, on every input.
    #[default]
    Exact,
    /// Geometry in f32 alone.
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
        write!(f, "no precision is called '{}'; there are", self.0)?;
        for (i, p) in Precision::ALL.iter().enumerate() {
            write!(f, "{} {p}", if i == 0 { "" } else { "," })?;
        }
        Ok(())
    }
}

impl std::error::Error for UnknownPrecision {}

impl FromStr for Precision {
    type Err = UnknownPrecision;
    fn from_str(name: &str) -> Result<Self, UnknownPrecision> {
        Self::ALL.iter().copied().find(|p| p.name() == name).ok_or_else(|| UnknownPrecision(name.to_owned()))
    }
}
