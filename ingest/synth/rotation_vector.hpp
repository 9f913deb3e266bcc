// Rotations as vectors, and ways between two of them.
#pragma once

#include <algorithm>
#include <cmath>

#include "ingest/synth/geometry.hpp"

namespace actformer::ingest::synth {

/// The axis times the angle in radians, 0 to pi.
inline Vec rotation_vector(const Rotation& r) {
    // By the largest of the quaternion's four numbers, so that no angle is ill-conditioned.
    const double t = r.x.x + r.y.y + r.z.z;
    double w, x, y, z;
    if (t > 0) {
        w = 1 + t, x = r.y.z - r.z.y, y = r.z.x - r.x.z, z = r.x.y - r.y.x;
    } else if (r.x.x >= r.y.y && r.x.x >= r.z.z) {
        w = r.y.z - r.z.y, x = 1 + 2 * r.x.x - t, y = r.y.x + r.x.y, z = r.z.x + r.x.z;
    } else if (r.y.y >= r.z.z) {
        w = r.z.x - r.x.z, x = r.y.x + r.x.y, y = 1 + 2 * r.y.y - t, z = r.z.y + r.y.z;
    } else {
        w = r.x.y - r.y.x, x = r.z.x + r.x.z, y = r.z.y + r.y.z, z = 1 + 2 * r.z.z - t;
    }
    const double sign = w < 0 ? -1 : 1, l = std::sqrt(x * x + y * y + z * z);
    if (!(l > 1e-300)) return {};
    const double angle = 2 * std::atan2(l, sign * w);
    return Vec{x, y, z} * (sign * angle / l);
}

inline Rotation rotation_of(const Vec& vector) {
    const double angle = length(vector);
    if (!(angle > 1e-12)) return {};
    const Vec axis = vector * (1 / angle);
    const double degrees = angle * 180 / pi;
    return {turned({1, 0, 0}, axis, degrees), turned({0, 1, 0}, axis, degrees),
            turned({0, 0, 1}, axis, degrees)};
}

inline Rotation inverse(const Rotation& r) {
    return {{r.x.x, r.y.x, r.z.x}, {r.x.y, r.y.y, r.z.y}, {r.x.z, r.y.z, r.z.z}};
}

/// From a (u = 0) to b (u = 1) at constant speed, the shorter way round.
inline Rotation slerp(const Rotation& a, const Rotation& b, double u) {
    return a * rotation_of(rotation_vector(inverse(a) * b) * u);
}

/// The smallest turn that takes unit vector `a` to unit vector `b`.
inline Rotation shortest_turn(const Vec& a, const Vec& b) {
    const Vec axis = cross(a, b);
    const double sine = length(axis);
    if (sine < 1e-9) return {};  // the same way; opposite ones do not occur in a body
    return rotation_of(axis * (std::atan2(sine, dot(a, b)) / sine));
}

}  // namespace actformer::ingest::synth
