#include "kernels/plain_sampler.hpp"

#include <algorithm>
#include <array>

#include "base/random/philox.hpp"

namespace actformer::kernels {
namespace {

std::uint32_t high_product(std::uint32_t a, std::uint32_t b) {
    return static_cast<std::uint32_t>((std::uint64_t{a} * b) >> 32);
}

std::uint64_t high_product(std::uint64_t a, std::uint64_t b) {
    const std::uint64_t a0 = a & 0xFFFF'FFFF, a1 = a >> 32, b0 = b & 0xFFFF'FFFF, b1 = b >> 32;
    const std::uint64_t middle = a1 * b0 + ((a0 * b0) >> 32), other = a0 * b1 + (middle & 0xFFFF'FFFF);
    return a1 * b1 + (middle >> 32) + (other >> 32);
}

/// The frame shown at `t` of a window from `start` on.
std::size_t frame_at(std::uint32_t start, std::uint32_t t, std::uint32_t frames, Padding padding) {
    if (start + t < frames) return start + t;
    if (padding == Padding::hold) return frames - 1;
    if (frames == 1) return 0;
    const auto period = 2 * (frames - 1), phase = t % period;
    return phase < frames ? phase : period - phase;
}

std::uint64_t drawn_order(std::uint32_t persons, PhiloxWords counter, PhiloxKey key) {
    std::uint64_t order = DrawnWindow::own_order;
    PhiloxWords words{};
    for (std::uint32_t i = persons - 1, used = 0; i > 0 && i < 16; --i, ++used) {
        if (used % 4 == 0) {
            ++counter[0];
            words = philox(counter, key);
        }
        const auto j = high_product(words[used % 4], i + 1);
        const auto differ = ((order >> (4 * i)) ^ (order >> (4 * j))) & 15;
        order ^= (differ << (4 * i)) | (i == j ? 0 : differ << (4 * j));
    }
    return order;
}

using Position = std::array<float, 3>;

/// The root's mean over the frames shown and all persons. Not inline: its product must not be contracted with what it is taken from.
[[gnu::noinline]] Position mean_root(const ClipTable& table, std::span<const float> clip,
                                     const DrawnWindow& chosen, Padding padding, std::uint32_t window) {
    Position sum{};
    if (!table.centring) return sum;
    const auto frames = table.frames[chosen.clip];
    for (std::uint32_t t = 0; t < window; ++t)
        for (std::size_t p = 0; p < table.persons; ++p) {
            const auto body = frame_at(chosen.first, t, frames, padding) * table.persons + p;
            for (std::size_t d = 0; d < 3; ++d)
                sum[d] += clip[(body * table.nodes + table.centring->root) * table.numbers + d];
        }
    const float share = 1 / (static_cast<float>(window) * static_cast<float>(table.persons));
    for (auto& s : sum) s *= share;
    return sum;
}

}  // namespace

DrawnWindow drawn(const ClipTable& table, const ClassTable& classes, const SamplerOptions& options,
                  std::uint64_t index, std::uint32_t sample, std::uint32_t window) {
    const auto low = [](std::uint64_t value) { return static_cast<std::uint32_t>(value); };
    const PhiloxKey key{low(options.seed), low(options.seed >> 32)};
    const PhiloxWords counter{0, options.first_sample + sample, low(index), low(index >> 32)};
    const auto words = philox(counter, key);
    const auto at = high_product(std::uint64_t{words[1]} << 32 | words[0], classes.edge.back());
    const auto one = std::ranges::upper_bound(classes.edge, at) - classes.edge.begin();
    const auto first = classes.first[one], count = classes.first[one + 1] - first;
    const auto clip = classes.by_class[first + high_product(words[2], count)];
    const auto frames = table.frames[clip];
    return {clip, frames > window ? high_product(words[3], frames - window + 1) : 0,
            options.permute_persons ? drawn_order(table.persons, counter, key) : DrawnWindow::own_order};
}

void show(const ClipTable& table, std::span<const float> clip, const DrawnWindow& chosen, Padding padding,
          std::uint32_t window, std::span<float> to) {
    const auto centre = mean_root(table, clip, chosen, padding, window);
    const auto moved = table.centring.value_or(Centring{0, 0, 0});
    const std::size_t body_values = std::size_t{table.nodes} * table.numbers;
    for (std::uint32_t t = 0; t < window; ++t) {
        const auto frame = frame_at(chosen.first, t, table.frames[chosen.clip], padding) * table.persons;
        for (std::size_t p = 0; p < table.persons; ++p) {
            const auto body =
                clip.subspan((frame + ((chosen.order >> (4 * p)) & 15)) * body_values, body_values);
            for (std::size_t c = 0; c < table.numbers; ++c) {
                const auto row =
                    to.subspan(((p * table.numbers + c) * window + t) * table.nodes, table.nodes);
                for (std::size_t k = 0; k < table.nodes; ++k) row[k] = body[k * table.numbers + c];
                if (c < 3)
                    for (auto k = moved.first; k < moved.first + moved.count; ++k) row[k] -= centre[c];
            }
        }
    }
}

}  // namespace actformer::kernels
