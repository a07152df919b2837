//! A malformed call returns a status with a message that names the field, and writes nothing.

mod host;

use airlight_c::airlight_status::*;
use airlight_c::*;
use core::ptr::{null, null_mut};
use host::{Column, PACKED, message};

const RAYS: usize = 8;

/// The first entry of a table for each of them.
static ZEROS: [u32; RAYS] = [0; RAYS];

/// A call that is in order, with structs to spoil.
struct Call {
    options: airlight_options,
    batch: airlight_batch,
    emitters: airlight_emitters,
    media: airlight_media,
    table: [airlight_emitter; 2],
    fog: airlight_medium,
    samples: airlight_samples,
    values: airlight_values,
    choices: airlight_choices,
    counts: airlight_counts,
}

/// The columns that a call reads, and those that it writes.
struct Memory {
    read: [Column; 3],
    written: [Column; 6],
}

#[derive(Clone, Copy, Debug, PartialEq)]
enum Function {
    Sample,
    Pdf,
    Evaluate,
    Radiance,
    Choose,
}

use Function::*;

impl Memory {
    fn new() -> Self {
        let number = |number: f32| Column::of(PACKED, 1, &[number.to_bits(); RAYS * 2]);
        let (read, written) = ([0.0, 1.0, 0.5].map(number), [(); 6].map(|()| Column::new(PACKED, RAYS * 2, 1)));
        Self { read, written }
    }

    fn call(&mut self) -> Call {
        let [zero, one, half] = self.read.each_mut().map(Column::input);
        let [t, pdf, weight, r, value, probability] = self.written.each_mut().map(Column::output);
        let point =
            airlight_emitter { kind: 0, position: [1.0; 3], direction: [0.0; 3], cos_outer: 0.0, cos_inner: 0.0 };
        let mut call = Call {
            options: airlight_options { threads: 1, ..Default::default() },
            batch: airlight_batch {
                count: RAYS,
                origin: [zero; 3],
                direction: [zero, zero, one],
                t_min: zero,
                t_max: one,
                ..Default::default()
            },
            emitters: airlight_emitters { table_count: 1, ..Default::default() },
            media: airlight_media { table_count: 1, ..Default::default() },
            table: [point; 2],
            fog: airlight_medium { channels: 1, mu_a: [0.1; 4], mu_s: [0.1; 4], g: 0.0 },
            samples: airlight_samples { per_ray: 1, u: half, t, pdf, r, ..Default::default() },
            values: airlight_values { per_ray: 1, t: half, ..Default::default() },
            choices: airlight_choices { u: half, weights: one, probability, ..Default::default() },
            counts: Default::default(),
        };
        (call.samples.weight[0], call.values.value[0]) = (weight, value);
        call
    }
}

impl Call {
    /// Makes the call, with pointers that are NULL filled in as far as `fill` says so.
    fn make(&mut self, function: Function, fill: bool) -> airlight_status {
        if fill {
            self.emitters.table = self.table.as_ptr();
            self.media.table = &self.fog;
            self.batch.emitters = &self.emitters;
            self.batch.media = &self.media;
        }
        let (options, batch, counts) = (&self.options, &self.batch, &mut self.counts);
        // SAFETY: pointers are NULL or to what they are said to be, and columns have room for twice as many rays.
        unsafe {
            match function {
                Sample => airlight_sample(options, batch, &self.samples, counts),
                Pdf => airlight_pdf(options, batch, &self.values, counts),
                Evaluate => airlight_evaluate(options, batch, &self.values, counts),
                Radiance => airlight_radiance(options, batch, &self.values, counts),
                Choose => airlight_choose(options, batch, &self.choices, counts),
            }
        }
    }
}

/// Spoils a call and says what comes of it.
fn refuses(function: Function, expected: airlight_status, named: &str, spoil: impl FnOnce(&mut Call)) {
    let mut memory = Memory::new();
    let mut call = memory.call();
    // Pointers first, so that they can be spoilt too.
    call.emitters.table = call.table.as_ptr();
    call.media.table = &call.fog;
    call.batch.emitters = &call.emitters;
    call.batch.media = &call.media;
    spoil(&mut call);
    let status = call.make(function, false);
    assert_eq!(status, expected, "{function:?} {named}: {}", message());
    assert!(message().starts_with(named), "{function:?}: '{}' does not begin with {named}", message());
    assert!(call.counts.sampled == 0 && call.counts.empty == 0 && call.counts.invalid == 0);
    assert!(memory.written.iter().all(Column::is_untouched), "{function:?} {named}");
}

#[test]
fn calls_in_order_are_made() {
    for function in [Sample, Pdf, Evaluate, Radiance, Choose] {
        let mut memory = Memory::new();
        let mut call = memory.call();
        assert_eq!(call.make(function, true), Ok, "{function:?} {}", message());
        assert_eq!(call.counts.sampled, RAYS);
        assert!(!memory.written.iter().all(Column::is_untouched));
    }
}

#[test]
fn null_is_named() {
    const NONE: airlight_column = airlight_column { data: null(), stride: 0 };
    refuses(Sample, Null, "batch.origin[1].data is NULL", |c| c.batch.origin[1] = NONE);
    refuses(Radiance, Null, "batch.direction[2].data is NULL", |c| c.batch.direction[2] = NONE);
    refuses(Pdf, Null, "batch.t_max.data is NULL", |c| c.batch.t_max = NONE);
    refuses(Sample, Null, "samples.u.data is NULL", |c| c.samples.u = NONE);
    refuses(Pdf, Null, "values.t.data is NULL", |c| c.values.t = NONE);
    refuses(Choose, Null, "choices.u.data is NULL", |c| c.choices.u = NONE);
    refuses(Choose, Null, "choices.weights.data is NULL", |c| c.choices.weights = NONE);
    refuses(Choose, Null, "emitters.table is NULL", |c| c.emitters.table = null());
    refuses(Sample, Null, "batch.emitters is NULL", |c| c.batch.emitters = null());
    refuses(Sample, Null, "batch.media is NULL", |c| c.batch.media = null());
    refuses(Sample, Null, "emitters.position[0].data is NULL", |c| c.emitters.table = null());
    refuses(Sample, Null, "media.mu_a[0].data is NULL", |c| c.media.table = null());
    refuses(Sample, Null, "emitters.index.data is NULL", |c| c.emitters.table_count = 2);
    refuses(Sample, Null, "emitters.table of emitters.index is NULL", |c| {
        c.emitters.table = null();
        c.emitters.index.data = c.batch.t_min.data.cast();
    });
    refuses(Sample, Null, "emitters.direction[1].data is NULL", |c| {
        c.emitters.table = null();
        c.emitters.position = c.batch.origin;
        c.emitters.direction[0] = c.batch.t_min;
    });
    // SAFETY: NULL is what they are said to be.
    unsafe {
        assert_eq!(airlight_sample(null(), null(), null(), null_mut()), Null);
        assert_eq!(message(), "batch is NULL");
        assert_eq!(airlight_sample_one(null(), null(), 0.5, null_mut()), Null);
        assert_eq!(message(), "scene is NULL");
    }
}

#[test]
fn sizes_of_structs_are_checked() {
    let message = |name: &str, size: usize| format!("{name}.struct_size is {size}");
    for size in [0, 1, 8, 1 << 20, usize::MAX] {
        refuses(Sample, StructSize, &message("options", size), |c| c.options.struct_size = size);
        refuses(Sample, StructSize, &message("batch", size), |c| c.batch.struct_size = size);
        refuses(Sample, StructSize, &message("batch.emitters", size), |c| c.emitters.struct_size = size);
        refuses(Sample, StructSize, &message("batch.media", size), |c| c.media.struct_size = size);
        refuses(Sample, StructSize, &message("samples", size), |c| c.samples.struct_size = size);
        refuses(Pdf, StructSize, &message("values", size), |c| c.values.struct_size = size);
        refuses(Choose, StructSize, &message("choices", size), |c| c.choices.struct_size = size);
        refuses(Radiance, StructSize, &message("counts", size), |c| c.counts.struct_size = size);
    }
}

#[test]
fn strides_that_are_too_small_are_refused() {
    for stride in 1..4 {
        refuses(Sample, Stride, &format!("batch.origin[2].stride is {stride}"), |c| c.batch.origin[2].stride = stride);
        refuses(Sample, Stride, &format!("samples.r.stride is {stride}"), |c| c.samples.r.stride = stride);
        refuses(Choose, Stride, "choices.index.stride is", |c| {
            (c.choices.index.data, c.choices.index.stride) = (c.samples.t.data.cast(), stride);
        });
    }
    refuses(Sample, Stride, "samples.u.stride is 7", |c| (c.samples.per_ray, c.samples.u.stride) = (2, 7));
}

#[test]
fn counts_that_overflow_are_refused() {
    for count in [usize::MAX, usize::MAX / 4, isize::MAX as usize / 4 + 1] {
        refuses(Sample, Length, "batch.origin[0] has too many", |c| c.batch.count = count);
        refuses(Pdf, Length, "values.t has too many", |c| c.values.per_ray = count);
        refuses(Sample, Length, "emitters.table has too many", |c| c.emitters.table_count = count);
    }
    refuses(Sample, Length, "batch.t_min has too many", |c| c.batch.t_min.stride = usize::MAX / 4);
}

#[test]
fn numbers_out_of_range_are_refused() {
    refuses(Sample, Value, "options.strategy is 10", |c| c.options.strategy = 10);
    refuses(Sample, Value, "options.strategy is 4294967295", |c| c.options.strategy = u32::MAX);
    refuses(Sample, Value, "options.precision is 2", |c| c.options.precision = 2);
    refuses(Radiance, Value, "options.nodes is 5", |c| c.options.nodes = 5);
    refuses(Sample, Value, "options.backend is 4", |c| c.options.backend = 4);
    refuses(Sample, Value, "samples.per_ray is 0", |c| c.samples.per_ray = 0);
    refuses(Pdf, Value, "values.per_ray is 0", |c| c.values.per_ray = 0);
    refuses(Sample, Value, "emitters.table[0].kind is 3", |c| c.table[0].kind = 3);
    refuses(Sample, Value, "emitters.table[0].position is NaN", |c| c.table[0].position[1] = f32::NAN);
    refuses(Choose, Value, "emitters.table[1].normal is 0", |c| (c.table[1].kind, c.emitters.table_count) = (1, 2));
    refuses(Sample, Value, "media.table[0].mu_s is -1", |c| c.fog.mu_s[0] = -1.0);
    refuses(Sample, Value, "media.table[0].channels is 2", |c| c.fog.channels = 2);
    refuses(Sample, Value, "emitters.table[0].cos_inner is 0.25", |c| {
        (c.table[0].kind, c.table[0].direction[2]) = (2, 1.0);
        (c.table[0].cos_outer, c.table[0].cos_inner) = (0.5, 0.25);
    });
    refuses(Choose, Value, "emitters.index is given", |c| c.emitters.index.data = c.batch.t_min.data.cast());
    refuses(Choose, Value, "weights is -1", |c| {
        static NEGATIVE: [f32; 1] = [-1.0];
        c.choices.weights.data = NEGATIVE.as_ptr();
    });
    refuses(Sample, Empty, "emitters.table is empty", |c| c.emitters.table_count = 0);
    refuses(Radiance, Empty, "media.table is empty", |c| c.media.table_count = 0);
    refuses(Choose, Empty, "emitters.table is empty", |c| c.emitters.table_count = 0);
}

#[test]
fn other_numbers_of_channels_are_refused() {
    refuses(Sample, Channels, "samples.weight[1] is given, expected one column", |c| {
        c.samples.weight[1] = c.values.value[0];
    });
    refuses(Pdf, Channels, "values.value[3] is given, expected one column", |c| c.values.value[3] = c.samples.t);
    let expected = |name: &str| format!("{name}, expected 3 columns, one for each channel");
    refuses(Sample, Channels, &expected("samples.weight[1] is NULL"), |c| c.fog.channels = 3);
    refuses(Evaluate, Channels, &expected("values.value[1] is NULL"), |c| c.fog.channels = 3);
    refuses(Radiance, Channels, &expected("values.value[3] is given"), |c| {
        c.fog.channels = 3;
        c.values.value = [c.samples.t, c.samples.pdf, c.samples.r, c.values.value[0]];
    });
    refuses(Pdf, Channels, "values.value[1] is given, expected one column", |c| {
        c.fog.channels = 3;
        c.values.value[1] = c.samples.t;
    });
    let columns = |c: &mut Call, channels: u32, given: usize| {
        (c.media.table, c.media.channels) = (null(), channels);
        c.media.mu_a[..given].fill(c.batch.t_min);
        c.media.mu_s[..3].fill(c.batch.t_min);
    };
    refuses(Sample, Channels, &expected("media.mu_a[2] is NULL"), |c| columns(c, 3, 2));
    refuses(Sample, Channels, &expected("media.mu_a[3] is given"), |c| columns(c, 3, 4));
    refuses(Sample, Channels, "media.mu_s[1] is given, expected one column", |c| columns(c, 0, 1));
    refuses(Sample, Value, "media.channels is 2", |c| columns(c, 2, 3));
    refuses(Choose, Value, "media.channels is 5", |c| columns(c, 5, 3));
    // Those of a table are of one kind.
    const GREY: airlight_medium = airlight_medium { channels: 1, mu_a: [0.1; 4], mu_s: [0.1; 4], g: 0.0 };
    static TABLE: [airlight_medium; 2] = [airlight_medium { channels: 3, ..GREY }, GREY];
    for function in [Sample, Pdf, Evaluate, Radiance, Choose] {
        refuses(function, Channels, "media.table[1] has 1 channel, expected 3", |c| {
            (c.media.table, c.media.table_count, c.media.index.data) = (TABLE.as_ptr(), 2, ZEROS.as_ptr());
            c.samples.weight[0].data = null_mut();
            c.values.value[0].data = if function == Pdf { c.values.value[0].data } else { null_mut() };
        });
    }
}

#[test]
fn spots_have_both_cosines() {
    let columns = |c: &mut Call| {
        (c.emitters.table, c.emitters.position, c.emitters.direction) = (null(), c.batch.origin, c.batch.direction);
        (c.emitters.cos_outer, c.emitters.cos_inner) = (c.samples.u, c.batch.t_max);
    };
    const NONE: airlight_column = airlight_column { data: null(), stride: 0 };
    refuses(Sample, Null, "emitters.cos_outer.data is NULL", |c| {
        columns(c);
        c.emitters.cos_outer = NONE;
    });
    refuses(Radiance, Null, "emitters.cos_inner.data is NULL", |c| {
        columns(c);
        c.emitters.cos_inner = NONE;
    });
}

#[test]
fn what_there_is_not_is_said() {
    refuses(Sample, Unavailable, "the strategy product-3 has no fast precision", |c| {
        c.options.strategy = airlight_strategy::Product3 as u32;
        c.options.precision = 1;
    });
    if airlight_backend_name(airlight_backend::Avx512 as u32).is_null() {
        refuses(Sample, Unavailable, "options.backend is 3", |c| c.options.backend = 3);
    }
}

#[test]
fn outputs_that_overlap_are_refused() {
    refuses(Sample, Overlap, "samples.t overlaps samples.pdf", |c| c.samples.pdf = c.samples.t);
    refuses(Sample, Overlap, "samples.t overlaps samples.u", |c| c.samples.u.data = c.samples.t.data);
    refuses(Sample, Overlap, "samples.pdf overlaps batch.origin[0]", |c| {
        c.batch.origin[0].data = c.samples.pdf.data.wrapping_byte_add(2);
    });
}

#[test]
fn no_rays_need_no_columns() {
    for function in [Sample, Pdf, Radiance] {
        let mut memory = Memory::new();
        let mut call = memory.call();
        call.batch = airlight_batch::default();
        call.samples = airlight_samples { per_ray: 3, ..Default::default() };
        call.values = airlight_values { per_ray: 3, ..Default::default() };
        assert_eq!(call.make(function, true), Ok, "{function:?} {}", message());
        assert_eq!((call.counts.sampled, call.counts.empty, call.counts.invalid), (0, 0, 0));
    }
}

#[test]
fn one_ray_that_is_none_is_refused() {
    let point = airlight_emitter { kind: 0, position: [1.0; 3], direction: [0.0; 3], cos_outer: 0.0, cos_inner: 0.0 };
    let fog = airlight_medium { channels: 0, mu_a: [0.1; 4], mu_s: [0.1; 4], g: 0.0 };
    let ray = airlight_ray { origin: [0.0; 3], direction: [0.0, 0.0, 1.0], t_min: 0.0, t_max: 1.0 };
    let scene = airlight_scene { ray, emitter: point, medium: fog, ..Default::default() };
    type Spoil = fn(&mut airlight_scene);
    let cases: [(Spoil, airlight_status, &str); 5] = [
        (|s| s.ray.direction = [0.0; 3], Value, "scene.ray.direction is 0"),
        (|s| s.ray.t_max = -1.0, Value, "scene.ray.t_max is -1"),
        (|s| s.medium.g = f32::NAN, Value, "scene.medium.g is NaN"),
        (|s| s.emitter.kind = 9, Value, "scene.emitter.kind is 9"),
        (|s| s.struct_size = 3, StructSize, "scene.struct_size is 3"),
    ];
    for (spoil, status, named) in cases {
        let mut scene = scene;
        spoil(&mut scene);
        let mut sample = airlight_one_sample { t: 7.0, ..Default::default() };
        // SAFETY: pointers to what they are said to be.
        assert_eq!(unsafe { airlight_sample_one(null(), &scene, 0.5, &mut sample) }, status);
        assert!(message().starts_with(named), "{}", message());
        assert_eq!(sample.t, 7.0);
    }
    // SAFETY: NULL is what it is said to be.
    assert_eq!(unsafe { airlight_pdf_one(null(), &scene, 0.5, null_mut()) }, Null);
}

#[test]
fn every_status_has_words() {
    let mut texts: Vec<_> = (0..12)
        // SAFETY: a C string that lives for ever.
        .map(|status| unsafe { core::ffi::CStr::from_ptr(airlight_status_string(status)) })
        .collect();
    texts.sort();
    texts.dedup();
    assert_eq!(texts.len(), 12);
}
