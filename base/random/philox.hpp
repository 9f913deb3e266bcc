// Philox4x32-10, the counter-based generator of Salmon, Moraes, Dror and Shaw (2011). It keeps no state: the same counter and
// key give the same four words in any order and on any thread. kernels/cl/philox.cl is the same for devices.
#pragma once

#include <array>
#include <cstdint>

namespace actformer {

using PhiloxWords = std::array<std::uint32_t, 4>;
using PhiloxKey = std::array<std::uint32_t, 2>;

constexpr int philox_rounds = 10;
constexpr std::uint32_t philox_factor_a = 0xD2511F53, philox_factor_b = 0xCD9E8D57;
constexpr PhiloxKey philox_step{0x9E3779B9, 0xBB67AE85};  ///< the key grows by it from round to round

/// Four random words.
constexpr PhiloxWords philox(PhiloxWords counter, PhiloxKey key) {
    for (int round = 0; round < philox_rounds; ++round) {
        const auto a = std::uint64_t{philox_factor_a} * counter[0],
                   b = std::uint64_t{philox_factor_b} * counter[2];
        counter = {static_cast<std::uint32_t>(b >> 32) ^ counter[1] ^ key[0], static_cast<std::uint32_t>(b),
                   static_cast<std::uint32_t>(a >> 32) ^ counter[3] ^ key[1], static_cast<std::uint32_t>(a)};
        key[0] += philox_step[0];
        key[1] += philox_step[1];
    }
    return counter;
}

}  // namespace actformer
