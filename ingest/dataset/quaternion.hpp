// Unit quaternions in double precision.
#pragma once

#include <array>
#include <cmath>

#include "ingest/dataset/body_model.hpp"

namespace actformer::ingest {

struct Quaternion {
    double w = 1, x = 0, y = 0, z = 0;

    bool operator==(const Quaternion&) const = default;
};

/// `b` first, then `a`.
constexpr Quaternion operator*(const Quaternion& a, const Quaternion& b) {
    return {a.w * b.w - a.x * b.x - a.y * b.y - a.z * b.z, a.w * b.x + a.x * b.w + a.y * b.z - a.z * b.y,
            a.w * b.y - a.x * b.z + a.y * b.w + a.z * b.x, a.w * b.z + a.x * b.y - a.y * b.x + a.z * b.w};
}

/// Of a rotation vector: its length is the angle in radians, right-handed about its direction.
inline Quaternion of_rotation_vector(const double* v) {
    const double squared = v[0] * v[0] + v[1] * v[1] + v[2] * v[2];
    // sin(a/2)/a about 0: the next term of the series is below the last bit of a double.
    const double angle = std::sqrt(squared),
                 s = angle < 1e-4 ? 0.5 - squared / 48 : std::sin(angle / 2) / angle;
    return {std::cos(angle / 2), s * v[0], s * v[1], s * v[2]};
}

/// From a (u = 0) to b (u = 1) at constant speed, the shorter way round (Shoemake 1985).
inline Quaternion slerp(const Quaternion& a, const Quaternion& b, double u) {
    const double dot = a.w * b.w + a.x * b.x + a.y * b.y + a.z * b.z, sign = dot < 0 ? -1 : 1;
    const auto combined = [&](double p, double q) {
        q *= sign;
        return Quaternion{p * a.w + q * b.w, p * a.x + q * b.x, p * a.y + q * b.y, p * a.z + q * b.z};
    };
    const auto length = [](const Quaternion& q) {
        return std::sqrt(q.w * q.w + q.x * q.x + q.y * q.y + q.z * q.z);
    };
    // Exact for small angles too, where the arc cosine of the dot product is not.
    const double angle = 2 * std::atan2(length(combined(1, -1)), length(combined(1, 1)));
    if (angle < 1e-9) return a;
    const double s = std::sin(angle);
    return combined(std::sin((1 - u) * angle) / s, std::sin(u * angle) / s);
}

inline Rotation matrix_of(const Quaternion& q) {
    return {
        1 - 2 * (q.y * q.y + q.z * q.z), 2 * (q.x * q.y - q.z * q.w),     2 * (q.x * q.z + q.y * q.w),
        2 * (q.x * q.y + q.z * q.w),     1 - 2 * (q.x * q.x + q.z * q.z), 2 * (q.y * q.z - q.x * q.w),
        2 * (q.x * q.z - q.y * q.w),     2 * (q.y * q.z + q.x * q.w),     1 - 2 * (q.x * q.x + q.y * q.y)};
}

}  // namespace actformer::ingest
