#include "model/actformer/random_kernel.hpp"

#include <omp.h>

#include <cmath>
#include <numbers>

namespace actformer::model::cpu {
namespace {

using Words = std::array<std::uint32_t, 4>;

struct Key {
    std::uint32_t low, high;
};

inline Words philox(Words counter, Key key) {
    for (int round = 0; round < 10; ++round) {
        const auto a = std::uint64_t{0xD2511F53U} * counter[0], b = std::uint64_t{0xCD9E8D57U} * counter[2];
        counter = {static_cast<std::uint32_t>(b >> 32) ^ counter[1] ^ key.low, static_cast<std::uint32_t>(b),
                   static_cast<std::uint32_t>(a >> 32) ^ counter[3] ^ key.high,
                   static_cast<std::uint32_t>(a)};
        key.low += 0x9E3779B9U;
        key.high += 0xBB67AE85U;
    }
    return counter;
}

/// Seed and draw make the key, by a mixing that sends no two pairs of one seed to one key.
Key key_of(const RandomPlace& place) {
    std::uint64_t x = place.seed;
    x = (x ^ (x >> 30)) * 0xBF58476D1CE4E5B9U;
    x = (x ^ (x >> 27)) * 0x94D049BB133111EBU;
    x ^= x >> 31;
    x += (place.index << 8) | place.purpose;
    x = (x ^ (x >> 30)) * 0xBF58476D1CE4E5B9U;
    x = (x ^ (x >> 27)) * 0x94D049BB133111EBU;
    x ^= x >> 31;
    return {static_cast<std::uint32_t>(x), static_cast<std::uint32_t>(x >> 32)};
}

inline Words words_at(Key key, std::uint64_t sample, std::uint32_t block) {
    return philox({block, static_cast<std::uint32_t>(sample), static_cast<std::uint32_t>(sample >> 32), 0},
                  key);
}

/// In (0, 1].
inline float portion(std::uint32_t word) {
    return (static_cast<float>(word >> 8) + 1) * 0x1p-24F;
}

/// Two normal numbers from two words (Box and Muller).
inline void pair_of(std::uint32_t a, std::uint32_t b, float* to) {
    const float radius = std::sqrt(-2 * std::log(portion(a)));
    const float angle = 2 * std::numbers::pi_v<float> * portion(b);
    to[0] = radius * std::cos(angle);
    to[1] = radius * std::sin(angle);
}

}  // namespace

std::array<std::uint32_t, 4> random_words(const RandomPlace& place, std::uint64_t sample,
                                          std::uint32_t block) {
    return words_at(key_of(place), sample, block);
}

void normal_numbers(const RandomPlace& place, std::uint64_t first, std::int64_t samples, std::int64_t count,
                    float* values, int threads) {
    const auto key = key_of(place);
#pragma omp parallel for num_threads(threads) schedule(static)
    for (std::int64_t s = 0; s < samples; ++s) {
        float* to = values + s * count;
        for (std::int64_t i = 0; i < count; i += 4) {
            const auto words =
                words_at(key, first + static_cast<std::uint64_t>(s), static_cast<std::uint32_t>(i / 4));
            float four[4];
            pair_of(words[0], words[1], four);
            pair_of(words[2], words[3], four + 2);
            for (std::int64_t j = 0; j < 4 && i + j < count; ++j) to[i + j] = four[j];
        }
    }
}

void whole_numbers(const RandomPlace& place, std::uint64_t first, std::int64_t samples, std::uint32_t bound,
                   std::int64_t* values) {
    const auto key = key_of(place);
    for (std::int64_t s = 0; s < samples; ++s) {
        const auto words = words_at(key, first + static_cast<std::uint64_t>(s), 0);
        values[s] = static_cast<std::int64_t>(std::uint64_t{words[0]} * bound >> 32);
    }
}

}  // namespace actformer::model::cpu
