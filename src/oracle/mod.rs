//! The reference in f64: one ray at a time, plain and slow. Tests compare the kernels with it.
//!
//! It shares only the types of the inputs with the kernels. [`Scene`] has the integrand, its integral by quadrature, and the
//! density, distribution, inverse and variance of each [`Strategy`](crate::Strategy); [`Coloured`] has the same for media of
//! several channels; [`paper`] has the published equations, and [`quadrature`] the integration.
//!
//! The symbols, with `x(t)` the point of the ray at `t` and `y` the emitter:
//!
//! | | |
//! |---|---|
//! | `t_h` | the `t` of the foot of the perpendicular from `y` onto the ray's line, signed \[m\] |
//! | `h` | the distance from `y` to that line \[m\] |
//! | `t'` | `t - t_h` \[m\] |
//! | `r` | `sqrt(h^2 + t'^2)`, the distance from `x(t)` to `y` \[m\] |
//! | `theta` | `atan(t'/h)`, the angle at the emitter from the perpendicular \[rad\] |
//! | `N` | `max(0, n.(x(t) - y)/r) = max(0, alpha cos theta + beta sin theta)`; 1 without a normal |
//! | `S` | the falloff of a spot between the cones, by the cosine of `phi`, the angle to its axis; 1 for other emitters |
//! | `T` | `exp(-mu_t (t - t_min + r))`, the transmittance from the emitter to the start of the medium |
//! | `rho` | the phase function of Henyey and Greenstein \[1/sr\] |

mod angular;
#[cfg(test)]
mod arbitrary;
mod arc;
mod coloured;
mod cone;
mod density;
mod distance;
pub mod paper;
mod product;
pub mod quadrature;
mod scene;
mod twofold;
mod variance;
mod warp;

pub use coloured::Coloured;
pub use scene::Scene;
