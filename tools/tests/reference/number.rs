//! Numbers of 320 bits.

use dashu_float::{FBig, round::mode::HalfEven};
use std::sync::LazyLock;

pub(crate) type Big = FBig<HalfEven>;

/// The difference of two antiderivatives over an angle of 1e-30 rad, even where `N` vanishes there, leaves 36 digits.
const BITS: usize = 320;

/// `x` itself; what is computed from it has 320 bits.
pub(crate) fn big(x: f64) -> Big {
    Big::try_from(x).expect("a number").with_precision(BITS).value()
}

/// `exp x`, of an `x` that is held where the exponent does not overflow, far beyond what f64 can hold.
pub(super) fn exp(x: &Big) -> Big {
    let most = big(1e5);
    x.clamp(&-most.clone(), &most).exp()
}

pub(super) fn abs(x: Big) -> Big {
    if x < big(0.0) { -x } else { x }
}

pub(super) fn dot(a: &[Big; 3], b: &[Big; 3]) -> Big {
    &a[0] * &b[0] + &a[1] * &b[1] + &a[2] * &b[2]
}

pub(super) fn pi() -> &'static Big {
    static PI: LazyLock<Big> = LazyLock::new(|| Big::pi(BITS));
    &PI
}
