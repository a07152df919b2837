//! What does an emitter per ray cost: as columns, as a table of 32 with an index, and as columns that are filled first?
//!
//! One thread, the fastest backend, one medium for the batch; written are `t` and `pdf`.

use airlight::{Emitter, Emitters, Sampler, Samples, Strategy};
use airlight_tools::threads;
use airlight_tools::workload::{Call, Wanted, Workload};
use criterion::{Criterion, Throughput, criterion_group, criterion_main};

const RAYS: usize = 1 << 16;
const EMITTERS: u32 = 32;

/// Positions and normals, x, y, z each.
type Columns = [Vec<f32>; 6];

fn fill(columns: &mut Columns, table: &[Emitter], index: &[u32]) {
    for (ray, &index) in index.iter().enumerate() {
        let emitter = table[index as usize];
        let row = emitter.position().into_iter().chain(emitter.normal().unwrap_or_default());
        for (column, value) in columns.iter_mut().zip(row) {
            column[ray] = value;
        }
    }
}

fn each([px, py, pz, nx, ny, nz]: &Columns) -> Emitters<'_> {
    Emitters::each([px, py, pz], [nx, ny, nz])
}

fn emitters(criterion: &mut Criterion) {
    let one = threads::pool(1).expect("a thread");
    // Multiples of irrational numbers lie evenly in the box, and a hash picks any emitter for a ray.
    let emitter = |i: u32| {
        let position = [0.618, 0.755, 0.57].map(|step: f32| (step * i as f32).fract() * 10.0 - 5.0);
        Emitter::point_normal(position, [0.6, 0.64, -0.48]).expect("a unit normal")
    };
    let table: Vec<Emitter> = (0..EMITTERS).map(emitter).collect();
    let index: Vec<u32> = (0..RAYS as u32).map(|i| i.wrapping_mul(0x9e37_79b9) % EMITTERS).collect();
    let mut columns: Columns = std::array::from_fn(|_| vec![0.0; RAYS]);
    fill(&mut columns, &table, &index);

    let mut workload = Workload::new(RAYS);
    let Call { rays, media, u, samples: Samples { t, pdf, .. }, .. } = workload.call(RAYS, 1, Wanted::Densities);
    for strategy in [Strategy::EquiAngular, Strategy::Product5] {
        let sampler = Sampler::new(strategy);
        let mut sample = |emitters: Emitters<'_>| {
            sampler.sample(&rays, &emitters, &media, u, &mut Samples::new(t, pdf)).expect("columns of one length")
        };
        let mut group = criterion.benchmark_group(strategy.name());
        group.throughput(Throughput::Elements(RAYS as u64));
        group.bench_function("columns", |bencher| {
            bencher.iter_custom(|times| threads::time(&one, times, || sample(each(&columns))));
        });
        group.bench_function("table", |bencher| {
            bencher.iter_custom(|times| threads::time(&one, times, || sample(Emitters::table(&table, &index))));
        });
        group.bench_function("filled", |bencher| {
            bencher.iter_custom(|times| {
                threads::time(&one, times, || {
                    fill(&mut columns, &table, &index);
                    sample(each(&columns))
                })
            });
        });
    }
}

criterion_group!(benches, emitters);
criterion_main!(benches);
