//! Chebyshev's method, which is Newton's with the curvature seen to, inside a shrinking bracket, with bisection where a
//! step leaves it.

use crate::simd::{Isa, Lanes, Number, none};

/// Steps that a lane may take before it counts as bisected.
const FEW_STEPS: usize = 8;
/// Steps after which the iteration ends in any case.
const STEPS: usize = 24;

/// How much of `f` a step may leave, times the square of the step: in the place of `f'''/(6 f')`, and of what a rough
/// curvature adds.
const LEFT: f32 = 16384.0;

/// Where an increasing function takes a value.
pub(crate) struct Root<I: Isa> {
    pub(crate) x: I::V,
    /// Which lanes bisected at least once, or took more than [`FEW_STEPS`].
    pub(crate) bisected: I::Mask,
}

/// What the iteration asks of a function.
pub(crate) struct At<I: Isa> {
    pub(crate) value: I::V,
    pub(crate) slope: I::V,
    /// The derivative of the slope; may be rough.
    pub(crate) curvature: I::V,
}

/// Solves `f(x) = 0` for `x` in `[low, high]`, where `f` increases.
///
/// Each step shrinks the bracket by the sign of `f`, then goes to Chebyshev's point if that lies inside, else to the
/// middle. A lane stops where `|f| <= tolerance`, or after a step so short that little can be left, at most four times the
/// tolerance where the curvature is rough: what a lane does depends on no other lane. The result lies in the bracket
/// whatever `f` returns.
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
        // What such a step leaves is of third order.
        let left = size * bend.mul_add(bend, newton * newton * c(LEFT));
        active = active & !(inside & left.le(tolerance));
        if I::V::bits(active) == 0 {
            break;
        }
    }
    Root { x, bisected }
}
