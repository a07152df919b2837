// Calls in every floating-point environment of a host: equal bits, and the environment is found as it was.

#include "airlight.h"

#include <stdint.h>
#include <stdio.h>
#include <string.h>

#if defined(__x86_64__)
#include <xmmintrin.h>
// Flush-to-zero and denormals-are-zero; rounding to nearest, down, up, towards zero; traps of invalid operations and of
// division by zero, which are on where these bits are not; all of them.
static const uint32_t flush = 0x8040, rounding[4] = {0x0000, 0x2000, 0x4000, 0x6000}, traps = 0x0280, mask = 0xe2c0;
static uint64_t get(void) { return _mm_getcsr(); }
static void set(uint64_t state) { _mm_setcsr((unsigned)state); }
#elif defined(__aarch64__)
// The same; few processors have traps.
static const uint32_t flush = 1u << 24, rounding[4] = {0, 2u << 22, 1u << 22, 3u << 22}, traps = 0, mask = 7u << 22;
static uint64_t get(void) {
    uint64_t state;
    __asm__ volatile("mrs %0, fpcr" : "=r"(state));
    return state;
}
static void set(uint64_t state) { __asm__ volatile("msr fpcr, %0" : : "r"(state)); }
#endif

enum { RAYS = 20000, COLUMNS = 12 };

typedef struct {
    float t[RAYS], pdf[RAYS], weight[RAYS], r[RAYS], value[4][RAYS], probability[RAYS], one[5][32];
    uint32_t index[RAYS];
    airlight_status status;
} results;

static float origin[3][RAYS], direction[3][RAYS], t_min[RAYS], t_max[RAYS], u[RAYS], at[RAYS];
static results expected, found;

// All calls.
static void calls(results *out, uint32_t threads) {
    airlight_emitter lamps[2] = {{AIRLIGHT_EMITTER_KIND_POINT, {0.1f, 0.2f, 1.0f}, {0}, 0, 0},
                                 {AIRLIGHT_EMITTER_KIND_POINT_NORMAL, {0.0f, 0.5f, 0.5f}, {0.0f, -1.0f, 0.0f}, 0, 0}};
    // So dense, and scattering so little, that some weights and integrands are subnormal numbers.
    airlight_medium smoke = {1, {60.0f}, {1e-3f}, 0.4f};
    airlight_options options = {.struct_size = sizeof options, .threads = threads};
    airlight_emitters emitters = {.struct_size = sizeof emitters, .table = lamps, .table_count = 1};
    airlight_media media = {.struct_size = sizeof media, .table = &smoke, .table_count = 1};
    airlight_batch batch = {.struct_size = sizeof batch, .count = RAYS, .emitters = &emitters, .media = &media};
    for (int k = 0; k < 3; ++k) batch.origin[k].data = origin[k], batch.direction[k].data = direction[k];
    batch.t_max.data = t_max;
    // Slices as they are on the pool's threads, block by block on this one.
    if (threads == 0) batch.t_min.data = t_min;
    airlight_samples samples = {.struct_size = sizeof samples, .per_ray = 1, .u = {u, 0}};
    samples.t.data = out->t, samples.pdf.data = out->pdf, samples.weight[0].data = out->weight, samples.r.data = out->r;
    airlight_values values = {.struct_size = sizeof values, .per_ray = 1, .t = {at, 0}};
    out->status = airlight_sample(&options, &batch, &samples, NULL);
    values.value[0].data = out->value[0], out->status |= airlight_pdf(&options, &batch, &values, NULL);
    values.value[0].data = out->value[1], out->status |= airlight_cdf(&options, &batch, &values, NULL);
    values.value[0].data = out->value[2], out->status |= airlight_evaluate(&options, &batch, &values, NULL);
    values.value[0].data = out->value[3], out->status |= airlight_radiance(&options, &batch, &values, NULL);
    const float weights[2] = {1.0f, 2.0f};
    emitters.table_count = 2;
    airlight_choices choices = {.struct_size = sizeof choices, .u = {u, 0}, .weights = {weights, 0}};
    choices.index.data = out->index, choices.probability.data = out->probability;
    out->status |= airlight_choose(&options, &batch, &choices, NULL);
    for (int i = 0; i < 32; ++i) {
        airlight_scene scene = {.struct_size = sizeof scene, .emitter = lamps[0], .medium = smoke};
        for (int k = 0; k < 3; ++k) scene.ray.origin[k] = origin[k][i], scene.ray.direction[k] = direction[k][i];
        scene.ray.t_max = t_max[i];
        airlight_one_sample sample = {.struct_size = sizeof sample};
        out->status |= airlight_sample_one(&options, &scene, u[i], &sample);
        out->one[0][i] = sample.weight[0];
        out->status |= airlight_pdf_one(&options, &scene, at[i], &out->one[1][i]);
        out->status |= airlight_cdf_one(&options, &scene, at[i], &out->one[2][i]);
        out->status |= airlight_evaluate_one(&options, &scene, at[i], &out->one[3][i]);
        out->status |= airlight_radiance_one(&options, &scene, &out->one[4][i]);
    }
}

static int subnormals(const float *values, int count) {
    int found = 0;
    for (int i = 0; i < count; ++i) {
        uint32_t bits;
        memcpy(&bits, &values[i], sizeof bits);
        found += bits != 0 && (bits & 0x7f800000u) == 0;
    }
    return found;
}

int main(void) {
    for (int i = 0; i < RAYS; ++i) {
        float x = (float)(i % 100) / 500.0f - 0.1f, y = (float)(i / 100) / 1000.0f - 0.1f;
        direction[0][i] = x, direction[1][i] = y, direction[2][i] = 1.0f - 0.5f * (x * x + y * y);
        origin[2][i] = -0.5f * (float)(i % 7) / 7.0f;
        t_max[i] = 1.5f + (float)(i % 3), u[i] = (float)(i * 37 % 1009) / 1009.0f, at[i] = t_max[i] * u[i];
    }
    const uint64_t before = get();
    int failures = 0;
    // The first call starts the threads of the pool, which are to have the default environment all the same.
    for (int i = 0; i < 16; ++i) {
        uint64_t state = (before & ~(uint64_t)mask) | rounding[i / 2 % 4] | (i % 2 == 0 ? flush : traps);
        set(state);
        calls(&found, i / 8 == 0 ? 0 : 1);
        uint64_t after = get();
        set(before);
        if (i == 0) expected = found;
        // Flags of exceptions may be set, by this program too; the mode may not be another one.
        int kept = ((after ^ state) & mask) == 0, same = memcmp(&found, &expected, sizeof found) == 0;
        if (!kept || !same || found.status != AIRLIGHT_STATUS_OK) {
            printf("environment %#llx: kept %d, equal bits %d, status %u\n", (unsigned long long)state, kept, same,
                   (unsigned)found.status);
            ++failures;
        }
    }
    calls(&found, 1);
    failures += memcmp(&found, &expected, sizeof found) != 0;
    int weights = subnormals(expected.weight, RAYS), integrands = subnormals(expected.value[2], RAYS);
    printf("%d failures; subnormal: %d weights, %d integrands\n", failures, weights, integrands);
    return failures == 0 && weights > 0 && integrands > 0 ? 0 : 1;
}
