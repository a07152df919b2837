//! Threads to measure on.

use rayon::{ThreadPool, ThreadPoolBuildError, ThreadPoolBuilder};
use std::hint::black_box;
use std::time::{Duration, Instant};

/// So many of them; 0 are as many as there are cores.
///
/// # Errors
/// Where the system refuses them.
pub fn pool(threads: usize) -> Result<ThreadPool, ThreadPoolBuildError> {
    ThreadPoolBuilder::new().num_threads(threads).build()
}

/// One, and one per core where there are several.
#[must_use]
pub fn one_and_all() -> Vec<usize> {
    let all = std::thread::available_parallelism().map_or(1, usize::from);
    if all == 1 { vec![1] } else { vec![1, all] }
}

/// How long a pool takes to do `work` this many times, without the way into the pool.
pub fn time<R>(pool: &ThreadPool, times: u64, mut work: impl FnMut() -> R + Send) -> Duration {
    pool.install(|| {
        let start = Instant::now();
        for _ in 0..times {
            black_box(work());
        }
        start.elapsed()
    })
}
