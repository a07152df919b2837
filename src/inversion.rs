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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::simd::Portable;
    use std::cell::Cell;

    /// Solves `f(x) = 0` in `[low, high]` from `start`: the root, whether the lane is counted, and how many steps it took.
    fn root(f: impl Fn(f32) -> [f32; 3], [low, high]: [f32; 2], start: f32, tolerance: f32) -> (f32, bool, usize) {
        let (isa, steps) = (Portable, Cell::new(0));
        let c = |x| isa.splat(x);
        let at = |x: <Portable as Isa>::V| {
            let values = f(x.to_array()[0]);
            steps.set(steps.get() + usize::from(values[0].abs() > tolerance));
            let [value, slope, curvature] = values.map(c);
            At { value, slope, curvature }
        };
        let root = solve(isa, at, [c(low), c(high)], c(start), c(tolerance), !none(isa));
        (root.x.to_array()[0], <Portable as Isa>::V::bits(root.bisected) & 1 == 1, steps.get())
    }

    /// A slope that is too large by a factor leaves a share of the distance to the root at every step: no step leaves the bracket,
    /// and there are as many as one likes.
    #[test]
    fn a_lane_of_more_than_eight_steps_is_counted() {
        let mut lengths = [0; 2];
        for share in 1..70 {
            let slope = 1.0 / (1.0 - 0.01 * share as f32);
            let (x, counted, steps) = root(|x| [x - 0.25, slope, 0.0], [0.0, 1.0], 1.0, 1e-3);
            assert!((0.25..1.0).contains(&x), "{x} after {steps} steps");
            assert_eq!(counted, steps > FEW_STEPS, "{steps} steps");
            for (count, few) in lengths.iter_mut().zip([FEW_STEPS, FEW_STEPS + 1]) {
                *count += usize::from(steps == few);
            }
        }
        assert!(lengths.iter().all(|&count| count > 0), "none of 8 or none of 9 steps: {lengths:?}");
    }

    /// Where the slope leads out of the bracket, half of it is left.
    #[test]
    fn a_step_that_leaves_the_bracket_is_a_bisection_and_counted() {
        let (x, counted, _) = root(|x| [x - 0.25, 1e-9, 0.0], [0.0, 1.0], 1.0, 1e-6);
        assert!(counted && (x - 0.25).abs() <= 1e-6, "{x}");
        assert_eq!(root(|x| [x - 0.25, 1.0, 0.0], [0.0, 1.0], 1.0, 1e-6), (0.25, false, 1));
    }
}
