#include "base/checksum/fletcher32.hpp"

#include <algorithm>
#include <array>
#include <cstring>

namespace actformer {
namespace {

constexpr std::uint64_t modulus = 65535;
constexpr std::size_t lanes = 32;

/// The sum of some words, and the sum of the sums after each of them.
struct Sums {
    std::uint64_t one = 0, two = 0;

    void append(const Sums& next, std::size_t words) {
        two = (two + words % modulus * one + next.two) % modulus;
        one = (one + next.one) % modulus;
    }
};

/// Of `steps` times `lanes` words: word k * lanes + j belongs to lane j, and counts lanes * (steps - k) - j times in the
/// second sum. Up to 256 steps, so that 32 bits hold a lane.
Sums sums_of(const char* words, std::size_t steps) {
    std::array<std::uint32_t, lanes> one{}, two{};
    for (std::size_t k = 0; k < steps; ++k) {
        std::array<std::uint16_t, lanes> row;
        std::memcpy(row.data(), words + k * sizeof row, sizeof row);
        for (std::size_t j = 0; j < lanes; ++j) two[j] += one[j] += row[j];
    }
    Sums sums;
    for (std::size_t j = 0; j < lanes; ++j) {
        sums.one += one[j];
        sums.two += lanes * std::uint64_t{two[j]} - j * one[j];
    }
    return {sums.one % modulus, sums.two % modulus};
}

/// HDF5 folds carries back in place of dividing, which leaves 65535 where a sum of anything but zeros divides evenly.
std::uint32_t folded(std::uint64_t sum, bool all_zeros) {
    return static_cast<std::uint32_t>(sum == 0 && !all_zeros ? modulus : sum);
}

/// Swapping a word's bytes multiplies it by 256 modulo 65535, and so swaps the bytes of any sum.
std::uint32_t swapped(std::uint32_t sum) {
    return (sum >> 8 | sum << 8) & 0xFFFF;
}

}  // namespace

std::uint32_t fletcher32(std::span<const float> values) {
    const auto* bytes = reinterpret_cast<const char*>(values.data());
    std::size_t words = values.size() * 2;
    Sums sums;
    while (words >= lanes) {
        const auto steps = std::min<std::size_t>(words / lanes, 256);
        sums.append(sums_of(bytes, steps), steps * lanes);
        bytes += steps * lanes * 2;
        words -= steps * lanes;
    }
    for (; words > 0; --words, bytes += 2) {
        std::uint16_t word;
        std::memcpy(&word, bytes, 2);
        sums.append({word, word}, 1);
    }
    const bool zeros = std::all_of(values.begin(), values.end(), [](float v) {
        std::uint32_t bits;
        std::memcpy(&bits, &v, 4);
        return bits == 0;
    });
    return swapped(folded(sums.two, zeros)) << 16 | swapped(folded(sums.one, zeros));
}

}  // namespace actformer
