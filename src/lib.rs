#![doc = include_str!("../README.md")]
//!
//! # The road
//!
//! Every ray takes it once, in blocks of a few lane groups that go from station to station, and nothing flows back:
//!
//! `scene -> geometry -> density -> inversion -> samples`
//!
//! | station | what it is |
//! |---|---|
//! | `scene` | [`Ray`], [`Emitter`] with the [`Cone`] of a spot, [`Medium`]: one of each, validated |
//! | `batch` | [`Rays`], [`Emitters`], [`Media`], [`Samples`]: borrowed columns of many |
//! | `geometry` | `h`, `t_h`, the lit interval and its ends, without cancellation: in f32, where that is not enough in f64 |
//! | `expansion` | a factor of the integrand as a polynomial of the angle |
//! | `strategy` | one file per density: its set-up, its inverse, its pdf |
//! | `inversion` | Chebyshev's method in a bracket |
//! | `integrand` | `mu_s T rho N` for the weight |
//! | `road` | threads, chunks, blocks, and the passes over a block |
//! | `simd` | lane groups, one binding per instruction set |
//! | [`oracle`] | all of it again in f64, written plainly, as the truth for tests |
//!
//! # Quantities
//!
//! | symbol | meaning | unit |
//! |---|---|---|
//! | `t` | distance along the ray | m |
//! | `mu_a`, `mu_s`, `mu_t` | absorption, scattering and extinction coefficient | 1/m |
//! | `g` | mean cosine of Henyey-Greenstein; `g > 0` scatters forward | 1 |
//! | `h` | distance from the emitter to the line of the ray | m |
//! | `t_h` | where the ray passes the emitter | m |
//! | `r` | distance from `x(t)` to the emitter | m |
//! | `theta` | `atan((t - t_h)/h)`, the angle at the emitter | rad |
//! | `T` | transmittance from `t_min` over `x(t)` to the emitter | 1 |
//! | `rho` | phase function | 1/sr |
//! | `N` | cosine at the emitter | 1 |
//! | `u` | uniform variate | 1 |
//! | pdf | probability density over distance | 1/m |
//! | weight | `mu_s T rho N / (r^2 pdf)` | 1/m^2 |
//!
//! The single-scattered radiance of a ray, per unit of the emitter's intensity, is the integral of the integrand
//! `mu_s T rho N / r^2` over `t`, and the mean of the weights.
//!
//! Which strategy to take: see [`Strategy`].
//!
//! # Equations of the paper
//!
//! The supplement of "Practical product sampling for single scattering in media" (Villeneuve, Gruson, Georgiev,
//! Nowrouzezahrai, EGSR 2021), with its misprints corrected:
//!
//! | equations | where |
//! |---|---|
//! | (1), (2) the integral over distance and over angle | [`oracle::Scene::integrand`], [`oracle::Scene::radiance`] |
//! | (3) transmittance, (12) phase function, (21) cosine | `integrand`, `geometry`; [`oracle::Scene`] |
//! | (4)-(11) Taylor expansion of the transmittance | `strategy/taylor_transmittance`; [`oracle::paper`] |
//! | (13)-(20) Taylor expansion of the phase function | `strategy/taylor_phase`; [`oracle::paper`] |
//! | (22)-(30) the integral of polynomial times cosine | [`oracle::paper`]; `strategy/taylor` has a form that does not cancel |
//!
//! The product densities (`strategy/product`) are our own derivation.
//!
//! # Reproducibility
//!
//! Equal inputs give equal bits, whatever the number of threads, the length of the batch or the place in it. Between
//! machines this holds where the instruction sets round alike: with fused multiply-add, or without. All of it is said of
//! the default [floating-point environment](Sampler#floating-point-environment), which flushes nothing to zero.

mod batch;
mod density;
mod error;
mod expansion;
mod geometry;
mod integrand;
mod inversion;
#[cfg(feature = "measure")]
mod limits;
pub mod oracle;
mod precision;
mod road;
mod sampler;
mod scene;
mod simd;
mod strategy;

pub use batch::{Counts, Emitters, Media, Rays, Samples};
pub use error::Error;
pub use glam;
#[cfg(feature = "measure")]
#[doc(hidden)]
pub use limits::{Limit, Operations};
pub use precision::{Precision, UnknownPrecision};
#[cfg(feature = "measure")]
#[doc(hidden)]
pub use road::stages::Stage;
pub use sampler::{Sample, Sampler};
pub use scene::{Cone, Emitter, FARTHEST, Medium, Ray, UNIT_TOLERANCE};
pub use simd::Backend;
pub use strategy::{Strategy, UnknownStrategy};
