//! What do colours and spots cost: a grey medium, 3 and 4 channels, and a spot, all with weights?
//!
//! One thread, the fastest backend, one emitter and one medium for the batch.

use airlight::{Emitter, Emitters, Media, Medium, Sampler, Samples, Strategy};
use airlight_tools::threads;
use airlight_tools::workload::{Call, Wanted, Workload};
use criterion::{Criterion, Throughput, criterion_group, criterion_main};

const RAYS: usize = 1 << 16;

fn colour(criterion: &mut Criterion) {
    let one = threads::pool(1).expect("a thread");
    let lamp = Emitter::point_normal([0.0; 3], [0.6, 0.64, -0.48]).expect("a unit normal");
    let spot = Emitter::spot([0.0; 3], [0.6, 0.64, -0.48], 0.5, 0.7).expect("a spot");
    let grey = Medium::new(0.5, 0.2, 0.9).expect("a medium");
    let three = Medium::coloured([0.35, 0.5, 0.7], [0.14, 0.2, 0.28], 0.9).expect("a medium");
    let four = Medium::coloured([0.35, 0.5, 0.6, 0.7], [0.14, 0.2, 0.24, 0.28], 0.9).expect("a medium");

    let mut workload = Workload::new(RAYS);
    let Call { rays, u, samples: Samples { t, pdf, .. }, .. } = workload.call(RAYS, 1, Wanted::Densities);
    let [mut w0, mut w1, mut w2, mut w3] = [(); 4].map(|()| vec![0.0f32; RAYS]);
    for strategy in [Strategy::EquiAngular, Strategy::Product5, Strategy::Product9] {
        let sampler = Sampler::new(strategy);
        let mut group = criterion.benchmark_group(strategy.name());
        group.throughput(Throughput::Elements(RAYS as u64));
        for (name, emitter, medium) in
            [("grey", lamp, grey), ("3 channels", lamp, three), ("4 channels", lamp, four), ("spot", spot, grey)]
        {
            let (emitters, media) = (Emitters::one(emitter), Media::one(medium));
            let mut sample = || {
                let samples = Samples::new(t, pdf);
                let mut samples = match medium.channels() {
                    3 => samples.weights([&mut w0, &mut w1, &mut w2]),
                    4 => samples.weights([&mut w0, &mut w1, &mut w2, &mut w3]),
                    _ => samples.weight(&mut w0),
                };
                sampler.sample(&rays, &emitters, &media, u, &mut samples).expect("columns of one length")
            };
            group.bench_function(name, |bencher| bencher.iter_custom(|times| threads::time(&one, times, &mut sample)));
        }
    }
}

criterion_group!(benches, colour);
criterion_main!(benches);
