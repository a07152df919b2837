//! Times `Sampler::sample` on the rays of `speed.py`, in columns that are there and in new ones.

use airlight::{Emitter, Emitters, Media, Medium, Rays, Sampler, Samples, Strategy, Threads};
use std::array::from_fn;
use std::hint::black_box;
use std::time::Instant;

fn main() -> Result<(), airlight::Error> {
    let mut arguments = std::env::args().skip(1).map(|argument| argument.parse().expect("rays, threads, rounds"));
    let [rays, threads, rounds]: [usize; 3] = from_fn(|_| arguments.next().expect("rays, threads, rounds"));
    let sampler = Sampler::new(Strategy::Product5).with_threads(Threads::at_most(threads));
    let lamp = Emitters::one(Emitter::point_normal([0.0, 1.0, 3.0], [0.0, -1.0, 0.0])?);
    let fog = Media::one(Medium::new(0.01, 0.1, 0.6)?);

    let u: Vec<f32> = (0..rays).map(|i| (i as f32 + 0.5) / rays as f32).collect();
    let [dx, zero, t_max] = [vec![0.6; rays], vec![0.0; rays], vec![10.0; rays]];
    let dz = vec![0.8; rays];
    let batch = Rays::new([&u, &zero, &zero], [&dx, &zero, &dz], &zero, &t_max);
    let column = || vec![0.0f32; rays];
    let mut kept = [column(), column(), column(), column()];
    let mut call = |new: bool| {
        let clock = Instant::now();
        let mut fresh = new.then(|| [column(), column(), column(), column()]);
        let [t, pdf, weight, r] = fresh.as_mut().unwrap_or(&mut kept);
        let mut samples = Samples::new(t, pdf).weight(weight).r(r);
        black_box(sampler.sample(&batch, &lamp, &fog, &u, &mut samples)?);
        Ok(clock.elapsed().as_secs_f64())
    };
    let mut best = [f64::INFINITY; 2];
    for _ in 0..rounds {
        best = [best[0].min(call(false)?), best[1].min(call(true)?)];
    }
    println!("{} {}", best[0], best[1]);
    Ok(())
}
