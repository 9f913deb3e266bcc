#include "model/cpu/random_kernel.hpp"

#include <omp.h>

#include <algorithm>
#include <cmath>

#include "base/random/splitmix.hpp"
#include "model/cpu/vector_math.hpp"

namespace actformer::model::cpu {
namespace {

/// Seed and draw make the key, mixed so that near ones have nothing to do with each other.
PhiloxKey key_of(const RandomPlace& place) {
    const auto x = mixed(mixed(place.seed) + ((place.index << 8) | place.purpose));
    return {static_cast<std::uint32_t>(x), static_cast<std::uint32_t>(x >> 32)};
}

/// Blocks whose words are made together.
constexpr int together = 16;
constexpr std::int64_t numbers_together = 4 * together;

/// The words of blocks first .. first + 15 of a sample, (4, 16).
void make_words(PhiloxKey key, std::uint64_t sample, std::uint32_t first,
                std::uint32_t (&words)[4][together]) {
    for (std::uint32_t i = 0; i < together; ++i) {
        words[0][i] = first + i;
        words[1][i] = static_cast<std::uint32_t>(sample);
        words[2][i] = static_cast<std::uint32_t>(sample >> 32);
        words[3][i] = 0;
    }
    for (int round = 0; round < philox_rounds; ++round, key[0] += philox_step[0], key[1] += philox_step[1])
#pragma omp simd
        for (int i = 0; i < together; ++i) {
            const auto a = std::uint64_t{philox_factor_a} * words[0][i],
                       b = std::uint64_t{philox_factor_b} * words[2][i];
            words[0][i] = static_cast<std::uint32_t>(b >> 32) ^ words[1][i] ^ key[0];
            words[1][i] = static_cast<std::uint32_t>(b);
            words[2][i] = static_cast<std::uint32_t>(a >> 32) ^ words[3][i] ^ key[1];
            words[3][i] = static_cast<std::uint32_t>(a);
        }
}

/// In (0, 1], in steps of 2^-24.
Floats portion(const std::uint32_t* words) {
    Floats out;
    for (std::ptrdiff_t i = 0; i < lanes<float>; ++i)
        out[i] = static_cast<float>((words[i] >> 8) + 1) * 0x1p-24F;
    return out;
}

/// 64 numbers of a sample.
void make_normals(PhiloxKey key, std::uint64_t sample, std::uint32_t first_block, float* to) {
    std::uint32_t words[4][together];
    make_words(key, sample, first_block, words);
    for (int half = 0; half < 2; ++half)
        for (std::ptrdiff_t i = 0; i < together; i += lanes<float>) {
            const auto radius = root(-2.0F * logarithm(portion(words[2 * half] + i)));
            const auto turn = turned(portion(words[2 * half + 1] + i));
            float* at = to + 2 * half * together + i;
            store(at, radius * turn.cosine);
            store(at + together, radius * turn.sine);
        }
}

/// Bit i: whether 16 bits of word i, from bit `shift` on, are at least `threshold`.
std::uint16_t at_least(const std::uint32_t (&words)[together], int shift, std::uint32_t threshold) {
#if defined(__AVX512F__)
    const auto shifted = _mm512_maskz_srlv_epi32(0xFFFF, _mm512_loadu_si512(words), _mm512_set1_epi32(shift));
    const auto halves = _mm512_and_epi32(shifted, _mm512_set1_epi32(0xFFFF));
    return _mm512_cmpge_epu32_mask(halves, _mm512_set1_epi32(static_cast<int>(threshold)));
#else
    std::uint32_t bits = 0;
    for (int i = 0; i < together; ++i)
        bits |= static_cast<std::uint32_t>((words[i] >> shift & 0xFFFF) >= threshold) << i;
    return static_cast<std::uint16_t>(bits);
#endif
}

}  // namespace

std::uint32_t Dropout::threshold() const {
    return static_cast<std::uint32_t>(std::lround(rate * 0x1p16));
}

double Dropout::scale() const {
    return 1 / (1 - threshold() * 0x1p-16);
}

std::uint64_t Dropout::seed() const {
    const auto key = key_of(place);
    return mixed((std::uint64_t{key[1]} << 32 | key[0]) + first_sample);
}

void draw_kept(const Dropout& dropout, std::int64_t sample, std::int64_t words, std::uint16_t* kept) {
    const auto key = key_of(dropout.place);
    const auto number = dropout.first_sample + static_cast<std::uint64_t>(sample);
    const auto threshold = dropout.threshold();
    constexpr std::int64_t words_together = 8;
    for (std::int64_t i = 0; i < words; i += words_together) {
        std::uint32_t random[4][together];
        make_words(key, number, static_cast<std::uint32_t>(i / words_together) * together, random);
        for (std::int64_t w = i; w < std::min(i + words_together, words); ++w)
            kept[w] = at_least(random[(w - i) / 2], (w - i) % 2 == 0 ? 0 : 16, threshold);
    }
}

PhiloxWords random_words(const RandomPlace& place, std::uint64_t sample, std::uint32_t block) {
    return philox({block, static_cast<std::uint32_t>(sample), static_cast<std::uint32_t>(sample >> 32), 0},
                  key_of(place));
}

void normal_numbers(const RandomPlace& place, std::uint64_t first, std::int64_t samples, std::int64_t count,
                    float* values, int threads) {
    const auto key = key_of(place);
#pragma omp parallel for num_threads(threads) schedule(static)
    for (std::int64_t s = 0; s < samples; ++s) {
        const auto sample = first + static_cast<std::uint64_t>(s);
        float* to = values + s * count;
        std::int64_t i = 0;
        const auto block = [&] { return static_cast<std::uint32_t>(i / 4); };
        for (; i + numbers_together <= count; i += numbers_together)
            make_normals(key, sample, block(), to + i);
        if (i == count) continue;
        float rest[numbers_together];
        make_normals(key, sample, block(), rest);
        std::copy_n(rest, count - i, to + i);
    }
}

void correlate(const float* normals, const float* factors, std::int64_t draws, std::int64_t frames,
               std::int64_t channels, bool triangular, float* to, int threads) {
    constexpr std::int64_t side_by_side = 4;  // draws that share what is read of the factors
    const auto draw = frames * channels;
#pragma omp parallel for num_threads(threads) schedule(static)
    for (std::int64_t n = 0; n < draws; n += side_by_side) {
        const float* from[side_by_side];
        for (std::int64_t i = 0; i < side_by_side; ++i) from[i] = normals + std::min(n + i, draws - 1) * draw;
        for (std::int64_t t = 0; t < frames; ++t)
            for (std::int64_t c = 0; c < channels; c += lanes<float>) {
                const auto here = std::min<std::int64_t>(lanes<float>, channels - c);
                Floats sums[side_by_side] = {};
                for (std::int64_t s = 0; s < (triangular ? t + 1 : frames); ++s) {
                    const auto factor = load_part(factors + (t * frames + s) * channels + c, here);
                    for (std::int64_t i = 0; i < side_by_side; ++i)
                        sums[i] += factor * load_part(from[i] + s * channels + c, here);
                }
                for (std::int64_t i = 0; i < std::min(side_by_side, draws - n); ++i)
                    store_part(to + (n + i) * draw + t * channels + c, sums[i], here);
            }
    }
}

}  // namespace actformer::model::cpu
