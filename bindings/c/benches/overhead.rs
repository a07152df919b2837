//! What a call through the ABI takes beside the same call from Rust, on the calling thread: ratios of medians, in turns.

use airlight::{Emitter, Emitters, Media, Medium, Ray, Rays, Sampler, Samples, Strategy, Threads};
use airlight_c::*;
use core::hint::black_box;
use core::ptr::null_mut;
use std::time::{Duration, Instant};

const RAYS: usize = 65_536;
/// Rays of calls for one ray.
const ONES: usize = 1000;
const ROUNDS: usize = 61;

/// A ray of a queue, with its sample.
#[repr(C)]
#[derive(Clone, Copy, Default)]
struct Item {
    origin: [f32; 3],
    direction: [f32; 3],
    t_max: f32,
    u: f32,
    t: f32,
    pdf: f32,
    weight: f32,
    pixel: u32,
}

fn main() {
    fastrand::seed(1);
    let mut queue = vec![Item::default(); RAYS];
    for item in &mut queue {
        let z = fastrand::f32() * 2.0 - 1.0;
        let (s, c) = (fastrand::f32() * core::f32::consts::TAU).sin_cos();
        let radius = (1.0 - z * z).sqrt();
        item.direction = [radius * c, radius * s, z];
        item.origin = [0; 3].map(|_| fastrand::f32() * 4.0 - 2.0);
        (item.t_max, item.u) = (1.0 + 4.0 * fastrand::f32(), fastrand::f32());
    }
    let column = |of: fn(&Item) -> f32| queue.iter().map(of).collect::<Vec<f32>>();
    let origin = [column(|i| i.origin[0]), column(|i| i.origin[1]), column(|i| i.origin[2])];
    let direction = [column(|i| i.direction[0]), column(|i| i.direction[1]), column(|i| i.direction[2])];
    let (t_min, t_max, u) = (vec![0.0; RAYS], column(|i| i.t_max), column(|i| i.u));
    let [mut t, mut pdf, mut weight] = [vec![0.0; RAYS], vec![0.0; RAYS], vec![0.0; RAYS]];

    let lamp = airlight_emitter {
        kind: 1,
        position: [0.5, 1.0, 0.5],
        direction: [0.0, -1.0, 0.0],
        cos_outer: 0.0,
        cos_inner: 0.0,
    };
    let fog = airlight_medium { channels: 1, mu_a: [0.05; 4], mu_s: [0.3; 4], g: 0.6 };
    let lamp_of_rust = Emitter::point_normal(lamp.position, lamp.direction).unwrap();
    let fog_of_rust = Medium::new(0.05, 0.3, 0.6).unwrap();
    let emitters = airlight_emitters { table: &lamp, table_count: 1, ..Default::default() };
    let media = airlight_media { table: &fog, table_count: 1, ..Default::default() };

    for (number, &strategy) in (1..).zip(Strategy::ALL) {
        let sampler = Sampler::new(strategy).with_threads(Threads::Caller);
        let options = airlight_options { strategy: number, threads: 1, ..Default::default() };
        let rust = |t: &mut [f32], pdf: &mut [f32], weight: &mut [f32]| {
            let rays =
                Rays::new(origin.each_ref().map(|c| &c[..]), direction.each_ref().map(|c| &c[..]), &t_min, &t_max);
            let (lamp, fog) = (Emitters::one(lamp_of_rust), Media::one(fog_of_rust));
            sampler.sample(&rays, &lamp, &fog, &u, &mut Samples::new(t, pdf).weight(weight)).unwrap();
        };
        let packed = |t: &mut [f32], pdf: &mut [f32], weight: &mut [f32]| {
            let batch = airlight_batch {
                origin: origin.each_ref().map(|c| airlight_column { data: c.as_ptr(), stride: 0 }),
                direction: direction.each_ref().map(|c| airlight_column { data: c.as_ptr(), stride: 0 }),
                t_min: airlight_column { data: t_min.as_ptr(), stride: 0 },
                t_max: airlight_column { data: t_max.as_ptr(), stride: 0 },
                count: RAYS,
                emitters: &emitters,
                media: &media,
                ..Default::default()
            };
            let mut samples = airlight_samples { per_ray: 1, ..Default::default() };
            samples.u = airlight_column { data: u.as_ptr(), stride: 0 };
            samples.t.data = t.as_mut_ptr();
            samples.pdf.data = pdf.as_mut_ptr();
            samples.weight[0].data = weight.as_mut_ptr();
            call(&options, &batch, &samples);
        };
        let strided = |queue: &mut [Item]| {
            let stride = size_of::<Item>();
            let first = queue.as_mut_ptr().cast::<f32>();
            let input = |i: usize| airlight_column { data: first.wrapping_add(i), stride };
            let output = |i: usize| airlight_output { data: first.wrapping_add(i), stride };
            let batch = airlight_batch {
                origin: [input(0), input(1), input(2)],
                direction: [input(3), input(4), input(5)],
                t_max: input(6),
                count: RAYS,
                emitters: &emitters,
                media: &media,
                ..Default::default()
            };
            let mut samples = airlight_samples { per_ray: 1, ..Default::default() };
            samples.u = input(7);
            (samples.t, samples.pdf, samples.weight[0]) = (output(8), output(9), output(10));
            call(&options, &batch, &samples);
        };
        let one = |of_rust: bool| {
            for i in 0..ONES {
                let at = |columns: &[Vec<f32>; 3]| columns.each_ref().map(|column| column[i]);
                if of_rust {
                    let ray = Ray::new(at(&origin), at(&direction), 0.0, t_max[i]).unwrap();
                    black_box(sampler.sample_one(&ray, &lamp_of_rust, &fog_of_rust, u[i]));
                } else {
                    let ray =
                        airlight_ray { origin: at(&origin), direction: at(&direction), t_min: 0.0, t_max: t_max[i] };
                    let scene = airlight_scene { ray, emitter: lamp, medium: fog, ..Default::default() };
                    let mut sample = airlight_one_sample::default();
                    // SAFETY: pointers to what they are said to be.
                    unsafe { airlight_sample_one(&options, &scene, u[i], &mut sample) };
                    black_box(sample);
                }
            }
        };
        let mut times = [const { Vec::new() }; 5];
        let mut queue = queue.clone();
        for _ in 0..ROUNDS {
            times[0].push(time(|| rust(&mut t, &mut pdf, &mut weight)));
            times[1].push(time(|| packed(&mut t, &mut pdf, &mut weight)));
            times[2].push(time(|| strided(&mut queue)));
            times[3].push(time(|| one(true)));
            times[4].push(time(|| one(false)));
        }
        assert!(queue.iter().zip(&weight).all(|(item, weight)| item.weight == *weight));
        let [rust, packed, strided, one, one_in_c] = times.map(|times| median(times).as_secs_f64() * 1e9);
        println!(
            "{:22} Rust {:5.1} ns/ray, packed x {:.3}, strided x {:.3}; one ray: Rust {:4.0} ns, C {:4.0} ns",
            strategy.name(),
            rust / RAYS as f64,
            packed / rust,
            strided / rust,
            one / ONES as f64,
            one_in_c / ONES as f64
        );
    }
}

fn call(options: &airlight_options, batch: &airlight_batch, samples: &airlight_samples) {
    // SAFETY: the columns have as many floats as the batch has rays.
    let status = unsafe { airlight_sample(options, batch, samples, null_mut()) };
    assert_eq!(status, airlight_status::Ok);
}

fn time(work: impl FnOnce()) -> Duration {
    let start = Instant::now();
    work();
    start.elapsed()
}

fn median(mut times: Vec<Duration>) -> Duration {
    times.sort_unstable();
    times[times.len() / 2]
}
