// Vectors of three numbers, a vector a lane, their directions, and rotations out of six numbers, forward and backward.
#pragma once

#include <cstdint>

#include "model/cpu/vector_math.hpp"
#include "model/cpu/vectors.hpp"

namespace actformer::model::cpu {

constexpr std::int64_t axes = 3;  ///< of space

template <typename T>
struct Vectors {
    Lanes<T> x[axes];

    Lanes<T>& operator[](std::int64_t d) { return x[d]; }
    const Lanes<T>& operator[](std::int64_t d) const { return x[d]; }
};

template <typename T>
Lanes<T> dot(const Vectors<T>& a, const Vectors<T>& b) {
    Lanes<T> sum = {};
    for (std::int64_t d = 0; d < axes; ++d) sum += a[d] * b[d];
    return sum;
}

template <typename T>
Vectors<T> cross(const Vectors<T>& a, const Vectors<T>& b) {
    return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}

/// Vectors and their directions, v / max(|v|, shortest).
template <typename T>
struct Directions {
    static constexpr double shortest = 1e-12;

    Vectors<T> unit;
    Lanes<T> over, pulled;  ///< 1 / max(|v|, shortest); 1 where |v| counts, else 0

    explicit Directions(const Vectors<T>& v) {
        const Lanes<T> least = Lanes<T>{} + static_cast<T>(shortest), one = Lanes<T>{} + 1, none = {};
        const auto length = root(dot(v, v));
        pulled = length > least ? one : none;
        over = 1 / (length < least ? least : length);  // NaN stays
        for (std::int64_t d = 0; d < axes; ++d) unit[d] = v[d] * over;
    }

    /// The vectors' gradient from the directions': (g - unit (unit . g)) / |v|.
    Vectors<T> backward(const Vectors<T>& g) const {
        const auto along = dot(unit, g) * pulled;
        Vectors<T> out;
        for (std::int64_t d = 0; d < axes; ++d) out[d] = (g[d] - unit[d] * along) * over;
        return out;
    }
};

/// The first two rows of rotations: the direction of a, and that of b - (a . b) a / |a|^2 (Gram and Schmidt).
template <typename T>
class Orthonormal {
  public:
    Orthonormal(const Vectors<T>& a, const Vectors<T>& b)
        : b_(b), first_(a), second_(rest_of(b, first_.unit)) {}

    const Vectors<T>& first() const { return first_.unit; }
    const Vectors<T>& second() const { return second_.unit; }

    struct Gradient {
        Vectors<T> a, b;
    };

    /// From the gradients to the rows. With r = b - (f . b) f: db = dr - f (f . dr), and df = dy - (f . b) dr - b (f . dr).
    Gradient backward(Vectors<T> to_first, const Vectors<T>& to_second) const {
        const auto& f = first_.unit;
        const auto to_rest = second_.backward(to_second);
        const auto along = dot(f, b_), back = dot(f, to_rest);
        Vectors<T> to_b;
        for (std::int64_t d = 0; d < axes; ++d) {
            to_b[d] = to_rest[d] - f[d] * back;
            to_first[d] -= along * to_rest[d] + b_[d] * back;
        }
        return {first_.backward(to_first), to_b};
    }

  private:
    static Vectors<T> rest_of(const Vectors<T>& b, const Vectors<T>& first) {
        const auto along = dot(first, b);
        Vectors<T> rest;
        for (std::int64_t d = 0; d < axes; ++d) rest[d] = b[d] - along * first[d];
        return rest;
    }

    Vectors<T> b_;
    Directions<T> first_, second_;
};

}  // namespace actformer::model::cpu
