// Rotation matrices in double precision.
#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <numbers>

namespace actformer::ingest {

using Vector3 = std::array<double, 3>;
using Matrix3 = std::array<Vector3, 3>;  ///< by rows

inline constexpr Matrix3 identity3{{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}};

inline Matrix3 operator*(const Matrix3& a, const Matrix3& b) {
    Matrix3 m{};
    for (std::size_t i = 0; i < 3; ++i)
        for (std::size_t j = 0; j < 3; ++j)
            m[i][j] = a[i][0] * b[0][j] + a[i][1] * b[1][j] + a[i][2] * b[2][j];
    return m;
}

inline Vector3 operator*(const Matrix3& m, const Vector3& v) {
    Vector3 out{};
    for (std::size_t i = 0; i < 3; ++i) out[i] = m[i][0] * v[0] + m[i][1] * v[1] + m[i][2] * v[2];
    return out;
}

inline Matrix3 transposed(const Matrix3& m) {
    return {{{m[0][0], m[1][0], m[2][0]}, {m[0][1], m[1][1], m[2][1]}, {m[0][2], m[1][2], m[2][2]}}};
}

/// Right-handed, about `axis` 0, 1 or 2.
inline Matrix3 rotation_about(std::size_t axis, double degrees) {
    const double angle = degrees * (std::numbers::pi / 180), c = std::cos(angle), s = std::sin(angle);
    const std::size_t u = (axis + 1) % 3, v = (axis + 2) % 3;
    Matrix3 m{};
    m[axis][axis] = 1;
    m[u][u] = m[v][v] = c;
    m[u][v] = -s;
    m[v][u] = s;
    return m;
}

}  // namespace actformer::ingest
