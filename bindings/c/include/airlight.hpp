// airlight for C++17, header only: airlight.h with columns that know their length.
//
// Nothing here owns memory or allocates, but for the message of a call that fails. Calls return a Result; where
// AIRLIGHT_EXCEPTIONS is defined (in every translation unit, before this header) they throw airlight::Error instead.

#ifndef AIRLIGHT_HPP
#define AIRLIGHT_HPP

#include "airlight.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <iterator>
#include <string>
#include <type_traits>
#include <utility>

#ifdef AIRLIGHT_EXCEPTIONS
#include <stdexcept>
#endif

namespace airlight {

// A column: `size` elements of `width` numbers each, one every `stride` bytes (0: next to each other). Without data it is
// not given. It is made of whatever has data() and size(): std::vector, std::array, std::span.
template <class T>
struct View {
    T *data = nullptr;
    std::size_t size = 0;
    std::size_t stride = 0;
    std::size_t width = 1;

    constexpr View() = default;
    constexpr View(T *data, std::size_t size, std::size_t stride = 0) : data(data), size(size), stride(stride) {}

    template <class C, class = std::enable_if_t<std::is_convertible_v<
                           std::remove_pointer_t<decltype(std::data(std::declval<C &>()))> (*)[], T (*)[]>>>
    constexpr View(C &&column) : data(std::data(column)), size(std::size(column)) {}

    // A member of each struct of a queue: View<const float>::of(queue.data(), queue.size(), &Item::t_max).
    template <class S, class Q>
    static constexpr View of(Q *queue, std::size_t size, std::remove_const_t<T> S::*member) {
        return View(size == 0 ? nullptr : &(queue->*member), size, sizeof(S));
    }
    // Elements of an array that each struct of a queue has, from `first` on: so many of them, next to each other.
    template <class S, class Q, std::size_t N>
    static constexpr View of(Q *queue, std::size_t size, std::remove_const_t<T> (S::*member)[N], std::size_t first,
                             std::size_t width = 1) {
        View view(size == 0 ? nullptr : &(queue->*member)[first], size, sizeof(S));
        view.width = width;
        return view;
    }

    // The same numbers, so many for each ray; a call refuses them if they are no multiple of that.
    constexpr View by(std::size_t per_ray) const {
        View view = *this;
        const bool fits = per_ray > 0 && size % per_ray == 0;
        view.size = fits ? size / per_ray : size;
        view.width = fits ? per_ray : 0;
        return view;
    }
};

using Column = View<const float>;
using Output = View<float>;
using Indices = View<const std::uint32_t>;
using IndexOutput = View<std::uint32_t>;

// What came of a call.
class [[nodiscard]] Result {
  public:
    explicit Result(airlight_status status)
        : status_(status), message_(status == AIRLIGHT_STATUS_OK ? "" : airlight_last_message()) {}
    Result(airlight_status status, std::string message) : status_(status), message_(std::move(message)) {}

    explicit operator bool() const { return status_ == AIRLIGHT_STATUS_OK; }
    airlight_status status() const { return status_; }
    const std::string &message() const { return message_; }

  private:
    airlight_status status_;
    std::string message_;
};

#ifdef AIRLIGHT_EXCEPTIONS
struct Error : std::runtime_error {
    explicit Error(const Result &result) : std::runtime_error(result.message()), status(result.status()) {}
    airlight_status status;
};
#endif

// How a call is done; see airlight_options.
struct Options {
    airlight_strategy strategy = AIRLIGHT_STRATEGY_DEFAULT;
    airlight_precision precision = AIRLIGHT_PRECISION_EXACT;
    std::uint32_t nodes = 0;
    airlight_backend backend = AIRLIGHT_BACKEND_FASTEST;
    std::uint32_t threads = 0;
};

// Rays `origin + t direction` from `t_min` (0 unless given) to `t_max`.
struct Rays {
    std::array<Column, 3> origin;
    std::array<Column, 3> direction;
    Column t_min;
    Column t_max;
};

using Vec3 = std::array<float, 3>;

inline airlight_emitter point(const Vec3 &p) {
    return {AIRLIGHT_EMITTER_KIND_POINT, {p[0], p[1], p[2]}, {0, 0, 0}, 0, 0};
}
inline airlight_emitter point_normal(const Vec3 &p, const Vec3 &n) {
    return {AIRLIGHT_EMITTER_KIND_POINT_NORMAL, {p[0], p[1], p[2]}, {n[0], n[1], n[2]}, 0, 0};
}
inline airlight_emitter spot(const Vec3 &p, const Vec3 &axis, float cos_outer, float cos_inner) {
    return {AIRLIGHT_EMITTER_KIND_SPOT, {p[0], p[1], p[2]}, {axis[0], axis[1], axis[2]}, cos_outer, cos_inner};
}
inline airlight_medium medium(float mu_a, float mu_s, float g) { return {1, {mu_a}, {mu_s}, g}; }
inline airlight_medium medium(const Vec3 &mu_a, const Vec3 &mu_s, float g) {
    return {3, {mu_a[0], mu_a[1], mu_a[2]}, {mu_s[0], mu_s[1], mu_s[2]}, g};
}
inline airlight_ray ray(const Vec3 &o, const Vec3 &d, float t_min, float t_max) {
    return {{o[0], o[1], o[2]}, {d[0], d[1], d[2]}, t_min, t_max};
}

// The emitter of each ray: one, `table` and `index`, or columns; with the cosines they are those of spots.
struct Emitters {
    airlight_emitter one = {};
    View<const airlight_emitter> table;
    Indices index;
    std::array<Column, 3> position;
    std::array<Column, 3> direction;
    Column cos_outer, cos_inner;

    Emitters() = default;
    Emitters(const airlight_emitter &one) : one(one) {}
    Emitters(View<const airlight_emitter> table, Indices index) : table(table), index(index) {}
};

// The medium of each ray: one, `table` and `index`, or columns of so many `channels`.
struct Media {
    airlight_medium one = {};
    View<const airlight_medium> table;
    Indices index;
    std::uint32_t channels = 1;
    std::array<Column, 4> mu_a;
    std::array<Column, 4> mu_s;
    Column g;

    Media() = default;
    Media(const airlight_medium &one) : one(one) {}
    Media(View<const airlight_medium> table, Indices index) : table(table), index(index) {}
};

// What `sample` reads and writes; `by(k)` of columns for k samples for each ray. A weight for each channel of the media, or
// none.
struct Samples {
    Column u;
    Output t, pdf;
    std::array<Output, 4> weight;
    Output r;
};

namespace detail {

// Makes the structs of a call, and holds every column to the number of rays.
class Call {
  public:
    Call(const Options &options, const Rays &rays, const Emitters *emitters, const Media &media) {
        options_ = {sizeof options_, options.strategy, options.precision, options.nodes, options.backend, options.threads};
        batch_.struct_size = sizeof batch_;
        batch_.count = count_ = rays.origin[0].size;
        columns(batch_.origin, rays.origin, "origin");
        columns(batch_.direction, rays.direction, "direction");
        batch_.t_min = column<airlight_column>(rays.t_min, "t_min");
        batch_.t_max = column<airlight_column>(rays.t_max, "t_max");
        if (emitters != nullptr) lit_by(*emitters);
        in(media);
        batch_.emitters = &emitters_;
        batch_.media = &media_;
    }
    Call(const Call &) = delete;
    Call &operator=(const Call &) = delete;

    // The same column in C, if it has an element of so many numbers for each ray.
    template <class C, class T>
    C column(const View<T> &view, const char *name, std::size_t width = 1) {
        if (view.data != nullptr) {
            check(view.size, count_, name, " elements");
            check(view.width, width, name, " numbers for each ray");
        }
        return {view.data, view.stride};
    }
    template <class C, class T, std::size_t N>
    void columns(C (&to)[N], const std::array<View<T>, N> &from, const char *name, std::size_t width = 1) {
        for (std::size_t k = 0; k < N; ++k) to[k] = column<C>(from[k], name, width);
    }
    void check(std::size_t found, std::size_t expected, const char *name, const char *what) {
        if (found == expected || !wrong_.empty()) return;
        wrong_ = std::string(name) + " has " + std::to_string(found) + what + ", expected " + std::to_string(expected);
    }

    void lit_by(const Emitters &emitters) {
        const bool is_table = emitters.table.data != nullptr, is_one = emitters.position[0].data == nullptr;
        emitters_.struct_size = sizeof emitters_;
        emitters_.table = is_table ? emitters.table.data : is_one ? &emitters.one : nullptr;
        emitters_.table_count = is_table ? emitters.table.size : 1;
        emitters_.index = column<airlight_index_column>(emitters.index, "emitters.index");
        columns(emitters_.position, emitters.position, "emitters.position");
        columns(emitters_.direction, emitters.direction, "emitters.direction");
        emitters_.cos_outer = column<airlight_column>(emitters.cos_outer, "emitters.cos_outer");
        emitters_.cos_inner = column<airlight_column>(emitters.cos_inner, "emitters.cos_inner");
    }
    void lit_by_any(View<const airlight_emitter> table) {
        emitters_.struct_size = sizeof emitters_;
        emitters_.table = table.data;
        emitters_.table_count = table.size;
    }

    // Makes a call, unless a column is too long or too short.
    template <class F, class A>
    Result make(F function, const A &arguments, airlight_counts *counts) {
        if (counts != nullptr) counts->struct_size = sizeof *counts;
        Result result = wrong_.empty() ? Result(function(&options_, &batch_, &arguments, counts))
                                       : Result(AIRLIGHT_STATUS_LENGTH, wrong_);
        return done(std::move(result));
    }
    static Result done(Result result) {
#ifdef AIRLIGHT_EXCEPTIONS
        if (!result) throw Error(result);
#endif
        return result;
    }
    const airlight_options *options() const { return &options_; }

  private:
    void in(const Media &media) {
        const bool is_table = media.table.data != nullptr, is_one = media.mu_s[0].data == nullptr;
        media_.struct_size = sizeof media_;
        media_.table = is_table ? media.table.data : is_one ? &media.one : nullptr;
        media_.table_count = is_table ? media.table.size : 1;
        media_.index = column<airlight_index_column>(media.index, "media.index");
        media_.channels = media.channels;
        columns(media_.mu_a, media.mu_a, "media.mu_a");
        columns(media_.mu_s, media.mu_s, "media.mu_s");
        media_.g = column<airlight_column>(media.g, "media.g");
    }

    airlight_options options_ = {};
    airlight_batch batch_ = {};
    airlight_emitters emitters_ = {};
    airlight_media media_ = {};
    std::size_t count_ = 0;
    std::string wrong_;
};

inline airlight_options options(const Options &o) {
    return {sizeof(airlight_options), o.strategy, o.precision, o.nodes, o.backend, o.threads};
}

inline airlight_scene scene(const airlight_ray &ray, const airlight_emitter &emitter, const airlight_medium &medium) {
    return {sizeof(airlight_scene), ray, emitter, medium};
}

// The calls at given distances.
template <class F>
Result at(F function, const Options &options, const Rays &rays, const Emitters &emitters, const Media &media,
          const Column &t, const std::array<Output, 4> &value, airlight_counts *counts) {
    Call call(options, rays, &emitters, media);
    airlight_values values = {};
    values.struct_size = sizeof values;
    values.per_ray = t.width;
    values.t = call.column<airlight_column>(t, "t", t.width);
    call.columns(values.value, value, "value", t.width);
    return call.make(function, values, counts);
}

} // namespace detail

// airlight_sample
inline Result sample(const Options &options, const Rays &rays, const Emitters &emitters, const Media &media,
                     const Samples &samples, airlight_counts *counts = nullptr) {
    detail::Call call(options, rays, &emitters, media);
    const std::size_t per_ray = samples.u.width;
    airlight_samples in_c = {};
    in_c.struct_size = sizeof in_c;
    in_c.per_ray = per_ray;
    in_c.u = call.column<airlight_column>(samples.u, "u", per_ray);
    in_c.t = call.column<airlight_output>(samples.t, "t", per_ray);
    in_c.pdf = call.column<airlight_output>(samples.pdf, "pdf", per_ray);
    call.columns(in_c.weight, samples.weight, "weight", per_ray);
    in_c.r = call.column<airlight_output>(samples.r, "r", per_ray);
    return call.make(airlight_sample, in_c, counts);
}

// airlight_pdf
inline Result pdf(const Options &options, const Rays &rays, const Emitters &emitters, const Media &media, const Column &t,
                  const Output &pdf, airlight_counts *counts = nullptr) {
    return detail::at(airlight_pdf, options, rays, emitters, media, t, {pdf}, counts);
}

// airlight_cdf
inline Result cdf(const Options &options, const Rays &rays, const Emitters &emitters, const Media &media, const Column &t,
                  const Output &cdf, airlight_counts *counts = nullptr) {
    return detail::at(airlight_cdf, options, rays, emitters, media, t, {cdf}, counts);
}

// airlight_evaluate
inline Result evaluate(const Options &options, const Rays &rays, const Emitters &emitters, const Media &media,
                       const Column &t, const std::array<Output, 4> &integrand, airlight_counts *counts = nullptr) {
    return detail::at(airlight_evaluate, options, rays, emitters, media, t, integrand, counts);
}

// airlight_radiance
inline Result radiance(const Options &options, const Rays &rays, const Emitters &emitters, const Media &media,
                       const std::array<Output, 4> &radiance, airlight_counts *counts = nullptr) {
    return detail::at(airlight_radiance, options, rays, emitters, media, {}, radiance, counts);
}

// airlight_choose
inline Result choose(const Options &options, const Rays &rays, View<const airlight_emitter> table, const Column &weights,
                     const Media &media, const Column &u, const IndexOutput &index, const Output &probability,
                     airlight_counts *counts = nullptr) {
    detail::Call call(options, rays, nullptr, media);
    call.lit_by_any(table);
    call.check(weights.size, table.size, "weights", " elements");
    airlight_choices choices = {};
    choices.struct_size = sizeof choices;
    choices.u = call.column<airlight_column>(u, "u");
    choices.weights = {weights.data, weights.stride};
    choices.index = call.column<airlight_index_output>(index, "index");
    choices.probability = call.column<airlight_output>(probability, "probability");
    return call.make(airlight_choose, choices, counts);
}

// airlight_sample_one
inline Result sample_one(const Options &options, const airlight_ray &ray, const airlight_emitter &emitter,
                         const airlight_medium &medium, float u, airlight_one_sample &sample) {
    const airlight_options in_c = detail::options(options);
    const airlight_scene scene = detail::scene(ray, emitter, medium);
    sample.struct_size = sizeof sample;
    return detail::Call::done(Result(airlight_sample_one(&in_c, &scene, u, &sample)));
}

// airlight_pdf_one
inline Result pdf_one(const Options &options, const airlight_ray &ray, const airlight_emitter &emitter,
                      const airlight_medium &medium, float t, float &pdf) {
    const airlight_options in_c = detail::options(options);
    const airlight_scene scene = detail::scene(ray, emitter, medium);
    return detail::Call::done(Result(airlight_pdf_one(&in_c, &scene, t, &pdf)));
}

// airlight_cdf_one
inline Result cdf_one(const Options &options, const airlight_ray &ray, const airlight_emitter &emitter,
                      const airlight_medium &medium, float t, float &cdf) {
    const airlight_options in_c = detail::options(options);
    const airlight_scene scene = detail::scene(ray, emitter, medium);
    return detail::Call::done(Result(airlight_cdf_one(&in_c, &scene, t, &cdf)));
}

// airlight_evaluate_one: `integrand` has a float for each channel of the medium.
inline Result evaluate_one(const Options &options, const airlight_ray &ray, const airlight_emitter &emitter,
                           const airlight_medium &medium, float t, float *integrand) {
    const airlight_options in_c = detail::options(options);
    const airlight_scene scene = detail::scene(ray, emitter, medium);
    return detail::Call::done(Result(airlight_evaluate_one(&in_c, &scene, t, integrand)));
}

// airlight_radiance_one: `radiance` has a float for each channel of the medium.
inline Result radiance_one(const Options &options, const airlight_ray &ray, const airlight_emitter &emitter,
                           const airlight_medium &medium, float *radiance) {
    const airlight_options in_c = detail::options(options);
    const airlight_scene scene = detail::scene(ray, emitter, medium);
    return detail::Call::done(Result(airlight_radiance_one(&in_c, &scene, radiance)));
}

} // namespace airlight

#endif
