//! What does each instruction set make of each strategy?
//!
//! One thread, batches that a core's cache holds; `scalar` is there to be compared with.

use airlight::{Backend, Sampler, Strategy};
use airlight_tools::threads;
use airlight_tools::workload::{Wanted, Workload};
use criterion::{BenchmarkId, Criterion, Throughput, criterion_group, criterion_main};

const RAYS: usize = 1 << 12;

fn backends(criterion: &mut Criterion) {
    let one = threads::pool(1).expect("a thread");
    let mut workload = Workload::new(RAYS);
    for &strategy in Strategy::ALL {
        let mut group = criterion.benchmark_group(strategy.name());
        group.throughput(Throughput::Elements(RAYS as u64));
        for backend in Backend::available() {
            let call = &mut workload.call(RAYS, 1, Wanted::Densities);
            let sampler = Sampler::new(strategy).with_backend(backend);
            let mut sample = || call.sample(&sampler).expect("columns of one length");
            let id = BenchmarkId::from_parameter(backend.name());
            group.bench_function(id, |bencher| {
                bencher.iter_custom(|times| threads::time(&one, times, &mut sample));
            });
        }
    }
}

criterion_group!(benches, backends);
criterion_main!(benches);
