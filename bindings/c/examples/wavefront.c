// Samples a renderer's queue of rays, and holds the means of the weights to the radiance that airlight integrates.
//
//     wavefront [RAYS]      65,536 of them unless told otherwise
//
// The queue is one of structs, used as it lies. Then the same rays in columns, and by two threads of our own: equal bits.

#include "airlight.h"

#include <math.h>
#include <pthread.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { SAMPLES = 4, STRATEGIES = AIRLIGHT_STRATEGY_PRODUCT17 };

// A ray of the queue, with what a renderer wants to know of it.
typedef struct {
    float origin[3];
    float direction[3];
    float t_max;
    float u[SAMPLES];
    float t[SAMPLES];
    float weight[SAMPLES];
    float radiance;
    uint32_t pixel;
} item;

static uint64_t state = 1;

// A uniform variate of PCG.
static float uniform(void) {
    state = state * UINT64_C(6364136223846793005) + UINT64_C(1442695040888963407);
    return (float)(state >> 40) / 16777216.0f;
}

static void require(airlight_status status) {
    if (status == AIRLIGHT_STATUS_OK) return;
    fprintf(stderr, "%s: %s\n", airlight_status_string(status), airlight_last_message());
    exit(1);
}

// Rays of a camera through a room with fog; some end at a wall, some leave for good.
static void fill(item *queue, size_t rays) {
    size_t side = (size_t)ceil(sqrt((double)rays));
    for (size_t i = 0; i < rays; ++i) {
        item *it = &queue[i];
        float x = ((float)(i % side) + uniform()) / (float)side - 0.5f;
        float y = ((float)(i / side) + uniform()) / (float)side - 0.5f;
        float length = sqrtf(x * x + y * y + 1.0f);
        memset(it, 0, sizeof *it);
        it->origin[1] = 1.0f;
        it->direction[0] = x / length, it->direction[1] = y / length, it->direction[2] = 1.0f / length;
        it->t_max = i % 8 == 0 ? INFINITY : 3.0f + 4.0f * uniform();
        for (int k = 0; k < SAMPLES; ++k) it->u[k] = ((float)k + uniform()) / SAMPLES;
        it->pixel = (uint32_t)i;
    }
}

static airlight_column column(const float *first) {
    airlight_column column = {first, sizeof(item)};
    return column;
}

static airlight_output output(float *first) {
    airlight_output output = {first, sizeof(item)};
    return output;
}

static const airlight_emitter lamp = {
    .kind = AIRLIGHT_EMITTER_KIND_POINT_NORMAL, .position = {0.4f, 2.0f, 3.0f}, .direction = {0.0f, -1.0f, 0.0f}};
static const airlight_medium fog = {.channels = 1, .mu_a = {0.02f}, .mu_s = {0.15f}, .g = 0.6f};

// Samples some rays of the queue.
static airlight_counts sample(item *queue, size_t rays, uint32_t strategy, uint32_t threads) {
    airlight_options options = {.struct_size = sizeof options, .strategy = strategy, .threads = threads};
    airlight_emitters emitters = {.struct_size = sizeof emitters, .table = &lamp, .table_count = 1};
    airlight_media media = {.struct_size = sizeof media, .table = &fog, .table_count = 1};
    airlight_batch batch = {.struct_size = sizeof batch, .count = rays, .emitters = &emitters, .media = &media};
    for (int k = 0; k < 3; ++k) {
        batch.origin[k] = column(&queue->origin[k]);
        batch.direction[k] = column(&queue->direction[k]);
    }
    batch.t_max = column(&queue->t_max);
    airlight_samples samples = {.struct_size = sizeof samples, .per_ray = SAMPLES, .u = column(queue->u)};
    samples.t = output(queue->t);
    samples.weight[0] = output(queue->weight);
    airlight_counts counts = {.struct_size = sizeof counts};
    require(airlight_sample(&options, &batch, &samples, &counts));

    airlight_values radiance = {.struct_size = sizeof radiance};
    radiance.value[0] = output(&queue->radiance);
    options.nodes = 12;
    require(airlight_radiance(&options, &batch, &radiance, NULL));
    return counts;
}

// The same rays in packed columns; whether t and weight have the same bits.
static int same_in_columns(const item *queue, size_t rays, uint32_t strategy) {
    enum { INPUTS = 7 };
    float *memory = malloc(rays * (INPUTS + 3 * SAMPLES) * sizeof *memory);
    if (memory == NULL) exit(1);
    float *u = memory + rays * INPUTS, *t = u + rays * SAMPLES, *weight = t + rays * SAMPLES;
    for (size_t i = 0; i < rays; ++i) {
        for (int k = 0; k < 3; ++k) {
            memory[rays * (size_t)k + i] = queue[i].origin[k];
            memory[rays * (size_t)(k + 3) + i] = queue[i].direction[k];
        }
        memory[rays * 6 + i] = queue[i].t_max;
        memcpy(u + i * SAMPLES, queue[i].u, sizeof queue->u);
    }
    airlight_options options = {.struct_size = sizeof options, .strategy = strategy};
    airlight_emitters emitters = {.struct_size = sizeof emitters, .table = &lamp, .table_count = 1};
    airlight_media media = {.struct_size = sizeof media, .table = &fog, .table_count = 1};
    airlight_batch batch = {.struct_size = sizeof batch, .count = rays, .emitters = &emitters, .media = &media};
    for (size_t k = 0; k < 3; ++k) {
        batch.origin[k].data = memory + rays * k;
        batch.direction[k].data = memory + rays * (k + 3);
    }
    batch.t_max.data = memory + rays * 6;
    airlight_samples samples = {.struct_size = sizeof samples, .per_ray = SAMPLES, .u = {u, 0}, .t = {t, 0}};
    samples.weight[0].data = weight;
    require(airlight_sample(&options, &batch, &samples, NULL));
    int same = 1;
    for (size_t i = 0; i < rays; ++i) {
        same = same && memcmp(queue[i].t, t + i * SAMPLES, sizeof queue->t) == 0 &&
               memcmp(queue[i].weight, weight + i * SAMPLES, sizeof queue->weight) == 0;
    }
    free(memory);
    return same;
}

typedef struct {
    item *queue;
    size_t rays;
    uint32_t threads;
} part;

static void *sample_part(void *argument) {
    part *p = argument;
    sample(p->queue, p->rays, AIRLIGHT_STRATEGY_DEFAULT, p->threads);
    return NULL;
}

// The same rays by two threads at once, one of them with the pool's; whether everything has the same bits.
static int same_by_two(const item *queue, size_t rays) {
    item *copy = malloc(rays * sizeof *copy);
    if (copy == NULL) exit(1);
    memcpy(copy, queue, rays * sizeof *copy);
    for (size_t i = 0; i < rays; ++i) memset(copy[i].t, 0, sizeof copy->t);
    part parts[2] = {{copy, rays / 3, 1}, {copy + rays / 3, rays - rays / 3, 0}};
    pthread_t threads[2];
    for (int k = 0; k < 2; ++k) {
        if (pthread_create(&threads[k], NULL, sample_part, &parts[k]) != 0) exit(1);
    }
    for (int k = 0; k < 2; ++k) pthread_join(threads[k], NULL);
    int same = memcmp(copy, queue, rays * sizeof *copy) == 0;
    free(copy);
    return same;
}

int main(int argc, char **argv) {
    size_t rays = argc > 1 ? (size_t)strtoul(argv[1], NULL, 10) : 65536;
    item *queue = malloc(rays * sizeof *queue);
    if (rays == 0 || queue == NULL) return 1;
    fill(queue, rays);
    printf("airlight %s, %s: %zu rays, %d samples each\n", airlight_version(), airlight_backend_name(0), rays, SAMPLES);
    printf("%-22s %12s %9s %12s %6s\n", "strategy", "mean weight", "+-", "radiance", "z");
    int good = 1;
    for (uint32_t strategy = 1; strategy <= STRATEGIES; ++strategy) {
        airlight_counts counts = sample(queue, rays, strategy, 0);
        double sum = 0.0, squares = 0.0, radiance = 0.0;
        for (size_t i = 0; i < rays; ++i) {
            // The difference of an estimate from the truth has a mean of 0 for every ray.
            double mean = 0.0;
            for (int k = 0; k < SAMPLES; ++k) mean += queue[i].weight[k] / SAMPLES;
            sum += mean;
            squares += (mean - queue[i].radiance) * (mean - queue[i].radiance);
            radiance += queue[i].radiance;
        }
        double n = (double)rays, error = sqrt(squares) / n, z = (sum - radiance) / n / error;
        int agrees = fabs(z) < 4.0 && counts.sampled + counts.empty == rays * SAMPLES && counts.invalid == 0;
        printf("%-22s %12.5e %9.1e %12.5e %+6.2f%s\n", airlight_strategy_name(strategy), sum / n, error, radiance / n, z,
               agrees ? "" : "  WRONG");
        good = good && agrees && same_in_columns(queue, rays, strategy);
    }
    sample(queue, rays, AIRLIGHT_STRATEGY_DEFAULT, 0);
    int two = same_by_two(queue, rays);
    printf("equal bits in columns: %s, by two threads: %s\n", good ? "yes" : "no", two ? "yes" : "no");
    free(queue);
    return good && two ? 0 : 1;
}
