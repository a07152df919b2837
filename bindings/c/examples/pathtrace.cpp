// Renders a box of tinted fog with a spot and a ball that casts a shadow, twice: ray by ray, and as a batch. The bits are
// equal.
//
//     pathtrace PICTURE.ppm [SIDE]      a square of 256 pixels a side unless told otherwise
//
// The estimates without shadows are held to the radiance that airlight integrates.

#include "airlight.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <vector>

namespace {

using airlight::Vec3;

constexpr std::size_t samples_per_ray = 4;
constexpr float pi = 3.14159265f, intensity = 30.0f, ball_radius = 0.7f;
constexpr Vec3 lamp_position = {0.0f, 1.9f, 3.6f}, lamp_axis = {0.0f, -1.0f, 0.0f}, ball = {0.2f, -0.3f, 3.4f};
// Half of the angles to which the spot shines at all, and in full: 60 and 35 degrees.
constexpr float cos_outer = 0.5f, cos_inner = 0.82f;
constexpr Vec3 mu_a = {0.01f, 0.02f, 0.04f}, mu_s = {0.08f, 0.12f, 0.18f};

Vec3 operator+(const Vec3 &a, const Vec3 &b) { return {a[0] + b[0], a[1] + b[1], a[2] + b[2]}; }
Vec3 operator-(const Vec3 &a, const Vec3 &b) { return {a[0] - b[0], a[1] - b[1], a[2] - b[2]}; }
Vec3 operator*(float s, const Vec3 &a) { return {s * a[0], s * a[1], s * a[2]}; }
Vec3 operator*(const Vec3 &a, const Vec3 &b) { return {a[0] * b[0], a[1] * b[1], a[2] * b[2]}; }
float dot(const Vec3 &a, const Vec3 &b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }

float luminance(const Vec3 &color) { return dot(color, {0.2126f, 0.7152f, 0.0722f}); }

// Where a ray meets the ball; infinite if it does not.
float to_ball(const Vec3 &origin, const Vec3 &direction) {
    const Vec3 o = origin - ball;
    const float b = dot(o, direction), d = b * b - dot(o, o) + ball_radius * ball_radius;
    const float t = -b - std::sqrt(std::max(d, 0.0f));
    return d > 0.0f && t > 1e-4f ? t : INFINITY;
}

// What a ray of the camera meets: distance, normal, albedo.
struct Hit {
    float t;
    Vec3 normal;
    Vec3 albedo;
};

// Walls at x, y = -2 and 2, and at z = 6; the camera is in the origin.
Hit hit(const Vec3 &direction) {
    Hit nearest = {to_ball({}, direction), {}, {0.8f, 0.8f, 0.8f}};
    if (nearest.t < INFINITY) nearest.normal = (1.0f / ball_radius) * (nearest.t * direction - ball);
    for (std::size_t k = 0; k < 3; ++k) {
        const float wall = k == 2 ? 6.0f : 2.0f, t = wall / std::abs(direction[k]);
        if (!(t < nearest.t)) continue;
        nearest.t = t;
        nearest.normal = {};
        nearest.normal[k] = direction[k] < 0.0f ? 1.0f : -1.0f;
        const bool left = k == 0 && direction[k] < 0.0f, right = k == 0 && !left;
        nearest.albedo = left ? Vec3{0.6f, 0.1f, 0.1f} : right ? Vec3{0.1f, 0.5f, 0.1f} : Vec3{0.7f, 0.7f, 0.7f};
    }
    return nearest;
}

// What the fog lets through on a way of so many metres.
Vec3 transmittance(float length) {
    const Vec3 depth = length * (mu_a + mu_s);
    return {std::exp(-depth[0]), std::exp(-depth[1]), std::exp(-depth[2])};
}

// How the spot's intensity falls off from the inner to the outer cone.
float falloff(float cosine) {
    const float s = std::clamp((cosine - cos_outer) / (cos_inner - cos_outer), 0.0f, 1.0f);
    return s * s * (3.0f - 2.0f * s);
}

bool sees_lamp(const Vec3 &from) {
    const Vec3 way = lamp_position - from;
    const float distance = std::sqrt(dot(way, way));
    return to_ball(from, (1.0f / distance) * way) > distance;
}

// What a surface sends back along the ray, dimmed by the fog on both legs.
Vec3 surface(const Hit &hit, const Vec3 &direction) {
    const Vec3 point = hit.t * direction, way = lamp_position - point;
    const float r = std::sqrt(dot(way, way));
    const float light = std::max(dot(hit.normal, way) / r, 0.0f) * falloff(-dot(lamp_axis, way) / r);
    if (light == 0.0f || !sees_lamp(point + 1e-3f * hit.normal)) return {};
    return (intensity * light / (r * r) / pi) * transmittance(hit.t + r) * hit.albedo;
}

[[noreturn]] void fail(const char *what) {
    std::fprintf(stderr, "pathtrace: %s\n", what);
    std::exit(1);
}

void require(const airlight::Result &result) {
    if (!result) fail(result.message().c_str());
}

std::uint64_t state = 7;

float uniform() {
    state = state * 6364136223846793005u + 1442695040888963407u;
    return static_cast<float>(state >> 40) / 16777216.0f;
}

} // namespace

int main(int argc, char **argv) {
    if (argc < 2) fail("where should the picture go?");
    const std::size_t side = argc > 2 ? std::strtoul(argv[2], nullptr, 10) : 256, rays = side * side;

    // Rays of the camera, in columns; all start in the origin.
    std::vector<float> zero(rays), x(rays), y(rays), z(rays), t_max(rays), u(rays * samples_per_ray);
    std::vector<Hit> hits(rays);
    for (std::size_t i = 0; i < rays; ++i) {
        const float px = (static_cast<float>(i % side) + 0.5f) / static_cast<float>(side) - 0.5f;
        const float py = 0.5f - (static_cast<float>(i / side) + 0.5f) / static_cast<float>(side);
        const float length = std::sqrt(px * px + py * py + 0.49f);
        x[i] = px / length, y[i] = py / length, z[i] = 0.7f / length;
        hits[i] = hit({x[i], y[i], z[i]});
        t_max[i] = hits[i].t;
        for (std::size_t k = 0; k < samples_per_ray; ++k)
            u[i * samples_per_ray + k] = (static_cast<float>(k) + uniform()) / samples_per_ray;
    }
    const airlight_emitter lamp = airlight::spot(lamp_position, lamp_axis, cos_outer, cos_inner);
    const airlight_medium fog = airlight::medium(mu_a, mu_s, 0.3f);
    const airlight::Options options;

    // As a batch; weights and radiances in each channel.
    const airlight::Rays batch = {{zero, zero, zero}, {x, y, z}, {}, t_max};
    std::vector<float> t(u.size());
    std::array<std::vector<float>, 3> weight, radiance;
    airlight::Samples samples;
    samples.u = airlight::Column(u).by(samples_per_ray);
    samples.t = airlight::Output(t).by(samples_per_ray);
    for (std::size_t c = 0; c < 3; ++c) {
        weight[c].resize(u.size()), radiance[c].resize(rays);
        samples.weight[c] = airlight::Output(weight[c]).by(samples_per_ray);
    }
    airlight_counts counts = {};
    require(airlight::sample(options, batch, lamp, fog, samples, &counts));
    require(airlight::radiance(options, batch, lamp, fog, {radiance[0], radiance[1], radiance[2]}));
    if (counts.invalid != 0) fail("invalid rays");

    // A column of another length is named, and nothing is called.
    samples.t = t;
    const airlight::Result refused = airlight::sample(options, batch, lamp, fog, samples);
    if (refused || refused.message().rfind("t has ", 0) != 0) fail("a column of another length was taken");

    // Ray by ray, with shadows.
    std::vector<unsigned char> picture;
    double fog_light = 0.0, unshadowed = 0.0, squares = 0.0, truth = 0.0;
    for (std::size_t i = 0; i < rays; ++i) {
        const Vec3 direction = {x[i], y[i], z[i]};
        const airlight_ray ray = airlight::ray({}, direction, 0.0f, t_max[i]);
        Vec3 in_fog = {};
        double all = 0.0;
        for (std::size_t k = i * samples_per_ray; k < (i + 1) * samples_per_ray; ++k) {
            airlight_one_sample sample = {};
            require(airlight::sample_one(options, ray, lamp, fog, u[k], sample));
            const Vec3 in_batch = {weight[0][k], weight[1][k], weight[2][k]};
            if (std::memcmp(&sample.t, &t[k], sizeof(float)) != 0 ||
                std::memcmp(sample.weight, in_batch.data(), sizeof in_batch) != 0)
                fail("a ray of its own has other bits than in the batch");
            const Vec3 estimate = (1.0f / samples_per_ray) * in_batch;
            all += luminance(estimate);
            if (sees_lamp(sample.t * direction)) in_fog = in_fog + intensity * estimate;
        }
        const double known = luminance({radiance[0][i], radiance[1][i], radiance[2][i]});
        fog_light += luminance(in_fog) / static_cast<double>(rays);
        unshadowed += all / static_cast<double>(rays);
        truth += known / static_cast<double>(rays);
        squares += (all - known) * (all - known);
        const Vec3 color = surface(hits[i], direction) + in_fog;
        for (const float c : color)
            picture.push_back(static_cast<unsigned char>(255.0f * std::pow(std::min(1.5f * c / (0.3f + c), 1.0f), 0.6f)));
    }
    const double error = std::sqrt(squares) / static_cast<double>(rays), sigmas = (unshadowed - truth) / error;
    std::printf("%zu rays, %zu samples each: light of the fog %.5f\n", rays, samples_per_ray, fog_light);
    std::printf("without the shadow %.6e +- %.1e, radiance %.6e, z %+.2f\n", unshadowed, error, truth, sigmas);
    if (!(std::abs(sigmas) < 4.0) || !(fog_light < intensity * unshadowed)) fail("the estimate is wrong");

    std::FILE *file = std::fopen(argv[1], "wb");
    if (file == nullptr) fail("the picture cannot be written");
    std::fprintf(file, "P6\n%zu %zu\n255\n", side, side);
    const bool written = std::fwrite(picture.data(), 1, picture.size(), file) == picture.size();
    if (std::fclose(file) != 0 || !written) fail("the picture cannot be written");
    return 0;
}
