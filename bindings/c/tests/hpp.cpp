// airlight.hpp with exceptions: every call of it is instantiated, a queue of structs is used as it lies, and a call that is
// refused throws with the message of the C call.

#define AIRLIGHT_EXCEPTIONS
#include "airlight.hpp"

#include <cstdio>
#include <cstring>
#include <vector>

namespace {

struct Item {
    float origin[3];
    float direction[3];
    float t_max;
    float u[2];
    float t[2];
    float value;
    float probability;
    std::uint32_t index;
};

template <class F>
bool throws(const char *message, F &&call) {
    try {
        (void)call();
    } catch (const airlight::Error &error) {
        if (std::strcmp(error.what(), message) == 0) return true;
        std::printf("'%s' instead of '%s'\n", error.what(), message);
    }
    return false;
}

} // namespace

int main() {
    using airlight::Column;
    using airlight::Output;
    std::vector<Item> queue(10000, Item{{0, 0, 0}, {0, 0, 1}, 4, {0.25f, 0.75f}, {0, 0}, 0, 0, 0});
    const std::size_t n = queue.size();
    const auto in = [&](auto member, std::size_t k, std::size_t width = 1) {
        return Column::of<Item>(queue.data(), n, member, k, width);
    };
    const airlight::Rays rays = {{in(&Item::origin, 0), in(&Item::origin, 1), in(&Item::origin, 2)},
                                 {in(&Item::direction, 0), in(&Item::direction, 1), in(&Item::direction, 2)},
                                 {},
                                 Column::of<Item>(queue.data(), n, &Item::t_max)};
    const airlight_emitter lamps[] = {airlight::point({0, 1, 2}), airlight::point_normal({0, 2, 2}, {0, -1, 0})};
    const airlight_medium fog = airlight::medium(0.01f, 0.1f, 0.5f);
    airlight::Options options;
    options.strategy = AIRLIGHT_STRATEGY_PRODUCT9;
    const Output value = Output::of<Item>(queue.data(), n, &Item::value);

    airlight_counts counts;
    airlight::Samples samples;
    samples.u = in(&Item::u, 0, 2);
    samples.t = Output::of<Item>(queue.data(), n, &Item::t, 0, 2);
    (void)airlight::sample(options, rays, lamps[0], fog, samples, &counts);
    bool good = counts.sampled == 2 * n && queue[0].t[0] < queue[0].t[1] && queue[n - 1].t[1] == queue[0].t[1];

    airlight_one_sample sample;
    const airlight_ray ray = airlight::ray({0, 0, 0}, {0, 0, 1}, 0, 4);
    (void)airlight::sample_one(options, ray, lamps[0], fog, 0.25f, sample);
    good = good && sample.t == queue[0].t[0];

    const Column t = in(&Item::t, 0, 1);
    float one = 0;
    (void)airlight::pdf(options, rays, lamps[0], fog, t, value);
    (void)airlight::pdf_one(options, ray, lamps[0], fog, sample.t, one);
    good = good && one == queue[n - 1].value && one > 0;
    (void)airlight::cdf(options, rays, lamps[0], fog, t, value);
    (void)airlight::cdf_one(options, ray, lamps[0], fog, sample.t, one);
    good = good && one == queue[n - 1].value && one > 0.249f && one < 0.251f;
    (void)airlight::evaluate(options, rays, lamps[0], fog, t, {value});
    (void)airlight::evaluate_one(options, ray, lamps[0], fog, sample.t, &one);
    good = good && one == queue[n - 1].value && one > 0;
    (void)airlight::radiance(options, rays, lamps[0], fog, {value});
    (void)airlight::radiance_one(options, ray, lamps[0], fog, &one);
    good = good && one == queue[n - 1].value && one > 0;

    const std::vector<float> weights = {1, 0};
    const auto index = airlight::IndexOutput::of<Item>(queue.data(), n, &Item::index);
    const auto probability = Output::of<Item>(queue.data(), n, &Item::probability);
    (void)airlight::choose(options, rays, lamps, weights, fog, in(&Item::u, 0, 1), index, probability);
    good = good && queue[n - 1].index == 0 && queue[n - 1].probability == 1;

    // A table of emitters, and media in columns.
    airlight::Media media;
    const std::vector<float> mu(n, 0.1f);
    media.mu_a[0] = media.mu_s[0] = mu;
    const auto chosen = airlight::Indices::of<Item>(queue.data(), n, &Item::index);
    (void)airlight::radiance(options, rays, {lamps, chosen}, media, {value}, &counts);
    good = good && counts.sampled == n;

    // Spots in columns and one for all, media of three channels in columns and one for all.
    const std::vector<float> zero(n), down(n, -1.0f), up(n, 1.0f), two(n, 2.0f), outer(n, 0.5f), inner(n, 0.7f);
    const std::vector<float> dense(n, 0.3f), thin(n, 0.2f);
    airlight::Emitters spots;
    spots.position = {zero, up, two}, spots.direction = {zero, down, zero};
    spots.cos_outer = outer, spots.cos_inner = inner;
    const airlight_emitter spot = airlight::spot({0, 1, 2}, {0, -1, 0}, 0.5f, 0.7f);
    airlight::Media air;
    air.channels = 3;
    air.mu_a = {mu, thin, dense}, air.mu_s = {dense, thin, mu};
    const airlight_medium one_air = airlight::medium({0.1f, 0.2f, 0.3f}, {0.3f, 0.2f, 0.1f}, 0.0f);
    const Column u = in(&Item::u, 0);
    std::vector<std::vector<float>> color(3, zero), same(3, zero);
    airlight::Samples of_colors;
    of_colors.u = u, of_colors.weight = {color[0], color[1], color[2]};
    (void)airlight::sample(options, rays, spots, air, of_colors);
    of_colors.weight = {same[0], same[1], same[2]};
    (void)airlight::sample(options, rays, spot, one_air, of_colors);
    (void)airlight::sample_one(options, ray, spot, one_air, 0.25f, sample);
    for (int c = 0; c < 3; ++c) good = good && color[c] == same[c] && sample.weight[c] == color[c][n - 1];
    good = good && sample.weight[0] > sample.weight[1] && sample.weight[2] > 0 && sample.weight[3] == 0;
    std::array<float, 3> colors = {};
    const std::vector<float> at(n, sample.t);
    (void)airlight::evaluate(options, rays, spots, air, at, {color[0], color[1], color[2]});
    (void)airlight::evaluate_one(options, ray, spot, one_air, sample.t, colors.data());
    for (int c = 0; c < 3; ++c) good = good && colors[c] == color[c][n - 1] && colors[c] > 0;
    (void)airlight::radiance(options, rays, spots, air, {color[0], color[1], color[2]});
    (void)airlight::radiance_one(options, ray, spot, one_air, colors.data());
    for (int c = 0; c < 3; ++c) good = good && colors[c] == color[c][n - 1] && colors[c] > 0;

    good = good && throws("u has 9999 elements, expected 10000", [&] {
        airlight::Samples wrong = samples;
        wrong.u.size -= 1;
        return airlight::sample(options, rays, lamps[0], fog, wrong);
    });
    good = good && throws("t has 0 numbers for each ray, expected 2", [&] {
        airlight::Samples wrong = samples;
        std::vector<float> short_of_one(2 * n - 1);
        wrong.t = Output(short_of_one).by(2);
        wrong.t.size = n;
        return airlight::sample(options, rays, lamps[0], fog, wrong);
    });
    good = good && throws("weights has 2 elements, expected 1", [&] {
        return airlight::choose(options, rays, {lamps, 1}, weights, fog, in(&Item::u, 0, 1), index, probability);
    });
    good = good && throws("options.strategy is 99, expected an airlight_strategy", [&] {
        airlight::Options wrong = options;
        wrong.strategy = static_cast<airlight_strategy>(99);
        return airlight::sample(wrong, rays, lamps[0], fog, samples);
    });
    good = good && throws("values.value[1] is NULL, expected 3 columns, one for each channel",
                          [&] { return airlight::radiance(options, rays, spots, air, {value}); });
    good = good && throws("weight has 2 numbers for each ray, expected 1", [&] {
        airlight::Samples wrong;
        wrong.u = u;
        for (int c = 0; c < 3; ++c) wrong.weight[c] = c < 2 ? Output(color[c]) : samples.t;
        return airlight::sample(options, rays, spots, air, wrong);
    });
    std::puts(good ? "good" : "WRONG");
    return good ? 0 : 1;
}
