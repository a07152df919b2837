//! The types of the C ABI: plain numbers, pointers and structs of both.
//!
//! A struct that a call takes starts with its size, so that it can get more fields. Its pointers need no alignment.

#![allow(non_camel_case_types, reason = "the names of the header")]

/// What a call returns. Unless it is `AIRLIGHT_STATUS_OK`, nothing was written, `AIRLIGHT_STATUS_PANIC` aside.
#[repr(u32)]
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum airlight_status {
    /// Done.
    Ok = 0,
    /// A pointer is NULL that must not be.
    Null = 1,
    /// The first field of a struct is not its size.
    StructSize = 2,
    /// A column does not fit into memory.
    Length = 3,
    /// A stride is smaller than the values that it is to step over.
    Stride = 4,
    /// An output shares memory with another column.
    Overlap = 5,
    /// A table has no entry.
    Empty = 6,
    /// A number is out of its range.
    Value = 7,
    /// There is no such thing: in this version, of this strategy or on this CPU.
    Unavailable = 8,
    /// Media have other numbers of channels than each other, or than there are columns for them.
    Channels = 9,
    /// A defect of airlight. Outputs may have been written.
    Panic = 10,
}

/// Which density over distance is sampled. The documentation of the Rust crate says which one to take.
#[repr(u32)]
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum airlight_strategy {
    /// `AIRLIGHT_STRATEGY_PRODUCT5`.
    Default = 0,
    /// Proportional to the transmittance along the ray.
    Transmittance = 1,
    /// Proportional to `1/r^2`.
    EquiAngular = 2,
    /// Proportional to `N/r^2`.
    PointNormal = 3,
    /// Proportional to `N/r^2` times the Taylor polynomial of the transmittance.
    TaylorTransmittance = 4,
    /// Proportional to `N/r^2` times the Taylor polynomial of the phase function.
    TaylorPhase = 5,
    /// Nearly proportional to the whole integrand, known at 3 points.
    Product3 = 6,
    /// The same with 5 points.
    Product5 = 7,
    /// The same with 9 points.
    Product9 = 8,
    /// The same with 17 points.
    Product17 = 9,
}

/// How exactly a call computes.
#[repr(u32)]
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum airlight_precision {
    /// As exact as a float can hold, on every input.
    Exact = 0,
    /// Geometry in floats alone. `EQUI_ANGULAR`, `POINT_NORMAL`, `PRODUCT_5`, `PRODUCT_9` and the integral have it.
    Fast = 1,
}

/// The instruction set that a call runs on.
#[repr(u32)]
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum airlight_backend {
    /// The fastest one of this CPU.
    Fastest = 0,
    /// Any CPU.
    Portable = 1,
    /// x86-64 with AVX2 and FMA.
    Avx2 = 2,
    /// x86-64 with AVX-512.
    Avx512 = 3,
}

/// What an emitter is.
#[repr(u32)]
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum airlight_emitter_kind {
    /// It shines alike in all directions.
    Point = 0,
    /// A point of a surface: it shines in proportion to the cosine with its normal, which is `direction`.
    PointNormal = 1,
    /// It shines into a cone around `direction`.
    Spot = 2,
}

/// How a call is done. NULL instead of it, or zeros after `struct_size`, are the defaults.
#[repr(C)]
#[derive(Clone, Copy, Debug)]
pub struct airlight_options {
    /// `sizeof(airlight_options)`.
    pub struct_size: usize,
    /// An `airlight_strategy`. `airlight_radiance` and `airlight_choose` have none.
    pub strategy: u32,
    /// An `airlight_precision`.
    pub precision: u32,
    /// How many nodes the integrals of `airlight_radiance` and `airlight_choose` have: 4, 6, 8 or 12; 0 means 8.
    pub nodes: u32,
    /// An `airlight_backend`.
    pub backend: u32,
    /// On how many threads a call runs at most: 0 means all of the pool, 1 the calling thread alone.
    /// No bit of a result depends on it.
    pub threads: u32,
}

/// Floats that a call reads, one element for each ray.
///
/// An element is one float, or where there are several for each ray (`per_ray`) so many next to each other.
#[repr(C)]
#[derive(Clone, Copy, Debug)]
pub struct airlight_column {
    /// The first float, of any alignment.
    pub data: *const f32,
    /// Bytes from one element to the next; 0 means that elements lie next to each other.
    pub stride: usize,
}

/// Floats that a call writes, as an `airlight_column` has them. NULL `data`: not wanted.
///
/// It must share no memory with any other column; it may lie between the elements of columns with the same stride.
#[repr(C)]
#[derive(Clone, Copy, Debug)]
pub struct airlight_output {
    /// The first float, of any alignment.
    pub data: *mut f32,
    /// Bytes from one element to the next; 0 means that elements lie next to each other.
    pub stride: usize,
}

/// Indices that a call reads, one for each ray.
#[repr(C)]
#[derive(Clone, Copy, Debug)]
pub struct airlight_index_column {
    /// The first index, of any alignment.
    pub data: *const u32,
    /// Bytes from one index to the next; 0 means 4.
    pub stride: usize,
}

/// Indices that a call writes, one for each ray. NULL `data`: not wanted.
#[repr(C)]
#[derive(Clone, Copy, Debug)]
pub struct airlight_index_output {
    /// The first index, of any alignment.
    pub data: *mut u32,
    /// Bytes from one index to the next; 0 means 4.
    pub stride: usize,
}

/// A ray `x(t) = origin + t direction`, in the medium from `t_min` to `t_max` (m). Its layout is final.
#[repr(C)]
#[derive(Clone, Copy, Debug)]
pub struct airlight_ray {
    /// Where it starts (m).
    pub origin: [f32; 3],
    /// Where it goes, of length 1 within 1e-3.
    pub direction: [f32; 3],
    /// Where it enters the medium (m), at least 0.
    pub t_min: f32,
    /// Where it leaves it (m), may be infinite.
    pub t_max: f32,
}

/// A point that lights the medium. Its layout is final, as tables consist of it.
#[repr(C)]
#[derive(Clone, Copy, Debug)]
pub struct airlight_emitter {
    /// An `airlight_emitter_kind`.
    pub kind: u32,
    /// Where it is (m).
    pub position: [f32; 3],
    /// The normal of a `POINT_NORMAL`, the axis of a `SPOT`, of length 1 within 1e-3.
    pub direction: [f32; 3],
    /// Of a `SPOT`: the cosine of the angle from the axis beyond which it is dark.
    pub cos_outer: f32,
    /// Of a `SPOT`: the cosine of the angle up to which it shines in full, at least `cos_outer`.
    pub cos_inner: f32,
}

/// A homogeneous medium with the Henyey-Greenstein phase function. Its layout is final, as tables consist of it.
#[repr(C)]
#[derive(Clone, Copy, Debug)]
pub struct airlight_medium {
    /// How many channels of a colour it has: 1, 3 or 4; 0 means 1.
    pub channels: u32,
    /// Absorption coefficients of the channels (1/m).
    pub mu_a: [f32; 4],
    /// Scattering coefficients of the channels (1/m).
    pub mu_s: [f32; 4],
    /// Mean cosine of the scattering angle; above 0 the medium scatters forward.
    pub g: f32,
}

/// The emitter of each ray: that of a table, or columns.
#[repr(C)]
#[derive(Clone, Copy, Debug)]
pub struct airlight_emitters {
    /// `sizeof(airlight_emitters)`.
    pub struct_size: usize,
    /// The table; columns are not looked at then. NULL: there are columns instead.
    pub table: *const airlight_emitter,
    /// How many entries it has.
    pub table_count: usize,
    /// Which entry lights each ray; NULL: the only one. An index out of range makes its ray invalid.
    pub index: airlight_index_column,
    /// Positions, x, y, z (m).
    pub position: [airlight_column; 3],
    /// Normals or axes, x, y, z; all NULL, or 0 for a ray: its emitter shines alike in all directions.
    pub direction: [airlight_column; 3],
    /// With `cos_inner`, as those of an `airlight_emitter`: the emitters are spots, but those of which both cosines are -1.
    /// Both NULL: there are no spots.
    pub cos_outer: airlight_column,
    /// See `cos_outer`.
    pub cos_inner: airlight_column,
}

/// The medium of each ray: that of a table, or columns.
#[repr(C)]
#[derive(Clone, Copy, Debug)]
pub struct airlight_media {
    /// `sizeof(airlight_media)`.
    pub struct_size: usize,
    /// The table; columns are not looked at then. NULL: there are columns instead.
    pub table: *const airlight_medium,
    /// How many entries it has, all with as many channels.
    pub table_count: usize,
    /// Which entry each ray is in; NULL: the only one. An index out of range makes its ray invalid.
    pub index: airlight_index_column,
    /// How many channels the columns have: 1, 3 or 4; 0 means 1.
    pub channels: u32,
    /// Absorption coefficients of each channel (1/m), NULL beyond `channels`.
    pub mu_a: [airlight_column; 4],
    /// Scattering coefficients of each channel (1/m), NULL beyond `channels`.
    pub mu_s: [airlight_column; 4],
    /// Mean cosines; NULL: 0.
    pub g: airlight_column,
}

/// Rays with their emitters and media.
#[repr(C)]
#[derive(Clone, Copy, Debug)]
pub struct airlight_batch {
    /// `sizeof(airlight_batch)`.
    pub struct_size: usize,
    /// How many rays. With none every pointer to a column may be NULL.
    pub count: usize,
    /// Where the rays start, x, y, z (m).
    pub origin: [airlight_column; 3],
    /// Where they go, x, y, z, of length 1 within 1e-3.
    pub direction: [airlight_column; 3],
    /// Where they enter the medium (m); NULL: 0.
    pub t_min: airlight_column,
    /// Where they leave it (m), may be infinite.
    pub t_max: airlight_column,
    /// What lights them.
    pub emitters: *const airlight_emitters,
    /// What they are in.
    pub media: *const airlight_media,
}

/// What `airlight_sample` reads and writes.
#[repr(C)]
#[derive(Clone, Copy, Debug)]
pub struct airlight_samples {
    /// `sizeof(airlight_samples)`.
    pub struct_size: usize,
    /// How many variates and samples each ray has, at least 1. Those of a ray share its set-up.
    pub per_ray: usize,
    /// Uniform variates in [0, 1].
    pub u: airlight_column,
    /// Distances along the rays (m).
    pub t: airlight_output,
    /// Probability densities over distance (1/m); 0: there is no sample.
    pub pdf: airlight_output,
    /// `mu_s T rho N / (r^2 pdf)`, in 1/m^2, a column for each channel of the media, or none: times the intensity of the
    /// emitter, an estimate of the radiance of the ray.
    pub weight: [airlight_output; 4],
    /// Distances from the samples to the emitters (m).
    pub r: airlight_output,
}

/// What `airlight_pdf`, `airlight_cdf`, `airlight_evaluate` and `airlight_radiance` read and write.
#[repr(C)]
#[derive(Clone, Copy, Debug)]
pub struct airlight_values {
    /// `sizeof(airlight_values)`.
    pub struct_size: usize,
    /// How many distances and values each ray has, at least 1; `airlight_radiance` ignores it and has one value.
    pub per_ray: usize,
    /// Distances along the rays (m); `airlight_radiance` ignores them.
    pub t: airlight_column,
    /// The values: of `airlight_evaluate` and `airlight_radiance` a column for each channel of the media, else the first one.
    pub value: [airlight_output; 4],
}

/// What `airlight_choose` reads and writes.
#[repr(C)]
#[derive(Clone, Copy, Debug)]
pub struct airlight_choices {
    /// `sizeof(airlight_choices)`.
    pub struct_size: usize,
    /// Uniform variates in [0, 1], one for each ray, independent of those that distances are sampled with.
    pub u: airlight_column,
    /// A weight for each entry of the emitters' table (whose `index` is NULL, as it is what is chosen), finite and not
    /// negative, such as its mean intensity.
    pub weights: airlight_column,
    /// Which entry was chosen for each ray.
    pub index: airlight_index_output,
    /// The probability with which it was chosen; 0: none was.
    pub probability: airlight_output,
}

/// What became of the values of a batch: `sampled + empty + invalid` is their number.
#[repr(C)]
#[derive(Clone, Copy, Debug)]
pub struct airlight_counts {
    /// `sizeof(airlight_counts)`.
    pub struct_size: usize,
    /// Those of rays that have a sample.
    pub sampled: usize,
    /// Those of valid rays of which nothing is lit.
    pub empty: usize,
    /// Those of rays with a value that is NaN or out of range.
    pub invalid: usize,
    /// Sampled ones whose iteration fell back to bisection, or took more than 8 steps.
    pub bisected: usize,
}

/// One ray, one emitter, one medium.
#[repr(C)]
#[derive(Clone, Copy, Debug)]
pub struct airlight_scene {
    /// `sizeof(airlight_scene)`.
    pub struct_size: usize,
    /// The ray.
    pub ray: airlight_ray,
    /// What lights it.
    pub emitter: airlight_emitter,
    /// What it is in.
    pub medium: airlight_medium,
}

/// A sample of one ray, as `airlight_samples` has many.
#[repr(C)]
#[derive(Clone, Copy, Debug)]
pub struct airlight_one_sample {
    /// `sizeof(airlight_one_sample)`.
    pub struct_size: usize,
    /// Distance along the ray (m).
    pub t: f32,
    /// Probability density over distance (1/m); 0: there is no sample.
    pub pdf: f32,
    /// `mu_s T rho N / (r^2 pdf)`, in 1/m^2, for each channel of the medium; 0 for those that it has not.
    pub weight: [f32; 4],
    /// Distance from the sample to the emitter (m).
    pub r: f32,
}
