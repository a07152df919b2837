//! No call crashes or writes where it must not, whatever its structs hold, as long as its pointers are to memory.
//!
//!     AIRLIGHT_FUZZ=1000000 AIRLIGHT_SEED=7 cargo test --release --test fuzz      so many calls, of that seed

mod host;

use airlight_c::*;
use core::mem::{size_of, zeroed};
use host::message;

/// Floats of the memory that columns lie in.
const FLOATS: usize = 1 << 16;

/// Bytes before and after it, which nobody may write.
const FENCE: usize = 4096;

struct Fuzz {
    rng: fastrand::Rng,
    memory: Vec<u8>,
}

impl Fuzz {
    fn number(&mut self, likely: &[usize]) -> usize {
        match self.rng.u32(0..512) {
            0 => usize::MAX >> self.rng.u32(0..64),
            1 | 2 => self.rng.usize(0..9),
            _ => likely[self.rng.usize(..likely.len())],
        }
    }

    fn float(&mut self) -> f32 {
        match self.rng.u32(0..256) {
            0 => f32::from_bits(self.rng.u32(..)),
            1 => [0.0, 1.0, -1.0, f32::NAN, f32::INFINITY][self.rng.usize(0..5)],
            _ => self.rng.f32(),
        }
    }

    /// A column of so many bytes an element, or NULL; only a count that does not fit may lead out of the memory, and then
    /// the call is refused.
    fn column(&mut self, count: usize, element: usize) -> (*mut u8, usize) {
        if self.rng.u32(0..400) == 0 {
            return (core::ptr::null_mut(), self.number(&[0, 4]));
        }
        let bytes = FLOATS * 4;
        let most = (bytes / 2).checked_div(count).unwrap_or(64).max(element);
        let stride = match self.rng.u32(0..64) {
            0..32 => 0,
            32 => self.rng.usize(0..8).min(most),
            _ => self.rng.usize(element.min(most)..=most.min(element + 60).max(element.min(most))),
        };
        let step = stride.max(element);
        let length = count.saturating_mul(step);
        // What is too long for the memory must be too long for any.
        if length > bytes && length <= isize::MAX as usize {
            return (core::ptr::null_mut(), 0);
        }
        let room = bytes.saturating_sub(length);
        let offset = if self.rng.bool() { self.rng.usize(0..=room / 4) * 4 } else { self.rng.usize(0..=room) };
        (self.memory.as_mut_ptr().wrapping_add(FENCE + offset), stride)
    }

    fn input(&mut self, count: usize, width: usize) -> airlight_column {
        let (data, stride) = self.column(count, width.saturating_mul(4));
        airlight_column { data: data.cast(), stride }
    }

    fn output(&mut self, count: usize, width: usize) -> airlight_output {
        let (data, stride) = self.column(count, width.saturating_mul(4));
        airlight_output { data: data.cast(), stride }
    }

    fn indices(&mut self, count: usize) -> airlight_index_column {
        let (data, stride) = self.column(count, 4);
        airlight_index_column { data: data.cast(), stride }
    }

    /// So many channels, or rarely others.
    fn channels(&mut self, likely: usize) -> u32 {
        if likely == 1 && self.rng.bool() { 0 } else { self.number(&[likely]) as u32 }
    }

    /// Columns of so many channels, or rarely of others.
    fn outputs(&mut self, channels: usize, count: usize, width: usize) -> [airlight_output; 4] {
        let channels = self.channels(channels).max(1) as usize;
        // SAFETY: any bits are a value of the struct.
        let mut columns: [airlight_output; 4] = unsafe { zeroed() };
        columns.iter_mut().take(channels).for_each(|column| *column = self.output(count, width));
        columns
    }

    fn size<T>(&mut self) -> usize {
        self.number(&[size_of::<T>()])
    }

    /// Makes a call, and says what came of it.
    fn call(&mut self) -> airlight_status {
        let count = self.number(&[1, 2, 7, 16, 33, 300]);
        let per_ray = self.number(&[1, 1, 1, 2, 5]);
        let channels = [1, 1, 3, 4][self.rng.usize(0..4)];
        let numbers: Vec<u32> = (0..4).map(|_| self.rng.u32(..)).collect();
        let options = airlight_options {
            struct_size: self.size::<airlight_options>(),
            strategy: self.number(&[0, 1, 2, 3, 4, 5, 6, 7, 8, 9]) as u32,
            precision: self.number(&[0, 0, 0, 0, 0, 0, 0, 1]) as u32,
            nodes: self.number(&[0, 4, 6, 8, 12]) as u32,
            backend: self.number(&[0, 0, 1, 2]) as u32,
            threads: self.number(&[0, 1, 2]) as u32,
        };
        let mut emitter_table = [const {
            airlight_emitter { kind: 0, position: [0.0; 3], direction: [0.0; 3], cos_outer: 0.0, cos_inner: 0.0 }
        }; 3];
        let mut medium_table = [const { airlight_medium { channels: 0, mu_a: [0.0; 4], mu_s: [0.0; 4], g: 0.0 } }; 3];
        for i in 0..3 {
            emitter_table[i] = airlight_emitter {
                kind: self.number(&[0, 0, 1, 2]) as u32,
                position: [0; 3].map(|_| self.float()),
                direction: [0.0, 0.0, 1.0],
                cos_outer: self.float() * 0.5,
                cos_inner: self.float() * 0.5 + 0.5,
            };
            let (mu_a, mu_s) = ([0; 4].map(|_| self.float()), [0; 4].map(|_| self.float()));
            medium_table[i] = airlight_medium { channels: self.channels(channels), mu_a, mu_s, g: self.float() };
        }
        // SAFETY: any bits are a value of the structs.
        let (mut emitters, mut media): (airlight_emitters, airlight_media) = unsafe { (zeroed(), zeroed()) };
        emitters.struct_size = self.size::<airlight_emitters>();
        media.struct_size = self.size::<airlight_media>();
        if !numbers[0].is_multiple_of(3) {
            (emitters.table, emitters.table_count) = (emitter_table.as_ptr(), (numbers[0] / 3 % 32).min(3) as usize);
            (emitters.index, media.index) = (self.indices(count), self.indices(count));
        } else {
            emitters.position = [0; 3].map(|_| self.input(count, 1));
            emitters.direction = [0; 3].map(|_| self.input(count, 1));
            if self.rng.bool() {
                (emitters.cos_outer, emitters.cos_inner) = (self.input(count, 1), self.input(count, 1));
            }
        }
        if !numbers[1].is_multiple_of(3) {
            (media.table, media.table_count) = (medium_table.as_ptr(), (numbers[1] / 3 % 32).min(3) as usize);
        } else {
            media.channels = self.channels(channels);
            for c in 0..self.channels(channels).min(4) as usize {
                (media.mu_a[c], media.mu_s[c]) = (self.input(count, 1), self.input(count, 1));
            }
            media.g = self.input(count, 1);
            media.index.data = core::ptr::null();
        }
        let batch = airlight_batch {
            struct_size: self.size::<airlight_batch>(),
            count,
            origin: [0; 3].map(|_| self.input(count, 1)),
            direction: [0; 3].map(|_| self.input(count, 1)),
            t_min: self.input(count, 1),
            t_max: self.input(count, 1),
            emitters: &emitters,
            media: &media,
        };
        // SAFETY: any bits are a value of the struct.
        let mut counts = airlight_counts { struct_size: self.size::<airlight_counts>(), ..unsafe { zeroed() } };
        let output = |fuzz: &mut Self, width| fuzz.output(count, width);
        // A density has one value.
        let value_channels = if numbers[2] % 7 == 2 { 1 } else { channels };
        let values = airlight_values {
            struct_size: self.size::<airlight_values>(),
            per_ray,
            t: self.input(count, per_ray),
            // `airlight_radiance` has one, whatever `per_ray` says.
            value: self.outputs(value_channels, count, per_ray.max(1)),
        };
        // SAFETY: columns lie within the memory or are too long for any, tables are as long as said.
        unsafe {
            match numbers[2] % 7 {
                0 | 1 => {
                    let samples = airlight_samples {
                        struct_size: self.size::<airlight_samples>(),
                        per_ray,
                        u: self.input(count, per_ray),
                        t: output(self, per_ray),
                        pdf: output(self, per_ray),
                        weight: self.outputs(channels, count, per_ray),
                        r: output(self, per_ray),
                    };
                    airlight_sample(&options, &batch, &samples, &mut counts)
                }
                2 => airlight_pdf(&options, &batch, &values, &mut counts),
                3 => airlight_evaluate(&options, &batch, &values, &mut counts),
                4 => airlight_radiance(&options, &batch, &values, &mut counts),
                5 => {
                    let scene = airlight_scene {
                        struct_size: self.size::<airlight_scene>(),
                        ray: airlight_ray {
                            origin: [0; 3].map(|_| self.float()),
                            direction: [0.0, self.float() * 0.01, 1.0],
                            t_min: self.float() * 0.1,
                            t_max: self.float() + 1.0,
                        },
                        emitter: emitter_table[0],
                        medium: medium_table[0],
                    };
                    let mut sample =
                        airlight_one_sample { struct_size: self.size::<airlight_one_sample>(), ..Default::default() };
                    airlight_sample_one(&options, &scene, self.float(), &mut sample)
                }
                _ => {
                    emitters.index.data = core::ptr::null();
                    let index = self.column(count, 4);
                    let choices = airlight_choices {
                        struct_size: self.size::<airlight_choices>(),
                        u: self.input(count, 1),
                        weights: self.input(emitters.table_count, 1),
                        index: airlight_index_output { data: index.0.cast(), stride: index.1 },
                        probability: output(self, 1),
                    };
                    let batch = airlight_batch { emitters: &emitters, ..batch };
                    airlight_choose(&options, &batch, &choices, &mut counts)
                }
            }
        }
    }
}

#[test]
fn any_structs_give_a_status() {
    let number = |name| std::env::var(name).ok().map(|text| text.parse::<u64>().unwrap());
    let seed = number("AIRLIGHT_SEED").unwrap_or_else(|| fastrand::u64(..));
    let calls = number("AIRLIGHT_FUZZ").unwrap_or(100_000);
    println!("AIRLIGHT_SEED={seed} AIRLIGHT_FUZZ={calls}");
    let mut fuzz = Fuzz { rng: fastrand::Rng::with_seed(seed), memory: vec![0xaa; FLOATS * 4 + 2 * FENCE] };
    let mut found = [0_u64; 11];
    for i in 0..calls {
        if i % 256 == 0 {
            let middle = FENCE..FENCE + FLOATS * 4;
            for chunk in fuzz.memory[middle].chunks_exact_mut(4) {
                let number = match fuzz.rng.u32(0..8) {
                    0 => fuzz.rng.u32(..),
                    1 => fuzz.rng.u32(0..4),
                    _ => fuzz.rng.f32().to_bits(),
                };
                chunk.copy_from_slice(&number.to_ne_bytes());
            }
        }
        let status = fuzz.call();
        assert_ne!(status, airlight_status::Panic, "call {i} of seed {seed}: {}", message());
        found[status as usize] += 1;
        let fences = [0..FENCE, FENCE + FLOATS * 4..fuzz.memory.len()];
        let written = fences.into_iter().flatten().find(|&at| fuzz.memory[at] != 0xaa);
        assert_eq!(written, None, "call {i} of seed {seed} wrote outside of the memory");
    }
    println!("statuses: {found:?}");
    let common = [
        airlight_status::Ok,
        airlight_status::Null,
        airlight_status::StructSize,
        airlight_status::Overlap,
        airlight_status::Channels,
    ];
    assert!(common.iter().all(|&status| found[status as usize] > calls / 1000), "{found:?} of seed {seed}");
}
