//! A call on its own thread does not wait for the pool's threads; and how many there are changes no bit.

mod scenes;

use airlight::{Sampler, Strategy, Threads};
use rayon::ThreadPoolBuilder;
use scenes::{Columns, Random};
use std::num::NonZeroUsize;
use std::sync::mpsc::channel;
use std::time::{Duration, Instant};

/// Many chunks.
const RAYS: usize = 60_001;

/// The global pool's only thread waits for the end of this test: whoever needs it never returns.
#[test]
fn this_thread_needs_no_other() {
    ThreadPoolBuilder::new().num_threads(1).build_global().unwrap();
    let (end, wait) = channel::<()>();
    let sampler = Sampler::new(Strategy::Product5);
    let columns = Columns::random(&mut Random::new(3), RAYS);
    let expected = columns.sample(&sampler);
    let equal = |threads: Threads| {
        let drawn = columns.sample(&sampler.with_threads(threads));
        assert_eq!(drawn.counts, expected.counts, "{threads:?}");
        assert!((0..RAYS).all(|i| drawn.bits(i) == expected.bits(i)), "{threads:?}");
    };
    for threads in [1, 2, 3, 5] {
        equal(Threads::AtMost(NonZeroUsize::new(threads).unwrap()));
    }

    rayon::spawn(move || {
        let _ = wait.recv_timeout(Duration::from_secs(300));
    });
    let start = Instant::now();
    equal(Threads::Caller);
    equal(Threads::AtMost(NonZeroUsize::MIN));
    assert!(start.elapsed() < Duration::from_secs(300), "the call waited for the pool");
    drop(end);
}
