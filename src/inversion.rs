//! Newton's method inside a shrinking bracket, with bisection where a step leaves it.

use crate::simd::{Isa, Lanes, none};

/// Steps of Newton's method that a lane may take before it counts as bisected.
const NEWTON_STEPS: usize = 8;
/// Steps after which the iteration ends in any case.
const STEPS: usize = 24;

/// Where an increasing function takes a value.
pub(crate) struct Root<I: Isa> {
    pub(crate) x: I::V,
    /// Which lanes bisected at least once, or took more than [`NEWTON_STEPS`].
    pub(crate) bisected: I::Mask,
}

/// Solves `f(x) = 0` for `x` in `[low, high]`, where `f` returns its value and its derivative and increases.
///
/// Each step shrinks the bracket by the sign of `f`, then goes to Newton's point if that lies inside, else to the
/// middle. A lane stops where `|f| <= tolerance`: what it does after that depends on no other lane. The result lies in
/// the bracket whatever `f` returns.
#[inline(always)]
pub(crate) fn solve<I: Isa>(
    isa: I,
    f: impl Fn(I::V) -> (I::V, I::V),
    [low, high]: [I::V; 2],
    start: I::V,
    tolerance: I::V,
    wanted: I::Mask,
) -> Root<I> {
    let (mut low, mut high, mut x) = (low, high, start);
    let mut bisected = none(isa);
    let mut active = wanted;
    for step in 0..STEPS {
        let (value, slope) = f(x);
        active = active & tolerance.lt(value.abs());
        if I::V::bits(active) == 0 {
            break;
        }
        let over = isa.splat(0.0).lt(value);
        high = I::V::select(over, x, high);
        low = I::V::select(over, low, x);
        let newton = x - value / slope;
        let inside = low.le(newton) & newton.le(high);
        let next = I::V::select(inside, newton, (low + high) * isa.splat(0.5));
        let late = if step < NEWTON_STEPS { !inside } else { active };
        bisected = bisected | (active & late);
        x = I::V::select(active, next, x);
    }
    Root { x, bisected }
}
