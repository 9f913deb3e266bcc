// SplitMix64 (Steele, Lea and Flood 2014): a counter that grows by a fixed step, and a mix that turns it into random bits.
#pragma once

#include <cstdint>

namespace actformer {

/// The counter's step: 2^64 divided by the golden ratio, made odd.
constexpr std::uint64_t golden_step = 0x9E3779B97F4A7C15;

/// Turns `x` into 64 bits of which each depends on every bit of `x`. One to one: different inputs stay different.
constexpr std::uint64_t mixed(std::uint64_t x) {
    x = (x ^ (x >> 30)) * 0xBF58476D1CE4E5B9;
    x = (x ^ (x >> 27)) * 0x94D049BB133111EB;
    return x ^ (x >> 31);
}

/// A stream of random bits; `state` is its seed.
class SplitMix {
  public:
    constexpr explicit SplitMix(std::uint64_t state) : state_(state) {}
    constexpr std::uint64_t next() { return mixed(state_ += golden_step); }

  private:
    std::uint64_t state_;
};

}  // namespace actformer
