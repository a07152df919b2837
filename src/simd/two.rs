//! Two lane groups in flight.

use super::pair::Pair;
use super::{Isa, Lanes};

/// An instruction set whose lane groups come in pairs: twice the independent work, to hide latency.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Two<I>(pub(super) I);

impl<I: Isa> Isa for Two<I> {
    type V = Pair<I::V>;
    type Mask = Pair<I::Mask>;
    type Double = Pair<I::Double>;

    #[inline(always)]
    fn splat(self, x: f32) -> Self::V {
        Pair(self.0.splat(x), self.0.splat(x))
    }
    #[inline(always)]
    fn splat_double(self, x: f64) -> Self::Double {
        Pair(self.0.splat_double(x), self.0.splat_double(x))
    }
    #[inline(always)]
    fn load_padded(self, s: &[f32]) -> Self::V {
        let (low, high) = s.split_at(s.len().min(I::V::N));
        Pair(self.0.load_padded(low), self.0.load_padded(if high.is_empty() { &s[..1] } else { high }))
    }
}
