//! A call on its own thread does not wait for the pool's threads; and how many there are changes no bit.

mod scenes;

use airlight::{Sampler, Strategy, Threads};
use rayon::ThreadPoolBuilder;
use scenes::{Columns, Random};
use std::sync::mpsc::channel;
use std::time::{Duration, Instant};

/// Many chunks.
const RAYS: usize = 60_001;

/// Threads of the pool that are free, or wait for the end of the test.
const THREADS: usize = 4;

/// All threads of the global pool wait for the end of this test: whoever needs one never returns.
#[test]
fn the_calling_thread_needs_no_other_and_their_number_changes_no_bit() {
    ThreadPoolBuilder::new().num_threads(THREADS).build_global().unwrap();
    let sampler = Sampler::new(Strategy::Product5);
    let columns = Columns::random(&mut Random::new(3), RAYS);
    let expected = columns.sample(&sampler);
    let equal = |threads: Threads| {
        let drawn = columns.sample(&sampler.with_threads(threads));
        assert_eq!(drawn.counts, expected.counts, "{threads:?}");
        assert!((0..RAYS).all(|i| drawn.bits(i) == expected.bits(i)), "{threads:?}");
    };
    for threads in [0, 1, 2, 3, 4, 5, 100, usize::MAX] {
        equal(Threads::at_most(threads));
    }
    equal(Threads::Pool);

    let until = Duration::from_secs(300);
    let ends = [(); THREADS].map(|()| {
        let (end, wait) = channel::<()>();
        let (started, start) = channel::<()>();
        rayon::spawn(move || {
            started.send(()).unwrap();
            let _ = wait.recv_timeout(until);
        });
        start.recv().unwrap();
        end
    });
    let start = Instant::now();
    equal(Threads::Caller);
    equal(Threads::at_most(1));
    assert!(start.elapsed() < until, "the call waited for the pool");
    drop(ends);
}
