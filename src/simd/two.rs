//! Two lane groups in flight.

use super::Isa;
use super::pair::Pair;

/// An instruction set with lane groups in pairs: twice the independent work hides latency. (Four at a time are no faster, as they do
/// not fit the registers.)
#[derive(Clone, Copy, Debug)]
pub(crate) struct Two<I>(pub(super) I);

impl<I: Isa> Isa for Two<I> {
    type V = Pair<I::V>;
    type Mask = Pair<I::Mask>;
    type Double = Pair<I::Double>;
    type Group = [I::Group; 2];
    const FUSED: bool = I::FUSED;

    #[inline]
    fn splat(self, x: f32) -> Self::V {
        Pair(self.0.splat(x), self.0.splat(x))
    }
    #[inline]
    fn splat_double(self, x: f64) -> Self::Double {
        Pair(self.0.splat_double(x), self.0.splat_double(x))
    }
    #[inline]
    fn groups(column: &[f32]) -> &[[I::Group; 2]] {
        I::groups(column).as_chunks().0
    }
    #[inline]
    fn groups_mut(column: &mut [f32]) -> &mut [[I::Group; 2]] {
        I::groups_mut(column).as_chunks_mut().0
    }
    #[inline]
    fn load(self, [low, high]: &[I::Group; 2]) -> Self::V {
        Pair(self.0.load(low), self.0.load(high))
    }
    #[inline]
    fn store(self, lanes: Self::V, [low, high]: &mut [I::Group; 2]) {
        self.0.store(lanes.0, low);
        self.0.store(lanes.1, high);
    }
    #[inline]
    fn prefetch(self, [low, high]: &[I::Group; 2], ahead: usize) {
        self.0.prefetch(low, 2 * ahead);
        // A cache line holds both groups of AVX2.
        if size_of::<I::Group>() >= 64 {
            self.0.prefetch(high, 2 * ahead);
        }
    }
    fn vectorize<Home, R>(self, work: impl FnOnce() -> R) -> R {
        self.0.vectorize::<Home, R>(work)
    }
}
