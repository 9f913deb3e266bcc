// Random numbers by counter: Philox4x32-10 (Salmon et al. 2011). No state, so no order: any thread may take any place.
#pragma once

#include <array>
#include <cstdint>

namespace actformer::model::cpu {

/// Where a stream of numbers is in the space of all: numbers of different places have nothing to do with each other.
struct RandomPlace {
    std::uint64_t seed = 0, index = 0;
    std::uint8_t purpose = 0;
};

/// Four random words; place.index below 2^56.
std::array<std::uint32_t, 4> random_words(const RandomPlace& place, std::uint64_t sample,
                                          std::uint32_t block);

/// values (samples, count): standard normal numbers, those of sample first + i in row i.
void normal_numbers(const RandomPlace& place, std::uint64_t first, std::int64_t samples, std::int64_t count,
                    float* values, int threads);

/// values (samples): whole numbers below `bound`.
void whole_numbers(const RandomPlace& place, std::uint64_t first, std::int64_t samples, std::uint32_t bound,
                   std::int64_t* values);

}  // namespace actformer::model::cpu
