//! What does a sample of each strategy cost, on batches that a core's cache holds and on larger ones?
//!
//! One thread, the fastest backend, one emitter and one medium for the batch; written are `t` and `pdf`.
//!
//! To compare with how it was before a change, on some strategies or all:
//!
//! ```text
//! cargo bench --bench strategies -- --save-baseline before taylor
//! cargo bench --bench strategies -- --baseline before taylor
//! ```

use airlight::{Sampler, Strategy};
use airlight_tools::threads;
use airlight_tools::workload::{Wanted, Workload};
use criterion::{BenchmarkId, Criterion, Throughput, criterion_group, criterion_main};

const SIZES: [usize; 3] = [1 << 12, 1 << 16, 1 << 20];

fn strategies(criterion: &mut Criterion) {
    let one = threads::pool(1).expect("a thread");
    let mut workload = Workload::new(SIZES[2]);
    for &strategy in Strategy::ALL {
        let mut group = criterion.benchmark_group(strategy.name());
        for rays in SIZES {
            group.throughput(Throughput::Elements(rays as u64));
            let call = &mut workload.call(rays, 1, Wanted::Densities);
            let sampler = Sampler::new(strategy);
            let mut sample = || call.sample(&sampler).expect("columns of one length");
            group.bench_function(BenchmarkId::from_parameter(rays), |bencher| {
                bencher.iter_custom(|times| threads::time(&one, times, &mut sample));
            });
        }
    }
}

criterion_group!(benches, strategies);
criterion_main!(benches);
