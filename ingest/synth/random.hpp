// Random numbers that are the same on every platform and for every number of threads: each stream is named by
// a key.
#pragma once

#include <cmath>
#include <cstdint>
#include <initializer_list>

namespace actformer::ingest::synth {

class Random {
  public:
    explicit Random(std::initializer_list<std::uint64_t> key) {
        for (const auto k : key) state_ = mix(state_ ^ mix(k + 0x9E3779B97F4A7C15u));
    }

    std::uint64_t bits() { return mix(state_ += 0x9E3779B97F4A7C15u); }

    /// In [0, 1).
    double uniform() { return static_cast<double>(bits() >> 11) * 0x1p-53; }
    double uniform(double from, double to) { return from + (to - from) * uniform(); }
    bool chance(double probability) { return uniform() < probability; }

    /// One of 0 .. n-1.
    int below(int n) { return static_cast<int>(uniform() * n); }

    /// Mean 0, deviation 1: the sum of four uniforms, which is near enough to a normal for noise and never
    /// wild.
    double normal() {
        const auto b = bits();
        const auto sum = (b & 0xFFFF) + (b >> 16 & 0xFFFF) + (b >> 32 & 0xFFFF) + (b >> 48);
        return (static_cast<double>(sum) / 65535.0 - 2.0) * 1.7320508075688772;
    }

  private:
    /// The finaliser of SplitMix64.
    static std::uint64_t mix(std::uint64_t x) {
        x = (x ^ (x >> 30)) * 0xBF58476D1CE4E5B9u;
        x = (x ^ (x >> 27)) * 0x94D049BB133111EBu;
        return x ^ (x >> 31);
    }

    std::uint64_t state_ = 0;
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
