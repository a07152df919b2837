//! How many rays a second each strategy samples: batches of 2^12, 2^16 and 2^20 rays, on one thread and on all.
//!
//! Measured is `Sampler::sample` with all four outputs, every ray with its own origin, direction, interval and variate,
//! and one emitter and one medium for the batch. The columns are made once: the small batches stay in a core's cache,
//! the large ones do not.
//!
//! To compare with how it was before a change:
//!
//! ```text
//! cargo bench --bench strategies -- --save-baseline before
//! cargo bench --bench strategies -- --baseline before
//! ```
//!
//! A filter picks some: `cargo bench --bench strategies -- taylor-phase/one/4096`.

use airlight::{Emitter, Emitters, Media, Medium, Rays, Sampler, Samples, Strategy};
use criterion::{BenchmarkId, Criterion, Throughput, criterion_group, criterion_main};
use glam::Vec3;
use std::hint::black_box;
use std::time::{Duration, Instant};

/// Floats of a cache line.
const LINE: usize = 16;

/// Equal columns that lie next to each other share their address modulo 4096, and so one set of the cache. Each of these
/// starts some lines further on than the one before.
struct Column {
    padded: Vec<f32>,
    start: usize,
}

impl Column {
    fn new(index: usize, n: usize, value: impl FnMut() -> f32) -> Self {
        let mut padded = vec![0.0; n + 1024 + LINE];
        // The address modulo 4096 that it gets: 3 lines after that of the column before.
        let (at, wanted) = (padded.as_ptr().addr() / 4 % 1024, 3 * LINE * index % 1024);
        let start = (wanted + 1024 - at) % 1024;
        padded[start..start + n].fill_with(value);
        Self { padded, start }
    }

    fn of(&self, n: usize) -> &[f32] {
        &self.padded[self.start..self.start + n]
    }

    fn of_mut(&mut self, n: usize) -> &mut [f32] {
        &mut self.padded[self.start..self.start + n]
    }
}

/// Rays from a room's middle in all directions, by a linear congruential generator.
fn columns(n: usize) -> [Column; 9] {
    let mut state = 1u64;
    let mut uniform = move || {
        state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (state >> 40) as f32 / 16_777_216.0
    };
    let mut direction = || {
        let (z, phi) = (2.0 * uniform() - 1.0, std::f32::consts::TAU * uniform());
        let s = (1.0 - z * z).sqrt();
        [s * phi.cos(), s * phi.sin(), z]
    };
    let directions: Vec<[f32; 3]> = (0..n).map(|_| direction()).collect();
    std::array::from_fn(|k| {
        let mut row = 0;
        Column::new(k, n, || {
            row += 1;
            match k {
                0..3 => 10.0 * uniform() - 5.0,
                3..6 => directions[row - 1][k - 3],
                6 => 0.0,
                7 => 1.0 + 19.0 * uniform(),
                _ => uniform(),
            }
        })
    })
}

fn strategies(criterion: &mut Criterion) {
    const LARGEST: usize = 1 << 20;
    let columns = columns(LARGEST);
    let mut outputs: [Column; 4] = std::array::from_fn(|k| Column::new(columns.len() + k, LARGEST, || 0.0));
    let emitter = Emitter::point_normal(Vec3::ZERO, Vec3::new(0.6, 0.64, -0.48)).expect("a unit normal");
    let medium = Medium::new(0.5, 0.2, 0.6).expect("a medium");
    let (emitters, media) = (Emitters::One(emitter), Media::One(medium));

    for &strategy in Strategy::ALL {
        let sampler = Sampler::new(strategy);
        let mut group = criterion.benchmark_group(strategy.name());
        for n in [1 << 12, 1 << 16, LARGEST] {
            group.throughput(Throughput::Elements(n as u64));
            let column = |k: usize| columns[k].of(n);
            let three = |k: usize| [column(k), column(k + 1), column(k + 2)];
            let rays = Rays { origin: three(0), direction: three(3), t_min: column(6), t_max: column(7) };
            let mut sample = || {
                let [t, pdf, weight, r] = outputs.each_mut().map(|column| column.of_mut(n));
                let mut samples = Samples { t, pdf, weight: Some(weight), r: Some(r) };
                sampler.sample(black_box(&rays), &emitters, &media, column(8), &mut samples)
            };
            for (name, threads) in [("one", 1), ("all", 0)] {
                let pool = Pool::new(threads);
                group.bench_function(BenchmarkId::new(name, n), |bencher| {
                    bencher.iter_custom(|times| {
                        pool.install(|| {
                            let start = Instant::now();
                            for _ in 0..times {
                                black_box(sample()).expect("columns of one length");
                            }
                            start.elapsed()
                        })
                    });
                });
            }
        }
    }
}

/// Some threads to work on; 0 are as many as there are cores.
#[cfg(feature = "rayon")]
struct Pool(rayon::ThreadPool);

#[cfg(feature = "rayon")]
impl Pool {
    fn new(threads: usize) -> Self {
        Self(rayon::ThreadPoolBuilder::new().num_threads(threads).build().expect("a thread pool"))
    }

    fn install<R: Send>(&self, work: impl FnOnce() -> R + Send) -> R {
        self.0.install(work)
    }
}

/// The caller's thread, whatever is asked for.
#[cfg(not(feature = "rayon"))]
struct Pool;

#[cfg(not(feature = "rayon"))]
impl Pool {
    fn new(_: usize) -> Self {
        Self
    }

    fn install<R>(&self, work: impl FnOnce() -> R) -> R {
        work()
    }
}

criterion_group! {
    name = benches;
    config = Criterion::default().warm_up_time(Duration::from_millis(500)).measurement_time(Duration::from_millis(1500));
    targets = strategies
}
criterion_main!(benches);
