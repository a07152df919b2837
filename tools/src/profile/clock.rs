//! Time that is spent on some work, on the threads of the pool that it is called on.

use anyhow::Result;
use cpu_time::ThreadTime;
use std::time::{Duration, Instant};

/// How long threads are kept busy before the clock starts: to wake one up takes tens of microseconds.
const WARM_UP: Duration = Duration::from_micros(500);

/// Does `work` at least once and until threads that slept while others were measured are awake.
pub(crate) fn warm_up(mut work: impl FnMut() -> Result<()>) -> Result<()> {
    let start = Instant::now();
    loop {
        work()?;
        if start.elapsed() >= WARM_UP {
            return Ok(());
        }
    }
}

/// Does `work`; returns its time \[ns\].
///
/// Of one thread it is the time that it worked: what others do on the machine does not count. Of several it is the time
/// that went by until the last was done.
pub(crate) fn nanoseconds<R>(work: impl FnOnce() -> R) -> (f64, R) {
    let (worked, wall) = (ThreadTime::now(), Instant::now());
    let done = work();
    let alone = rayon::current_num_threads() == 1;
    let elapsed = if alone { worked.elapsed() } else { wall.elapsed() };
    (1e9 * elapsed.as_secs_f64(), done)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn short_work_warms_up_until_threads_are_awake_and_long_work_once() {
        let times = |pause: Duration| {
            let (start, mut times) = (Instant::now(), 0);
            warm_up(|| {
                times += 1;
                std::thread::sleep(pause);
                Ok(())
            })
            .unwrap();
            assert!(start.elapsed() >= WARM_UP);
            times
        };
        assert!(times(Duration::ZERO) > 1);
        assert_eq!(times(WARM_UP), 1);
    }
}
