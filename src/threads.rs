//! On how many threads a call runs.

use core::num::NonZeroUsize;

/// On which threads a call runs. No bit of a result depends on it.
///
/// Without the feature `rayon` every call runs on the calling thread alone.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub enum Threads {
    /// Those of the rayon pool that the call is made in, which is the global one unless `ThreadPool::install` says
    /// otherwise. A batch of a few thousand values stays on one thread.
    #[default]
    Pool,
    /// At most so many threads of that pool.
    AtMost(NonZeroUsize),
    /// The calling thread alone: for a renderer that has its own threads, each with a part of the rays.
    This,
}

impl Threads {
    /// For the two halves of a batch; `None` if they run one after the other on this thread.
    #[cfg(feature = "rayon")]
    pub(crate) fn halves(self) -> Option<[Self; 2]> {
        let some = |threads: usize| NonZeroUsize::new(threads).map_or(Self::This, Self::AtMost);
        match self {
            Self::Pool => Some([self; 2]),
            Self::AtMost(threads) if threads.get() > 1 => {
                let low = threads.get() / 2;
                Some([some(low), some(threads.get() - low)])
            }
            Self::AtMost(_) | Self::This => None,
        }
    }
}
