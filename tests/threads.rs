//! A call on its own thread does not wait for the pool's threads; and how many there are changes no bit.

mod scenes;

use airlight::{Sampler, Samples, Strategy, Threads};
use rayon::ThreadPoolBuilder;
use scenes::{Columns, Random};
use std::sync::mpsc::channel;
use std::time::{Duration, Instant};

/// Several chunks of a thread that is alone, and more rays than are left in the caches.
const RAYS: usize = 300_001;
/// Less than a chunk of a pool.
const FEW: usize = 3001;

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
    for start in (0..RAYS).step_by(FEW) {
        let range = start..RAYS.min(start + FEW);
        let part = columns.sample_range(&sampler, range.clone());
        assert!(range.clone().all(|i| part.bits(i - start) == expected.bits(i)), "{range:?}");
    }

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
    // One chunk: 4096 rays, and 32 rays with 200 variates each.
    columns.sample_range(&sampler.with_threads(Threads::Pool), 0..4096);
    let u: Vec<f32> = (0..32 * 200).map(|i| i as f32 / 6400.0).collect();
    let (mut t, mut pdf) = (vec![0.0; u.len()], vec![0.0; u.len()]);
    let (rays, emitters, media) = (columns.rays(0..32), columns.emitters(0..32), columns.media(0..32));
    sampler.sample(&rays, &emitters, &media, &u, &mut Samples::new(&mut t, &mut pdf)).unwrap();
    assert!(start.elapsed() < until, "the call waited for the pool");
    drop(ends);
}
