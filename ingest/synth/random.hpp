// Random numbers that are the same on every platform and for every number of threads: each stream is named by a key.
#pragma once

#include <cmath>
#include <cstdint>
#include <initializer_list>
#include <span>

#include "base/random/splitmix.hpp"

namespace actformer::ingest::synth {

class Random {
  public:
    explicit Random(std::initializer_list<std::uint64_t> key) : Random(std::span(key.begin(), key.size())) {}
    explicit Random(std::span<const std::uint64_t> key) {
        std::uint64_t state = 0;
        for (const auto k : key) state = mixed(state ^ mixed(k + golden_step));
        stream_ = SplitMix(state);
    }

    std::uint64_t bits() { return stream_.next(); }

    /// In [0, 1).
    double uniform() { return static_cast<double>(bits() >> 11) * 0x1p-53; }
    double uniform(double from, double to) { return from + (to - from) * uniform(); }
    bool chance(double probability) { return uniform() < probability; }

    /// One of 0 .. n-1.
    int below(int n) { return static_cast<int>(uniform() * n); }

    /// Mean 0, deviation 1: the sum of four uniform numbers. Near enough to a normal one for noise, and within +-3.47.
    double normal() {
        const auto b = bits();
        const auto sum = (b & 0xFFFF) + (b >> 16 & 0xFFFF) + (b >> 32 & 0xFFFF) + (b >> 48);
        return (static_cast<double>(sum) / 65535.0 - 2.0) * 1.7320508075688772;
    }

  private:
    SplitMix stream_{0};
};

/// Slow wandering around 0 with deviation about 1: noise that forgets itself over `memory` steps.
class Wander {
  public:
    explicit Wander(double memory) : keep_(std::exp(-1.0 / memory)), kick_(std::sqrt(1 - keep_ * keep_)) {}
    double next(Random& random) { return value_ = keep_ * value_ + kick_ * random.normal(); }
    void start(Random& random) { value_ = random.normal(); }

  private:
    double keep_, kick_, value_ = 0;
};

}  // namespace actformer::ingest::synth
