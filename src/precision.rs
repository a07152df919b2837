//! The precision of geometry and optical depths.

use crate::simd::Isa;
use std::fmt;
use std::str::FromStr;

/// The precision of a [`Sampler`](crate::Sampler) or an [`Integral`](crate::Integral): each variant is a contract, which
/// `tests/hard_cases.rs`, `tests/accuracy.rs` and `airlight accuracy` check.
///
/// - Take `Exact` unless the sampler shows in a profile, and always for infinite rays, emitters on the ray, and distances that
///   are compared or stored.
/// - Take `Fast` for finite rays that pass the emitter at more than a thousandth of their length.
///
/// ```
/// # use airlight::{Precision, Sampler, Strategy};
/// let sampler = Sampler::new(Strategy::Product5).with_precision(Precision::Fast)?;
/// # assert_eq!(sampler.precision(), Precision::Fast);
/// # Ok::<(), airlight::Error>(())
/// ```
///
/// # Accuracy
/// Of the strategies that have both precisions: `EquiAngular`, `PointNormal`, `Product5` and `Product9`. *Ordinary scenes* are
/// the families `generic`, `far-away`, `phase`, `medium` and `ray` of [accuracy](crate::guide::accuracy#families-of-inputs), which
/// has all bounds.
///
/// Product densities follow the transmittance from the start of the lit part of a ray. Where an emitter's plane cuts the ray, that
/// start has an error of about 1e-7 of the distances in `Fast`. The CDF then has an error of about 1e-7 times the distances, divided
/// by the free path. So the rows below are met where a free path is longer than 1/50 of the distances, or the emitter faces the
/// whole ray.
///
/// | output | where | `Exact` | `Fast` |
/// |---|---|---|---|
/// | all | any bits | finite and in range | finite and in range |
/// | `t`: `abs(CDF(t) - u)`, 99.9 % of rays | ordinary scenes | 6e-6 (`generic`) | 8e-6 |
/// | `t`: the same beyond the rounding of `t` | ordinary scenes | 2^-20 at most | 8e-6 for 99.9 %, 1e-4 for 99.99 % of rays |
/// | | next to an emitter | 2^-20 at most | 2e-3 for 99.9 %, 2e-2 for 99.99 % of rays |
/// | | infinite rays | 2^-20 at most | 1e-3 for 99.9 %, 4e-3 for 99.99 % of rays; product densities 5e-2 |
/// | | ends next to the plane of an emitter with a normal | 2^-20 at most | none: the lit interval may be a rounding long |
/// | pdf at a given `t`, 99 % of rays | ordinary scenes | 8 ulp | 32 ulp |
/// | pdf at a given `t`, 99.9 % of rays | ordinary scenes | | 1e-4, relative |
/// | pdf at a given `t`, 99.99 % of rays | ordinary scenes | 64 ulp | |
/// | weight, relative, 99.9 % of rays | ordinary scenes | 2e-5 | 5e-5 |
/// | rays wrongly taken for lit or dark | all families | none | where the light is below 1e-5 of that of an emitter faced squarely |
///
/// In both precisions the pdf is that of the density that is sampled, so that an estimate of your own integrand is unbiased, except
/// for light that is misjudged. Weights also have the error of the integrand; in `Fast` the optical depth adds 3e-7 of itself.
///
/// # Arithmetic
/// Both precisions compute the geometry of a ray in f32, `Exact` with the remainders of roundings and the emitter's plane in f64.
/// Where that is not enough for them, the ray is computed again in f64: where its line passes the emitter at less than 2^-14 of
/// its distance, for unusual directions, normals and coordinates, and in `Exact` also where an end of the ray is next to the
/// emitter's plane. Both compute spots in f64. The path of a transmittance is in f64 in `Exact`, in f32 in `Fast`; `Fast` also has
/// shorter polynomials, and product densities evaluate the integrand at the knots by a form with fewer operations. Without fused
/// multiply-add both compute all geometry in f64, and are the same.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub enum Precision {
    /// As exact as f32 can hold, for every input.
    #[default]
    Exact,
    /// Geometry and optical depths in f32, for ordinary scenes.
    Fast,
}

impl Precision {
    /// Both precisions.
    pub const ALL: &'static [Self] = &[Self::Exact, Self::Fast];

    /// Whether the arithmetic is that of `Exact`.
    pub(crate) fn is_exact<I: Isa>(self) -> bool {
        is_exact::<I>(self == Self::Exact)
    }

    /// The name on the command line and in JSON.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Exact => "exact",
            Self::Fast => "fast",
        }
    }
}

/// Whether the arithmetic is that of [`Precision::Exact`]: if `exact`, and always without fused multiply-add.
pub(crate) const fn is_exact<I: Isa>(exact: bool) -> bool {
    exact || !I::FUSED
}

impl fmt::Display for Precision {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.pad(self.name())
    }
}

/// The error of parsing a [`Precision`]: the text names no precision.
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
