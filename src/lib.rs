#![doc = include_str!("guide/links.md")]
#![cfg_attr(doc, doc = include_str!(concat!(env!("OUT_DIR"), "/images.md")))]
#![doc = include_str!("../README.md")]
//!
//! # Modules
//!
//! Data flows one way, in blocks of a few lane groups of rays:
//!
//! `scene -> geometry -> density -> inversion -> samples`
//!
//! | module | content |
//! |---|---|
//! | `scene` | [`Ray`], [`Emitter`] with the [`Cone`] of a spot, [`Medium`]: single ones, validated |
//! | `batch` | [`Rays`], [`Emitters`], [`Media`], [`Samples`]: borrowed columns of a batch |
//! | `geometry` | `h`, `t_h`, the lit interval and its ends, without cancellation: in f32, and in f64 where that is not enough |
//! | `expansion` | a factor of the integrand as a polynomial of the angle |
//! | `strategy` | one file per density: set-up, sample, pdf, CDF |
//! | `inversion` | the root of a CDF, by Chebyshev's method in a bracket |
//! | `integrand` | `mu_s T rho N` for the weight |
//! | `integral` | the radiance of a ray without a sample, by Gauss and Legendre's rule |
//! | `road` | from a call to its kernels: threads, chunks, blocks, and the passes over a block |
//! | `simd` | lane groups and elementary functions, one binding per instruction set |
//! | [`oracle`] | the same quantities in f64, written plainly: the reference of the tests |
//!
//! # Quantities
//!
//! | symbol | meaning | unit |
//! |---|---|---|
//! | `t` | distance along the ray | m |
//! | `mu_a`, `mu_s`, `mu_t` | absorption, scattering and extinction coefficient | 1/m |
//! | `g` | mean cosine of Henyey-Greenstein; `g > 0` scatters forward | 1 |
//! | `h` | distance from the emitter to the line of the ray | m |
//! | `t_h` | distance along the ray of the point nearest to the emitter | m |
//! | `r` | distance from `x(t)` to the emitter | m |
//! | `theta` | `atan((t - t_h)/h)`, the angle at the emitter | rad |
//! | `T` | transmittance from `t_min` over `x(t)` to the emitter | 1 |
//! | `rho` | phase function | 1/sr |
//! | `N` | cosine at the emitter; of a spot its falloff | 1 |
//! | `u` | uniform variate | 1 |
//! | pdf | probability density over distance | 1/m |
//! | weight | `mu_s T rho N / (r^2 pdf)` | 1/m^2 |
//!
//! The single-scattered radiance of a ray, per unit of the emitter's intensity, is the integral of the integrand
//! `mu_s T rho N / r^2` over `t`, which is the mean of the weights. Without occluders no sample is needed: [`Integral`] computes
//! it. [`guide::mathematics`] has all equations, and the names that the source gives to their terms.
//!
//! # Noise-free fog lights
//!
//! ```
//! use airlight::{Emitter, Integral, Medium, Nodes, Ray};
//!
//! # fn main() -> Result<(), airlight::Error> {
//! let fog = Medium::new(0.01, 0.1, 0.6)?; // mu_a, mu_s [1/m], g
//! let view = Ray::new([0.0; 3], [0.0, 0.0, 1.0], 0.0, 40.0)?;
//! let integral = Integral::new(Nodes::Eight);
//! let mut radiance = 0.0;
//! # let mut expected = 0.0;
//! for x in [-2.0, 2.0] {
//!     let lamp = Emitter::point_normal([x, 1.0, 3.0], [0.0, -1.0, 0.0])?;
//!     radiance += 100.0 * integral.radiance_one(&view, &lamp, &fog); // 100 W/sr
//! #   expected += 100.0 * airlight::oracle::Scene::new(&view, &lamp, &fog).radiance();
//! }
//! # assert!(expected > 0.1 && (f64::from(radiance) / expected - 1.0).abs() < 1e-5);
//! println!("{radiance} W/(m^2 sr)");
//! # Ok(())
//! # }
//! ```
//!
//! [`Integral::radiance`] does the same for a batch of rays. With occluders, multiply the integral by the visible share of the
//! light: the sum of the weights of the visible samples over that of all samples.
//!
//! [`Strategy`] and [`guide::choosing`] say which strategy to take.
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
//! The product densities (`strategy/product`) and the rule of the integral (`integral/rule`) are derived in
//! [`guide::mathematics`].
//!
//! # What may grow
//!
//! Later versions may add columns, variants and fields without breaking a caller: batches are made by functions, not by
//! literals, and matches need a wildcard.
//!
//! ```compile_fail,E0639
//! # use airlight::Rays;
//! let zero = [0.0];
//! let rays = Rays { origin: [&zero; 3], direction: [&zero; 3], t_min: &zero, t_max: &zero };
//! ```
//!
//! ```compile_fail,E0004
//! # use airlight::Threads;
//! # let threads = Threads::Pool;
//! let threads = match threads {
//!     Threads::Pool => 2,
//!     Threads::AtMost(threads) => threads.get(),
//!     Threads::Caller => 1,
//! };
//! ```
//!
//! ```compile_fail,E0638
//! # use airlight::{Error, Medium};
//! # let error = Medium::new(-1.0, 0.0, 0.0).unwrap_err();
//! if let Error::Value { field, value, expected } = error {
//!     println!("{field} {value} {expected}");
//! }
//! ```
//!
//! Functions take positions and directions as `impl Into<[f32; 3]>`, into which the `Vec3` of any version of glam converts, and
//! return them as `[f32; 3]`: no version of glam is part of the public interface. Nor are the items of the feature `measure`.
//!
//! # Reproducibility
//!
//! Equal inputs give equal bits, whatever the number of threads, the length of the batch or the place in it. This also holds
//! between machines whose instruction sets round alike: x86-64 with fused multiply-add and AArch64 give equal bits
//! ([`Backend::is_fused`]), and so do those without it among themselves: x86-64 on SSE2, and wasm32 with or without simd128.
//! It holds in the default [floating-point environment](Sampler#floating-point-environment), which does not flush subnormal
//! numbers to zero.

mod batch;
mod density;
mod error;
mod expansion;
mod geometry;
#[cfg(any(doc, doctest))]
pub mod guide;
mod integral;
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
mod threads;

pub use batch::{Counts, Emitters, Media, Rays, Samples};
pub use error::Error;
pub use integral::{Integral, Nodes, UnknownNodes};
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
pub use threads::Threads;
