//! The threads of a call.

use core::num::NonZeroUsize;

/// The threads that a call runs on. Results have the same bits for all of them.
///
/// Without the feature `rayon` every call runs on the calling thread.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub enum Threads {
    /// The threads of the rayon pool that the call is made in: the global one, or that of `ThreadPool::install`. A batch of up to
    /// 4096 values runs on the calling thread; so does every batch where the pool has one thread.
    #[default]
    Pool,
    /// At most this number of them; 1 means the calling thread.
    AtMost(NonZeroUsize),
    /// The calling thread alone: for a renderer that has its own threads, each with a part of the rays.
    Caller,
}

/// The number of parts of a batch for each thread of a pool: a thread that finishes early takes a part of another thread.
#[cfg(feature = "rayon")]
const PARTS: usize = 32;

/// The division of a batch into two parts.
#[derive(Clone, Copy)]
pub(crate) struct Split {
    /// The first part has `share[0]` of `share[1]` equal shares.
    pub(crate) share: [usize; 2],
    /// The threads of both parts.
    pub(crate) threads: [Threads; 2],
}

impl Threads {
    /// At most this number of threads of the pool; 0 counts as 1.
    #[must_use]
    pub fn at_most(threads: usize) -> Self {
        NonZeroUsize::new(threads).map_or(Self::Caller, Self::AtMost)
    }

    /// The division of a batch and its threads; `None` if both parts run on this thread.
    pub(crate) fn split(self) -> Option<Split> {
        match self {
            #[cfg(feature = "rayon")]
            Self::Pool => match rayon::current_num_threads() {
                1 => None,
                threads => Self::at_most(PARTS * threads).split(),
            },
            Self::AtMost(threads) if cfg!(feature = "rayon") && threads.get() > 1 => {
                let (low, all) = (threads.get() / 2, threads.get());
                Some(Split { share: [low, all], threads: [Self::at_most(low), Self::at_most(all - low)] })
            }
            _ => None,
        }
    }
}

#[cfg(all(test, feature = "rayon"))]
mod tests {
    use super::*;

    /// Both parts together have as many threads as the whole, and values in proportion.
    #[test]
    fn all_threads_but_a_single_one_are_split() {
        for threads in [Threads::Caller, Threads::at_most(0), Threads::at_most(1)] {
            assert!(threads.split().is_none(), "{threads:?}");
        }
        for n in 2..100 {
            let Split { share: [low, all], threads } = Threads::at_most(n).split().unwrap();
            assert_eq!((low, all), (n / 2, n));
            assert_eq!(threads, [low, n - low].map(Threads::at_most));
        }
        let of_pool = |threads| {
            let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
            pool.install(|| Threads::Pool.split())
        };
        assert_eq!(of_pool(3).unwrap().share[1], 3 * PARTS);
        assert!(of_pool(1).is_none(), "a pool of one thread");
    }
}
