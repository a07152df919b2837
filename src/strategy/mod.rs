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
/// [choosing](crate::guide::choosing) says which one to take, and when no sample is needed at all. Each variant below states its
/// density, its use, its cost and its variance.
///
/// - **Density**: symbols and equations are those of [mathematics]; numbers without a point are equations of the paper
///   (Villeneuve et al. 2021).
/// - **Cost**: time per sample on one thread of an AMD EPYC (Zen 5) with AVX2, for batches of 65,536 rays, with `t` and `pdf`
///   written. [speed](crate::guide::speed) has other outputs and instruction sets.
///
///   ```sh
///   cargo run --release -- profile --rays 65536 --threads 1 --backend avx2 --backend avx512 --rounds 9
///   ```
/// - **Variance** `V`: the variance of one weight over the square of its mean, without shadows: median and 99th percentile
///   over a broad set of scenes, and mean over camera rays near an emitter.
///
///   ```sh
///   cargo run --release -- variance --set broad --scenes 2000 --seed 20261122       # median, p99
///   cargo run --release -- variance --set canonical --scenes 2000 --seed 20261122   # mean: g 0.9, point-normal
///   ```
///
/// For a spot, product densities have the falloff `S` in place of the cosine `N`. The others but `Transmittance` are those of an
/// emitter without a normal, on the part of the ray inside the cone.
///
/// - **Plot**: the density (line) beside the integrand (area), both with the integral 1, and the `V` of that ray. The emitter is
///   0.5 m beside the ray, at `t` 1.6 m, and turns away from the start of the ray; the medium is thin and scatters evenly, or is
///   dense and scatters forward. The nearer the line is to the area, the smaller is `V`.
///
///   ```sh
///   cargo run --release -- report --strategies docs/strategies
///   ```
///
/// [mathematics]: crate::guide::mathematics
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub enum Strategy {
    /// Free-flight sampling, cut off at `t_max`: proportional to the transmittance along the ray.
    ///
    /// ```text
    /// p_t = mu_t exp(-mu_t (t - t_min)) / (1 - exp(-mu_t (t_max - t_min)))    t_min <= t <= t_max     (3.1)
    /// ```
    ///
    #[doc = include_str!("../../docs/strategies/transmittance.svg")]
    ///
    /// | | |
    /// |---|---|
    /// | use | to combine with another density (multiple importance sampling): it knows no emitter, and so misses no other light |
    /// | cost | 3.0 ns; 3.2 with 8 samples per ray |
    /// | variance | median 1.9, p99 without bound, near an emitter 17 |
    /// | equations | [3.1](crate::guide::mathematics#31-transmittance) |
    Transmittance,
    /// Uniform in the angle at the emitter: proportional to `1/r^2` on the lit part of the ray.
    ///
    /// ```text
    /// p_t = h / (Theta r^2)    Theta: the angle that the lit part subtends                            (3.3)
    /// ```
    ///
    #[doc = include_str!("../../docs/strategies/equi-angular.svg")]
    ///
    /// | | |
    /// |---|---|
    /// | use | point emitters in thin media with `abs(g)` below 0.3, where the sampler shows in a profile |
    /// | cost | 3.8 ns, in fast precision 2.4; 3.0 with 8 samples per ray |
    /// | variance | median 0.38, p99 7e4, near an emitter 1.2; the variation of `T`, `rho` and `N` stays in the weight |
    /// | equations | [3.2](crate::guide::mathematics#32-equi-angular), Kulla and Fajardo (2012) |
    EquiAngular,
    /// Proportional to `N/r^2`; of an emitter without a normal the equi-angular density.
    ///
    /// ```text
    /// p_t = N h / (mass r^2)    mass: the integral of N over the angle                                (3.10)
    /// ```
    ///
    #[doc = include_str!("../../docs/strategies/point-normal.svg")]
    ///
    /// | | |
    /// |---|---|
    /// | use | surfaces that emit, in thin media with `abs(g)` below 0.3, where the sampler shows in a profile |
    /// | cost | 5.1 ns, in fast precision 3.6; 3.8 with 8 samples per ray |
    /// | variance | median 0.16, p99 7e8, near an emitter 1.4; bounded by that of `T` and `rho`, which vary little in thin media |
    /// | equations | [3.3](crate::guide::mathematics#33-point-normal), (21) |
    PointNormal,
    /// Proportional to `N/r^2` times the Taylor polynomial of order 6 of the transmittance.
    ///
    /// ```text
    /// p_theta proportional to N(theta) P(min(theta, theta_c)),    p_t = p_theta h / r^2               (4.5), (1.8)
    /// P: exp(-mu_t h (tan theta + sec theta - 1)) to order 6 about theta = 0, trusted up to theta_c
    /// ```
    ///
    #[doc = include_str!("../../docs/strategies/taylor-transmittance.svg")]
    ///
    /// | | |
    /// |---|---|
    /// | use | to compare with the paper: a product density costs less and has a smaller variance, except in single scenes |
    /// | cost | 17 ns; 11 with 8 samples per ray |
    /// | variance | median 0.084, p99 7e8, near an emitter 0.73 |
    /// | equations | [4](crate::guide::mathematics#4-taylor-densities): 4.1, 4.2, 4.5; (4)-(11), (21)-(30) |
    TaylorTransmittance,
    /// Proportional to `N/r^2` times the Taylor polynomial of order 6 of the phase function.
    ///
    /// ```text
    /// p_theta proportional to N(theta) P(min(theta, theta_c)),    p_t = p_theta h / r^2               (4.5), (1.8)
    /// P: (1 + g^2 + 2 g sin theta)^(-3/2) to order 6 about theta = 0, trusted up to theta_c; theta mirrored for g < 0
    /// ```
    ///
    #[doc = include_str!("../../docs/strategies/taylor-phase.svg")]
    ///
    /// | | |
    /// |---|---|
    /// | use | to compare with the paper: a product density costs less and has a smaller variance, except in single scenes |
    /// | cost | 16 ns; 10 with 8 samples per ray |
    /// | variance | median 0.033, p99 7e8, near an emitter 0.18 |
    /// | equations | [4](crate::guide::mathematics#4-taylor-densities): 4.3-4.5; (13)-(30) |
    TaylorPhase,
    /// Nearly proportional to the whole integrand `T rho N / r^2`: a line through its values at 3 places.
    ///
    /// The density is that of [`Product5`](Self::Product5) with 3 knots. In a coloured medium it is that of the
    /// [mean](crate::Medium::mean).
    ///
    #[doc = include_str!("../../docs/strategies/product-3.svg")]
    ///
    /// | | |
    /// |---|---|
    /// | use | seldom: `Product5` costs 2 ns more |
    /// | cost | 8.5 ns; 4.0 with 8 samples per ray |
    /// | variance | median 0.013, p99 0.25, near an emitter 7.1e-3 |
    /// | equations | [5](crate::guide::mathematics#5-the-half-angle-variable), [6](crate::guide::mathematics#6-the-product-density) |
    Product3,
    /// Nearly proportional to the whole integrand `T rho N / r^2`: a line through its values at 5 places.
    ///
    /// ```text
    /// p_t = p_v (dv/dY) X/r                                                                          (6.17)
    /// X = (t - t_h) + r,  Y = X - X_a,  v = (1 + e) Y/(Y + Y_c), from 0 to 1 on the lit part           (5.1), (6.4)
    /// p_v: piecewise linear in v, about the integrand over v at the knots v_k, of the integral 1       (6.10)-(6.14)
    /// 1/Y_c = 0.45 mu_t + 1/(1.5 X_a + 1.25 h (1 - g)/(1 + g)),  e = Y_c/(X_b - X_a)                   (6.1), (6.2)
    /// ```
    ///
    /// In a coloured medium it is the mixture (9.1) of the densities of the channels.
    ///
    #[doc = include_str!("../../docs/strategies/product-5.svg")]
    ///
    /// | | |
    /// |---|---|
    /// | use | the default: one sample per ray and emitter, and all media. In four rendered scenes, shadows included, it is 1.5 to 38 times as efficient as `EquiAngular` ([choosing](crate::guide::choosing#strategies)) |
    /// | cost | 11 ns, in fast precision 8.2; 4.5 with 8 samples per ray |
    /// | variance | median 0.0021, p99 0.022, near an emitter 6.7e-4 |
    /// | equations | [5](crate::guide::mathematics#5-the-half-angle-variable), [6](crate::guide::mathematics#6-the-product-density), [9](crate::guide::mathematics#9-colour); our derivation |
    #[default]
    Product5,
    /// Nearly proportional to the whole integrand `T rho N / r^2`: a line through its values at 9 places.
    ///
    /// The density is that of [`Product5`](Self::Product5) with 9 knots, also in a coloured medium.
    ///
    #[doc = include_str!("../../docs/strategies/product-9.svg")]
    ///
    /// | | |
    /// |---|---|
    /// | use | several samples per ray and emitter in one call: they share the set-up |
    /// | cost | 14 ns, in fast precision 11; 5.3 with 8 samples per ray |
    /// | variance | median 2.4e-4, p99 3.6e-3, near an emitter 5.2e-5 |
    /// | equations | [5](crate::guide::mathematics#5-the-half-angle-variable), [6](crate::guide::mathematics#6-the-product-density), [9](crate::guide::mathematics#9-colour) |
    Product9,
    /// Nearly proportional to the whole integrand `T rho N / r^2`: a line through its values at 17 places.
    ///
    /// The density is that of [`Product5`](Self::Product5) with 17 knots. In a coloured medium it is that of the
    /// [mean](crate::Medium::mean).
    ///
    #[doc = include_str!("../../docs/strategies/product-17.svg")]
    ///
    /// | | |
    /// |---|---|
    /// | use | many samples per ray, without shadows: with shadows it is no better than `Product9` |
    /// | cost | 22 ns; 7.7 with 8 samples per ray |
    /// | variance | median 2.2e-5, p99 1.2e-3, near an emitter 4.5e-6 |
    /// | equations | [5](crate::guide::mathematics#5-the-half-angle-variable), [6](crate::guide::mathematics#6-the-product-density) |
    Product17,
}

impl Strategy {
    /// All strategies, the simplest first.
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

    /// Whether a sampler of this strategy can have the precision. All strategies have [`Precision::Exact`]; `EquiAngular`,
    /// `PointNormal`, `Product5` and `Product9` also have [`Precision::Fast`]. The others would gain less than a fifth.
    #[must_use]
    pub fn has_precision(self, precision: Precision) -> bool {
        precision == Precision::Exact
            || matches!(self, Self::EquiAngular | Self::PointNormal | Self::Product5 | Self::Product9)
    }

    /// The name on the command line, in JSON and in prose.
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

/// The error of parsing a [`Strategy`]: the text names no strategy.
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
