//! The root of an increasing function by Chebyshev's method, which is Newton's with the curvature, inside a shrinking bracket.
//!
//! ```text
//! repeat, at most 24 times, while |f(x)| > tolerance
//!     low, high = x, high  if f(x) <= 0,  else low, x
//!     newton = f/f',  bend = newton f''/f'  within [-1, 1]
//!     next = x - newton (1 + bend/2)
//!     x = next  if it lies in [low, high],  else (low + high)/2
//!     stop if next was taken and |f| (bend^2 + 16384 newton^2) <= tolerance
//! ```
//!
//! Each lane takes and stops its steps by its own values: what it computes depends on no other lane.

use crate::simd::{Isa, Lanes, Number, none};

/// The number of steps beyond which a lane counts as bisected.
const FEW_STEPS: usize = 8;
/// The largest number of steps.
const STEPS: usize = 24;

/// The factor of `newton^2` in the estimate of the residual after a step: it stands for `f'''/(6 f')`, and for the error of a
/// rough curvature.
const LEFT: f32 = 16384.0;

/// The root.
pub(crate) struct Root<I: Isa> {
    pub(crate) x: I::V,
    /// Which lanes bisected at least once, or took more than [`FEW_STEPS`].
    pub(crate) bisected: I::Mask,
}

/// A function at a place.
pub(crate) struct At<I: Isa> {
    pub(crate) value: I::V,
    pub(crate) slope: I::V,
    /// The derivative of the slope; may be rough.
    pub(crate) curvature: I::V,
}

/// Solves `f(x) = 0` for `x` in `[low, high]`, where `f` increases, in the `wanted` lanes; the others keep `start`.
///
/// The residual is at most `tolerance`, or four times that after a last step with a rough curvature. The result lies in the
/// bracket whatever `f` returns.
#[cfg_attr(optimized, inline(always))]
pub(crate) fn solve<I: Isa>(
    isa: I,
    f: impl Fn(I::V) -> At<I>,
    [low, high]: [I::V; 2],
    start: I::V,
    tolerance: I::V,
    wanted: I::Mask,
) -> Root<I> {
    let c = |x| isa.splat(x);
    let (mut low, mut high, mut x) = (low, high, start);
    let mut bisected = none(isa);
    let mut active = wanted;
    for step in 0..STEPS {
        let At { value, slope, curvature } = f(x);
        let size = value.abs();
        active = active & tolerance.lt(size);
        let over = c(0.0).lt(value);
        high = I::V::select(over, x, high);
        low = I::V::select(over, low, x);
        let one_over = c(1.0) / slope;
        let newton = value * one_over;
        let bend = (newton * one_over * curvature).max(c(-1.0)).min(c(1.0));
        let next = x - newton.mul_add(bend * c(0.5), newton);
        let inside = low.le(next) & next.le(high);
        let late = if step < FEW_STEPS { !inside } else { active };
        bisected = bisected | (active & late);
        x = I::V::select(active, I::V::select(inside, next, (low + high) * c(0.5)), x);
        // A step of Chebyshev's method leaves a residual of third order.
        let left = size * bend.mul_add(bend, newton * newton * c(LEFT));
        active = active & !(inside & left.le(tolerance));
        if I::V::bits(active) == 0 {
            break;
        }
    }
    Root { x, bisected }
}
