//! What does a choice among 32 emitters cost, for each of them? And among 256, which share slots; and the integral alone.
//!
//! One thread, the fastest backend, one medium for the batch. Rates are of rays times emitters.

use airlight::{Emitter, Emitters, Integral, Nodes, Precision};
use airlight_tools::threads;
use airlight_tools::workload::{Call, Wanted, Workload};
use criterion::{Criterion, Throughput, criterion_group, criterion_main};

const RAYS: usize = 1 << 14;

fn choose(criterion: &mut Criterion) {
    let one = threads::pool(1).expect("a thread");
    // Multiples of irrational numbers lie evenly in the box.
    let emitter = |i: u32| {
        let position = [0.618, 0.755, 0.57].map(|step: f32| (step * i as f32).fract() * 10.0 - 5.0);
        Emitter::point_normal(position, [0.6, 0.64, -0.48]).expect("a unit normal")
    };
    let table: Vec<Emitter> = (0..256).map(emitter).collect();
    let weights = vec![1.0; table.len()];
    let (mut index, mut probability) = (vec![0; RAYS], vec![0.0; RAYS]);
    let mut workload = Workload::new(RAYS);
    let Call { rays, media, u, .. } = workload.call(RAYS, 1, Wanted::Densities);
    for &precision in Precision::ALL {
        let integral = Integral::new(Nodes::Four).with_precision(precision);
        let mut group = criterion.benchmark_group(precision.name());
        for emitters in [32, 256] {
            group.throughput(Throughput::Elements((RAYS * emitters) as u64));
            let (table, weights) = (&table[..emitters], &weights[..emitters]);
            group.bench_function(format!("choose-{emitters}"), |bencher| {
                bencher.iter_custom(|times| {
                    threads::time(&one, times, || {
                        let out = (&mut index, &mut probability);
                        integral.choose(&rays, table, weights, &media, u, out.0, out.1).expect("columns of one length")
                    })
                });
            });
        }
        group.throughput(Throughput::Elements(RAYS as u64));
        group.bench_function("radiance", |bencher| {
            bencher.iter_custom(|times| {
                threads::time(&one, times, || {
                    let emitter = Emitters::one(table[0]);
                    integral.radiance(&rays, &emitter, &media, &mut probability).expect("columns of one length")
                })
            });
        });
    }
}

criterion_group!(benches, choose);
criterion_main!(benches);
