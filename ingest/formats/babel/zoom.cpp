#include "ingest/formats/babel/zoom.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace actformer::ingest {
namespace {

constexpr std::size_t longest_reach = 64;  // frames: the filter has then decayed by 10^-36

/// The B-spline's coefficients in place of samples (frames, columns): a recursive filter forth and back over the frames.
void filter(std::vector<double>& values, std::size_t frames) {
    if (frames < 2) return;
    const double pole = std::sqrt(3.0) - 2, gain = (1 - pole) * (1 - 1 / pole);
    const std::size_t columns = values.size() / frames;
    const auto row = [&](std::size_t t) { return &values[t * columns]; };
    for (auto& v : values) v *= gain;
    const std::size_t reach = std::min(frames - 1, longest_reach);
    for (std::size_t c = 0; c < columns; ++c) {
        // The sum over the mirrored signal, whose period is 2 frames - 2, in closed form.
        const double whole = std::pow(pole, static_cast<double>(frames - 1));
        double sum = row(0)[c] + whole * row(frames - 1)[c], near = pole, far = whole * whole / pole;
        for (std::size_t t = 1; t < reach; ++t) {
            sum += (near + far) * row(t)[c];
            near *= pole;
            far /= pole;
        }
        row(0)[c] = sum / (1 - whole * whole);
    }
    for (std::size_t t = 1; t < frames; ++t)
        for (std::size_t c = 0; c < columns; ++c) row(t)[c] += pole * row(t - 1)[c];
    for (std::size_t c = 0; c < columns; ++c)
        row(frames - 1)[c] = pole / (pole * pole - 1) * (pole * row(frames - 2)[c] + row(frames - 1)[c]);
    for (std::size_t t = frames - 1; t-- > 0;)
        for (std::size_t c = 0; c < columns; ++c) row(t)[c] = pole * (row(t + 1)[c] - row(t)[c]);
}

/// Weights of the four coefficients around a place that is `u` behind the second.
std::array<double, 4> weights(double u) {
    const double v = 1 - u;
    return {v * v * v / 6, 2.0 / 3 - u * u * (2 - u) / 2, 2.0 / 3 - v * v * (2 - v) / 2, u * u * u / 6};
}

std::size_t mirrored(std::int64_t t, std::size_t frames) {
    const auto last = static_cast<std::int64_t>(frames) - 1;
    if (last == 0) return 0;
    t = std::abs(t) % (2 * last);
    return static_cast<std::size_t>(t > last ? 2 * last - t : t);
}

}  // namespace

std::uint64_t zoomed_frames(std::uint64_t frames, double from, double to) {
    return static_cast<std::uint64_t>(std::nearbyint(static_cast<double>(frames) * (to / from)));
}

std::vector<double> zoomed(std::span<const double> values, std::uint64_t frames, std::uint64_t wanted) {
    const std::size_t columns = values.size() / frames;
    std::vector<double> coefficients(values.begin(), values.end()), out(wanted * columns);
    filter(coefficients, frames);
    const double step = wanted > 1 ? static_cast<double>(frames - 1) / static_cast<double>(wanted - 1) : 1;
    for (std::uint64_t i = 0; i < wanted; ++i) {
        const double at = static_cast<double>(i) * step, whole = std::floor(at);
        const auto w = weights(at - whole);
        double* to = &out[i * columns];
        for (std::size_t k = 0; k < 4; ++k) {
            const double* from =
                &coefficients[mirrored(static_cast<std::int64_t>(whole) + static_cast<std::int64_t>(k) - 1,
                                       frames) *
                              columns];
            for (std::size_t c = 0; c < columns; ++c) to[c] += w[k] * from[c];
        }
    }
    return out;
}

RotationalMotion zoomed(const RotationVectors& file, double from, double to) {
    const std::size_t numbers = 3 * file.joints;
    std::vector<double> vectors(file.frames * numbers), places(file.frames * 3);
    for (std::uint64_t t = 0; t < file.frames; ++t) file.read(t, &vectors[t * numbers], &places[t * 3]);
    const auto wanted = zoomed_frames(file.frames, from, to);
    vectors = zoomed(vectors, file.frames, wanted);
    places = zoomed(places, file.frames, wanted);
    return as_recorded({wanted, file.joints, [&](std::uint64_t t, double* to_vectors, double* to_place) {
                            std::copy_n(&vectors[t * numbers], numbers, to_vectors);
                            std::copy_n(&places[t * 3], 3, to_place);
                        }});
}

}  // namespace actformer::ingest
