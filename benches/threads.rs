//! How much faster are more threads, on batches that only memory holds?
//!
//! The fastest backend; powers of two up to one thread per core.

use airlight::{Sampler, Strategy};
use airlight_tools::threads::{one_and_all, pool, time};
use airlight_tools::workload::{Wanted, Workload};
use criterion::{BenchmarkId, Criterion, Throughput, criterion_group, criterion_main};
use std::iter::successors;

const RAYS: usize = 1 << 22;

fn threads(criterion: &mut Criterion) {
    let all = one_and_all().into_iter().max().unwrap_or(1);
    let counts = successors(Some(1), |count| Some(2 * count)).take_while(|&count| count < all).chain([all]);
    let pools: Vec<_> = counts.map(|count| pool(count).expect("threads")).collect();
    let mut workload = Workload::new(RAYS);
    for &strategy in Strategy::ALL {
        let mut group = criterion.benchmark_group(strategy.name());
        group.throughput(Throughput::Elements(RAYS as u64)).sample_size(10);
        for pool in &pools {
            let call = &mut workload.call(RAYS, 1, Wanted::Densities);
            let sampler = Sampler::new(strategy);
            let mut sample = || call.sample(&sampler).expect("columns of one length");
            let id = BenchmarkId::from_parameter(pool.current_num_threads());
            group.bench_function(id, |bencher| {
                bencher.iter_custom(|times| time(pool, times, &mut sample));
            });
        }
    }
}

criterion_group!(benches, threads);
criterion_main!(benches);
