// airlight for C and C++: scattering distances along rays for single scattering in homogeneous media.
//
// Made by cbindgen from bindings/c/src; bindings/c/README.md has examples, the Rust crate the theory.
//
// A struct that starts with `struct_size` is set to its size and may be zero beyond:
// `airlight_batch batch = {.struct_size = sizeof batch}`. Every pointer is NULL or one to what it is said to be, of any
// alignment. No result depends on the floating-point environment of the host, which every call leaves as it was (x86-64,
// AArch64; elsewhere it must be the default one). Any thread may call at any time.

#ifndef AIRLIGHT_H
#define AIRLIGHT_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

// What a call returns. Unless it is `AIRLIGHT_STATUS_OK`, nothing was written, `AIRLIGHT_STATUS_PANIC` aside.
enum airlight_status
#if defined(__cplusplus) || __STDC_VERSION__ >= 202311L
  : uint32_t
#endif // defined(__cplusplus) || __STDC_VERSION__ >= 202311L
 {
  // Done.
  AIRLIGHT_STATUS_OK = 0,
  // A pointer is NULL that must not be.
  AIRLIGHT_STATUS_NULL = 1,
  // The first field of a struct is not its size.
  AIRLIGHT_STATUS_STRUCT_SIZE = 2,
  // A column does not fit into memory.
  AIRLIGHT_STATUS_LENGTH = 3,
  // A stride is smaller than the values that it is to step over.
  AIRLIGHT_STATUS_STRIDE = 4,
  // An output shares memory with another column.
  AIRLIGHT_STATUS_OVERLAP = 5,
  // A table has no entry.
  AIRLIGHT_STATUS_EMPTY = 6,
  // A number is out of its range.
  AIRLIGHT_STATUS_VALUE = 7,
  // There is no such thing: in this version, of this strategy or on this CPU.
  AIRLIGHT_STATUS_UNAVAILABLE = 8,
  // Media have other numbers of channels than each other, or than there are columns for them.
  AIRLIGHT_STATUS_CHANNELS = 9,
  // A defect of airlight. Outputs may have been written.
  AIRLIGHT_STATUS_PANIC = 10,
};
#ifndef __cplusplus
#if __STDC_VERSION__ >= 202311L
typedef enum airlight_status airlight_status;
#else
typedef uint32_t airlight_status;
#endif // __STDC_VERSION__ >= 202311L
#endif // __cplusplus

// Which density over distance is sampled. The documentation of the Rust crate says which one to take.
enum airlight_strategy
#if defined(__cplusplus) || __STDC_VERSION__ >= 202311L
  : uint32_t
#endif // defined(__cplusplus) || __STDC_VERSION__ >= 202311L
 {
  // `AIRLIGHT_STRATEGY_PRODUCT5`.
  AIRLIGHT_STRATEGY_DEFAULT = 0,
  // Proportional to the transmittance along the ray.
  AIRLIGHT_STRATEGY_TRANSMITTANCE = 1,
  // Proportional to `1/r^2`.
  AIRLIGHT_STRATEGY_EQUI_ANGULAR = 2,
  // Proportional to `N/r^2`.
  AIRLIGHT_STRATEGY_POINT_NORMAL = 3,
  // Proportional to `N/r^2` times the Taylor polynomial of the transmittance.
  AIRLIGHT_STRATEGY_TAYLOR_TRANSMITTANCE = 4,
  // Proportional to `N/r^2` times the Taylor polynomial of the phase function.
  AIRLIGHT_STRATEGY_TAYLOR_PHASE = 5,
  // Nearly proportional to the whole integrand, known at 3 points.
  AIRLIGHT_STRATEGY_PRODUCT3 = 6,
  // The same with 5 points.
  AIRLIGHT_STRATEGY_PRODUCT5 = 7,
  // The same with 9 points.
  AIRLIGHT_STRATEGY_PRODUCT9 = 8,
  // The same with 17 points.
  AIRLIGHT_STRATEGY_PRODUCT17 = 9,
};
#ifndef __cplusplus
#if __STDC_VERSION__ >= 202311L
typedef enum airlight_strategy airlight_strategy;
#else
typedef uint32_t airlight_strategy;
#endif // __STDC_VERSION__ >= 202311L
#endif // __cplusplus

// How exactly a call computes.
enum airlight_precision
#if defined(__cplusplus) || __STDC_VERSION__ >= 202311L
  : uint32_t
#endif // defined(__cplusplus) || __STDC_VERSION__ >= 202311L
 {
  // As exact as a float can hold, on every input.
  AIRLIGHT_PRECISION_EXACT = 0,
  // Geometry in floats alone. `EQUI_ANGULAR`, `POINT_NORMAL`, `PRODUCT_5`, `PRODUCT_9` and the integral have it.
  AIRLIGHT_PRECISION_FAST = 1,
};
#ifndef __cplusplus
#if __STDC_VERSION__ >= 202311L
typedef enum airlight_precision airlight_precision;
#else
typedef uint32_t airlight_precision;
#endif // __STDC_VERSION__ >= 202311L
#endif // __cplusplus

// The instruction set that a call runs on.
enum airlight_backend
#if defined(__cplusplus) || __STDC_VERSION__ >= 202311L
  : uint32_t
#endif // defined(__cplusplus) || __STDC_VERSION__ >= 202311L
 {
  // The fastest one of this CPU.
  AIRLIGHT_BACKEND_FASTEST = 0,
  // Any CPU.
  AIRLIGHT_BACKEND_PORTABLE = 1,
  // x86-64 with AVX2 and FMA.
  AIRLIGHT_BACKEND_AVX2 = 2,
  // x86-64 with AVX-512.
  AIRLIGHT_BACKEND_AVX512 = 3,
};
#ifndef __cplusplus
#if __STDC_VERSION__ >= 202311L
typedef enum airlight_backend airlight_backend;
#else
typedef uint32_t airlight_backend;
#endif // __STDC_VERSION__ >= 202311L
#endif // __cplusplus

// What an emitter is.
enum airlight_emitter_kind
#if defined(__cplusplus) || __STDC_VERSION__ >= 202311L
  : uint32_t
#endif // defined(__cplusplus) || __STDC_VERSION__ >= 202311L
 {
  // It shines alike in all directions.
  AIRLIGHT_EMITTER_KIND_POINT = 0,
  // A point of a surface: it shines in proportion to the cosine with its normal, which is `direction`.
  AIRLIGHT_EMITTER_KIND_POINT_NORMAL = 1,
  // It shines into a cone around `direction`.
  AIRLIGHT_EMITTER_KIND_SPOT = 2,
};
#ifndef __cplusplus
#if __STDC_VERSION__ >= 202311L
typedef enum airlight_emitter_kind airlight_emitter_kind;
#else
typedef uint32_t airlight_emitter_kind;
#endif // __STDC_VERSION__ >= 202311L
#endif // __cplusplus

// How a call is done. NULL instead of it, or zeros after `struct_size`, are the defaults.
typedef struct airlight_options {
  // `sizeof(airlight_options)`.
  size_t struct_size;
  // An `airlight_strategy`. `airlight_radiance` and `airlight_choose` have none.
  uint32_t strategy;
  // An `airlight_precision`.
  uint32_t precision;
  // How many nodes the integrals of `airlight_radiance` and `airlight_choose` have: 4, 6, 8 or 12; 0 means 8.
  uint32_t nodes;
  // An `airlight_backend`.
  uint32_t backend;
  // On how many threads a call runs at most: 0 means all of the pool, 1 the calling thread alone.
  // No bit of a result depends on it.
  uint32_t threads;
} airlight_options;

// Floats that a call reads, one element for each ray.
//
// An element is one float, or where there are several for each ray (`per_ray`) so many next to each other.
typedef struct airlight_column {
  // The first float, of any alignment.
  const float *data;
  // Bytes from one element to the next; 0 means that elements lie next to each other.
  size_t stride;
} airlight_column;

// A point that lights the medium. Its layout is final, as tables consist of it.
typedef struct airlight_emitter {
  // An `airlight_emitter_kind`.
  uint32_t kind;
  // Where it is (m).
  float position[3];
  // The normal of a `POINT_NORMAL`, the axis of a `SPOT`, of length 1 within 1e-3.
  float direction[3];
  // Of a `SPOT`: the cosine of the angle from the axis beyond which it is dark.
  float cos_outer;
  // Of a `SPOT`: the cosine of the angle up to which it shines in full, at least `cos_outer`.
  float cos_inner;
} airlight_emitter;

// Indices that a call reads, one for each ray.
typedef struct airlight_index_column {
  // The first index, of any alignment.
  const uint32_t *data;
  // Bytes from one index to the next; 0 means 4.
  size_t stride;
} airlight_index_column;

// The emitter of each ray: that of a table, or columns.
typedef struct airlight_emitters {
  // `sizeof(airlight_emitters)`.
  size_t struct_size;
  // The table; columns are not looked at then. NULL: there are columns instead.
  const struct airlight_emitter *table;
  // How many entries it has.
  size_t table_count;
  // Which entry lights each ray; NULL: the only one. An index out of range makes its ray invalid.
  struct airlight_index_column index;
  // Positions, x, y, z (m).
  struct airlight_column position[3];
  // Normals or axes, x, y, z; all NULL, or 0 for a ray: its emitter shines alike in all directions.
  struct airlight_column direction[3];
  // With `cos_inner`, as those of an `airlight_emitter`: the emitters are spots, but those of which both cosines are -1.
  // Both NULL: there are no spots.
  struct airlight_column cos_outer;
  // See `cos_outer`.
  struct airlight_column cos_inner;
} airlight_emitters;

// A homogeneous medium with the Henyey-Greenstein phase function. Its layout is final, as tables consist of it.
typedef struct airlight_medium {
  // How many channels of a colour it has: 1, 3 or 4; 0 means 1.
  uint32_t channels;
  // Absorption coefficients of the channels (1/m).
  float mu_a[4];
  // Scattering coefficients of the channels (1/m).
  float mu_s[4];
  // Mean cosine of the scattering angle; above 0 the medium scatters forward.
  float g;
} airlight_medium;

// The medium of each ray: that of a table, or columns.
typedef struct airlight_media {
  // `sizeof(airlight_media)`.
  size_t struct_size;
  // The table; columns are not looked at then. NULL: there are columns instead.
  const struct airlight_medium *table;
  // How many entries it has, all with as many channels.
  size_t table_count;
  // Which entry each ray is in; NULL: the only one. An index out of range makes its ray invalid.
  struct airlight_index_column index;
  // How many channels the columns have: 1, 3 or 4; 0 means 1.
  uint32_t channels;
  // Absorption coefficients of each channel (1/m), NULL beyond `channels`.
  struct airlight_column mu_a[4];
  // Scattering coefficients of each channel (1/m), NULL beyond `channels`.
  struct airlight_column mu_s[4];
  // Mean cosines; NULL: 0.
  struct airlight_column g;
} airlight_media;

// Rays with their emitters and media.
typedef struct airlight_batch {
  // `sizeof(airlight_batch)`.
  size_t struct_size;
  // How many rays. With none every pointer to a column may be NULL.
  size_t count;
  // Where the rays start, x, y, z (m).
  struct airlight_column origin[3];
  // Where they go, x, y, z, of length 1 within 1e-3.
  struct airlight_column direction[3];
  // Where they enter the medium (m); NULL: 0.
  struct airlight_column t_min;
  // Where they leave it (m), may be infinite.
  struct airlight_column t_max;
  // What lights them.
  const struct airlight_emitters *emitters;
  // What they are in.
  const struct airlight_media *media;
} airlight_batch;

// Floats that a call writes, as an `airlight_column` has them. NULL `data`: not wanted.
//
// It must share no memory with any other column; it may lie between the elements of columns with the same stride.
typedef struct airlight_output {
  // The first float, of any alignment.
  float *data;
  // Bytes from one element to the next; 0 means that elements lie next to each other.
  size_t stride;
} airlight_output;

// What `airlight_sample` reads and writes.
typedef struct airlight_samples {
  // `sizeof(airlight_samples)`.
  size_t struct_size;
  // How many variates and samples each ray has, at least 1. Those of a ray share its set-up.
  size_t per_ray;
  // Uniform variates in [0, 1].
  struct airlight_column u;
  // Distances along the rays (m).
  struct airlight_output t;
  // Probability densities over distance (1/m); 0: there is no sample.
  struct airlight_output pdf;
  // `mu_s T rho N / (r^2 pdf)`, in 1/m^2, a column for each channel of the media, or none: times the intensity of the
  // emitter, an estimate of the radiance of the ray.
  struct airlight_output weight[4];
  // Distances from the samples to the emitters (m).
  struct airlight_output r;
} airlight_samples;

// What became of the values of a batch: `sampled + empty + invalid` is their number.
typedef struct airlight_counts {
  // `sizeof(airlight_counts)`.
  size_t struct_size;
  // Those of rays that have a sample.
  size_t sampled;
  // Those of valid rays of which nothing is lit.
  size_t empty;
  // Those of rays with a value that is NaN or out of range.
  size_t invalid;
  // Sampled ones whose iteration fell back to bisection, or took more than 8 steps.
  size_t bisected;
} airlight_counts;

// What `airlight_pdf`, `airlight_cdf`, `airlight_evaluate` and `airlight_radiance` read and write.
typedef struct airlight_values {
  // `sizeof(airlight_values)`.
  size_t struct_size;
  // How many distances and values each ray has, at least 1; `airlight_radiance` ignores it and has one value.
  size_t per_ray;
  // Distances along the rays (m); `airlight_radiance` ignores them.
  struct airlight_column t;
  // The values: of `airlight_evaluate` and `airlight_radiance` a column for each channel of the media, else the first one.
  struct airlight_output value[4];
} airlight_values;

// Indices that a call writes, one for each ray. NULL `data`: not wanted.
typedef struct airlight_index_output {
  // The first index, of any alignment.
  uint32_t *data;
  // Bytes from one index to the next; 0 means 4.
  size_t stride;
} airlight_index_output;

// What `airlight_choose` reads and writes.
typedef struct airlight_choices {
  // `sizeof(airlight_choices)`.
  size_t struct_size;
  // Uniform variates in [0, 1], one for each ray, independent of those that distances are sampled with.
  struct airlight_column u;
  // A weight for each entry of the emitters' table (whose `index` is NULL, as it is what is chosen), finite and not
  // negative, such as its mean intensity.
  struct airlight_column weights;
  // Which entry was chosen for each ray.
  struct airlight_index_output index;
  // The probability with which it was chosen; 0: none was.
  struct airlight_output probability;
} airlight_choices;

// A ray `x(t) = origin + t direction`, in the medium from `t_min` to `t_max` (m). Its layout is final.
typedef struct airlight_ray {
  // Where it starts (m).
  float origin[3];
  // Where it goes, of length 1 within 1e-3.
  float direction[3];
  // Where it enters the medium (m), at least 0.
  float t_min;
  // Where it leaves it (m), may be infinite.
  float t_max;
} airlight_ray;

// One ray, one emitter, one medium.
typedef struct airlight_scene {
  // `sizeof(airlight_scene)`.
  size_t struct_size;
  // The ray.
  struct airlight_ray ray;
  // What lights it.
  struct airlight_emitter emitter;
  // What it is in.
  struct airlight_medium medium;
} airlight_scene;

// A sample of one ray, as `airlight_samples` has many.
typedef struct airlight_one_sample {
  // `sizeof(airlight_one_sample)`.
  size_t struct_size;
  // Distance along the ray (m).
  float t;
  // Probability density over distance (1/m); 0: there is no sample.
  float pdf;
  // `mu_s T rho N / (r^2 pdf)`, in 1/m^2, for each channel of the medium; 0 for those that it has not.
  float weight[4];
  // Distance from the sample to the emitter (m).
  float r;
} airlight_one_sample;

#ifdef __cplusplus
extern "C" {
#endif // __cplusplus

// Draws distances along rays: for each variate one, with its density and its weight.
//
// An empty or invalid ray has zeros. `counts` may be NULL.
airlight_status airlight_sample(const struct airlight_options *options,
                                const struct airlight_batch *batch,
                                const struct airlight_samples *samples,
                                struct airlight_counts *counts);

// Writes the density of `airlight_sample` at given distances (1/m); 0 outside the sampled interval.
airlight_status airlight_pdf(const struct airlight_options *options,
                             const struct airlight_batch *batch,
                             const struct airlight_values *values,
                             struct airlight_counts *counts);

// Writes the distribution function of `airlight_sample` at given distances: from `t` back to `u`.
airlight_status airlight_cdf(const struct airlight_options *options,
                             const struct airlight_batch *batch,
                             const struct airlight_values *values,
                             struct airlight_counts *counts);

// Writes the integrand `mu_s T rho N / r^2` at given distances (1/m^3), for each channel of the media.
airlight_status airlight_evaluate(const struct airlight_options *options,
                                  const struct airlight_batch *batch,
                                  const struct airlight_values *values,
                                  struct airlight_counts *counts);

// Writes the radiance of each ray per unit of the emitter's intensity (1/m^2), without a sample and so without noise, for
// each channel of the media.
airlight_status airlight_radiance(const struct airlight_options *options,
                                  const struct airlight_batch *batch,
                                  const struct airlight_values *values,
                                  struct airlight_counts *counts);

// Chooses one emitter of a table for each ray, in proportion to its weight times what it adds to the ray's radiance.
airlight_status airlight_choose(const struct airlight_options *options,
                                const struct airlight_batch *batch,
                                const struct airlight_choices *choices,
                                struct airlight_counts *counts);

// `airlight_sample` for one ray; `sample->pdf` is 0 if it has no sample, or `u` is not in [0, 1].
airlight_status airlight_sample_one(const struct airlight_options *options,
                                    const struct airlight_scene *scene,
                                    float u,
                                    struct airlight_one_sample *sample);

// `airlight_pdf` for one ray.
airlight_status airlight_pdf_one(const struct airlight_options *options,
                                 const struct airlight_scene *scene,
                                 float t,
                                 float *pdf);

// `airlight_cdf` for one ray.
airlight_status airlight_cdf_one(const struct airlight_options *options,
                                 const struct airlight_scene *scene,
                                 float t,
                                 float *cdf);

// `airlight_evaluate` for one ray: as many floats as the medium has channels.
airlight_status airlight_evaluate_one(const struct airlight_options *options,
                                      const struct airlight_scene *scene,
                                      float t,
                                      float *integrand);

// `airlight_radiance` for one ray: as many floats as the medium has channels.
airlight_status airlight_radiance_one(const struct airlight_options *options,
                                      const struct airlight_scene *scene,
                                      float *radiance);

// The version of airlight, such as "0.2.0".
const char *airlight_version(void);

// A status in words.
const char *airlight_status_string(uint32_t status);

// Why the last call of this thread that failed did so, such as "batch.t_max.data is NULL"; empty if none did. Valid until
// the next one fails.
const char *airlight_last_message(void);

// The name of an `airlight_strategy`, such as "product-5"; NULL if there is none.
const char *airlight_strategy_name(uint32_t number);

// The name of an `airlight_backend`, such as "avx2", of 0 that of the fastest one; NULL if this CPU does not have it.
const char *airlight_backend_name(uint32_t number);

// Whether this CPU has an `airlight_backend` whose multiply-adds round once: all such give the same bits.
bool airlight_backend_is_fused(uint32_t number);

#ifdef __cplusplus
}  // extern "C"
#endif  // __cplusplus

#endif  /* AIRLIGHT_H */
