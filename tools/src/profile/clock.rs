//! Time that is spent on some work.

use cpu_time::ThreadTime;
use rayon::ThreadPool;
use std::time::Instant;

/// Runs `work` in a pool; returns its time \[ns\].
///
/// Of one thread it is the time that it worked: what others do on the machine does not count. Of several it is the time
/// that went by until the last was done.
pub(super) fn nanoseconds<R: Send>(pool: &ThreadPool, work: impl FnOnce() -> R + Send) -> (f64, R) {
    let alone = pool.current_num_threads() == 1;
    let (elapsed, done) = pool.install(|| {
        let (worked, wall) = (ThreadTime::now(), Instant::now());
        let done = work();
        (if alone { worked.elapsed() } else { wall.elapsed() }, done)
    });
    (1e9 * elapsed.as_secs_f64(), done)
}
