//! Structs for the calls of the C ABI that hold anything, as long as their pointers are to memory.

#![allow(unreachable_pub, reason = "of a test, and of the fuzz targets")]

use airlight_c::*;
use core::mem::{size_of, zeroed};

/// Bytes before and after the memory, which nobody may write.
const FENCE: usize = 1024;
/// What they hold.
const UNTOUCHED: u8 = 0xaa;

/// Who decides.
pub trait Dice {
    /// One of `0, ..., n - 1`.
    fn below(&mut self, n: u64) -> u64;
}

/// Calls with structs by decisions, on one piece of memory.
pub struct Structs<D> {
    dice: D,
    memory: Vec<u8>,
}

impl<D: Dice> Structs<D> {
    /// Any decisions, and memory of so many floats.
    pub fn new(dice: D, floats: usize) -> Self {
        let mut structs = Self { dice, memory: vec![UNTOUCHED; floats * 4 + 2 * FENCE] };
        structs.fill();
        structs
    }

    /// Fills the memory with other numbers.
    pub fn fill(&mut self) {
        let mut state = self.dice.below(1 << 32);
        let middle = FENCE..self.memory.len() - FENCE;
        for chunk in self.memory[middle].chunks_exact_mut(4) {
            state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            let bits = (state >> 32) as u32;
            let number = match state >> 28 & 7 {
                0 => bits,
                1 => bits >> 30,
                _ => ((bits >> 8) as f32 / 16_777_216.0).to_bits(),
            };
            chunk.copy_from_slice(&number.to_ne_bytes());
        }
    }

    fn among<T: Copy>(&mut self, likely: &[T]) -> T {
        likely[self.dice.below(likely.len() as u64) as usize]
    }

    /// One of `least..=most`.
    fn within(&mut self, least: usize, most: usize) -> usize {
        least + self.dice.below((most - least) as u64 + 1) as usize
    }

    fn even(&mut self) -> bool {
        self.dice.below(2) == 0
    }

    fn number(&mut self, likely: &[usize]) -> usize {
        match self.dice.below(512) {
            0 => usize::MAX >> self.dice.below(64),
            1 | 2 => self.within(0, 8),
            _ => self.among(likely),
        }
    }

    fn uniform(&mut self) -> f32 {
        self.dice.below(1 << 24) as f32 / 16_777_216.0
    }

    fn float(&mut self) -> f32 {
        match self.dice.below(256) {
            0 => f32::from_bits(self.dice.below(1 << 32) as u32),
            1 => self.among(&[0.0, 1.0, -1.0, f32::NAN, f32::INFINITY]),
            _ => self.uniform(),
        }
    }

    /// A column of so many bytes an element, or NULL; only a count that does not fit may lead out of the memory, and then
    /// the call is refused.
    fn column(&mut self, count: usize, element: usize) -> (*mut u8, usize) {
        if self.dice.below(400) == 0 {
            return (core::ptr::null_mut(), self.number(&[0, 4]));
        }
        let bytes = self.memory.len() - 2 * FENCE;
        let most = (bytes / 2).checked_div(count).unwrap_or(64).max(element);
        let stride = match self.dice.below(64) {
            0..32 => 0,
            32 => self.within(0, 7).min(most),
            // Up to 60 bytes between elements.
            _ => self.within(element, most.min(element.saturating_add(60))),
        };
        let step = stride.max(element);
        let length = count.saturating_mul(step);
        // What is too long for the memory must be too long for any.
        if length > bytes && length <= isize::MAX as usize {
            return (core::ptr::null_mut(), 0);
        }
        let room = bytes.saturating_sub(length);
        let offset = if self.even() { self.within(0, room / 4) * 4 } else { self.within(0, room) };
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
        if likely == 1 && self.even() { 0 } else { self.number(&[likely]) as u32 }
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
    ///
    /// # Panics
    /// If the call panics, or writes outside of the memory.
    pub fn call(&mut self) -> airlight_status {
        let status = self.any_call();
        assert_ne!(status, airlight_status::Panic, "a call panics");
        let (fences, end) = (&self.memory, self.memory.len());
        let untouched = |range: core::ops::Range<usize>| fences[range].iter().all(|&byte| byte == UNTOUCHED);
        assert!(untouched(0..FENCE) && untouched(end - FENCE..end), "a call writes outside of the memory");
        status
    }

    fn any_call(&mut self) -> airlight_status {
        let count = self.number(&[1, 2, 7, 16, 33, 300]);
        let per_ray = self.number(&[1, 1, 1, 2, 5]);
        let channels = self.among(&[1, 1, 3, 4]);
        let numbers = [(); 2].map(|()| self.dice.below(1 << 16) as u32);
        let entry = self.dice.below(12);
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
            if self.even() {
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
        let output = |structs: &mut Self, width| structs.output(count, width);
        // A density has one value.
        let value_channels = if matches!(entry, 2 | 5) { 1 } else { channels };
        let values = airlight_values {
            struct_size: self.size::<airlight_values>(),
            per_ray,
            t: self.input(count, per_ray),
            // `airlight_radiance` has one, whatever `per_ray` says.
            value: self.outputs(value_channels, count, per_ray.max(1)),
        };
        // SAFETY: columns lie within the memory or are too long for any, tables are as long as said.
        unsafe {
            match entry {
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
                5 => airlight_cdf(&options, &batch, &values, &mut counts),
                6..=10 => {
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
                    let (number, mut values) = (self.float(), [0.0; 4]);
                    let value = if self.dice.below(400) == 0 { core::ptr::null_mut() } else { values.as_mut_ptr() };
                    match entry {
                        6 => airlight_sample_one(&options, &scene, number, &mut sample),
                        7 => airlight_pdf_one(&options, &scene, number, value),
                        8 => airlight_cdf_one(&options, &scene, number, value),
                        9 => airlight_evaluate_one(&options, &scene, number, value),
                        _ => airlight_radiance_one(&options, &scene, value),
                    }
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
