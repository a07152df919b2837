//! On how many threads a call runs.

use core::num::NonZeroUsize;

/// On which threads a call runs. No bit of a result depends on it.
///
/// Without the feature `rayon` every call runs on the calling thread.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub enum Threads {
    /// Those of the rayon pool that the call is made in, which is the global one unless `ThreadPool::install` says
    /// otherwise. A batch of up to 4096 values stays on one thread, the calling one.
    #[default]
    Pool,
    /// At most so many of them; of one, the calling thread.
    AtMost(NonZeroUsize),
    /// The calling thread alone: for a renderer that has its own threads, each with a part of the rays.
    Caller,
}

/// How a batch is cut in two.
#[derive(Clone, Copy)]
pub(crate) struct Split {
    /// How many of how many equal parts go to the first.
    pub(crate) share: [usize; 2],
    /// The threads of both.
    pub(crate) threads: [Threads; 2],
}

impl Threads {
    /// At most so many threads of the pool; none counts as one.
    #[must_use]
    pub fn at_most(threads: usize) -> Self {
        NonZeroUsize::new(threads).map_or(Self::Caller, Self::AtMost)
    }

    /// For a batch that is cut in two; `None` if both parts run on this thread.
    pub(crate) fn split(self) -> Option<Split> {
        match self {
            Self::Pool if cfg!(feature = "rayon") => Some(Split { share: [1, 2], threads: [self; 2] }),
            Self::AtMost(threads) if cfg!(feature = "rayon") && threads.get() > 1 => {
                let (low, all) = (threads.get() / 2, threads.get());
                Some(Split { share: [low, all], threads: [Self::at_most(low), Self::at_most(all - low)] })
            }
            _ => None,
        }
    }
}
