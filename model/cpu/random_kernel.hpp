// Random numbers by counter: Philox4x32-10 (Salmon et al. 2011). No state, so no order: any thread may take any place.
#pragma once

#include <cstdint>

#include "base/random/philox.hpp"

namespace actformer::model::cpu {

/// Where a stream of numbers is in the space of all: numbers of different places have nothing to do with each other.
struct RandomPlace {
    std::uint64_t seed = 0, index = 0;  ///< index below 2^56
    std::uint8_t purpose = 0;
};

/// Four random words.
PhiloxWords random_words(const RandomPlace& place, std::uint64_t sample, std::uint32_t block);

/// values (samples, count): standard normal numbers, those of sample first + i in row i. A row's first numbers are the same
/// for every count. Numbers come by 64: words 0 and 1, then 2 and 3, of 16 blocks give 16 cosines and 16 sines each (Box and
/// Muller).
void normal_numbers(const RandomPlace& place, std::uint64_t first, std::int64_t samples, std::int64_t count,
                    float* values, int threads);

/// Dropout (Srivastava et al. 2014) of a layer's numbers: a share `rate` becomes 0, the others grow so that the mean stays.
struct Dropout {
    double rate = 0;  ///< in steps of 2^-16
    RandomPlace place = {};
    std::uint64_t first_sample = 0;  ///< of a batch's part: how many samples of it others draw before these

    bool drops() const { return rate > 0; }
    std::uint32_t threshold() const;  ///< of 16 bits, below which a number is dropped
    double scale() const;             ///< of those that stay
    std::uint64_t seed() const;       ///< for a generator that draws a batch's part in one go
};

/// A mask has a bit a number, 16 a word, the first number's the lowest; every row begins with a word.
constexpr std::int64_t numbers_a_word = 16;

inline std::int64_t words_for(std::int64_t columns) {
    return (columns + numbers_a_word - 1) / numbers_a_word;
}

/// The bits of `words` words of the batch's sample `sample`: set for what stays.
void draw_kept(const Dropout& dropout, std::int64_t sample, std::int64_t words, std::uint16_t* kept);

/// Every channel's numbers over the frames times its factor: to (draws, frames, channels) at (n, t, c) = the sum over s, or
/// over s <= t where factors are `triangular`, of factors (frames, frames, channels) at (t, s, c) times normals (draws, frames,
/// channels) at (n, s, c).
void correlate(const float* normals, const float* factors, std::int64_t draws, std::int64_t frames,
               std::int64_t channels, bool triangular, float* to, int threads);

}  // namespace actformer::model::cpu
