// Vectors and rotations in three dimensions. Axes of a body, of the stage and of a camera alike: x left, y
// up, z forward.
#pragma once

#include <cmath>

namespace actformer::ingest::synth {

constexpr double pi = 3.14159265358979323846;
constexpr double radians(double degrees) {
    return degrees * pi / 180;
}

struct Vec {
    double x = 0, y = 0, z = 0;

    Vec operator+(const Vec& o) const { return {x + o.x, y + o.y, z + o.z}; }
    Vec operator-(const Vec& o) const { return {x - o.x, y - o.y, z - o.z}; }
    Vec operator*(double s) const { return {x * s, y * s, z * s}; }
    Vec& operator+=(const Vec& o) { return *this = *this + o; }
};

inline double dot(const Vec& a, const Vec& b) {
    return a.x * b.x + a.y * b.y + a.z * b.z;
}
inline Vec cross(const Vec& a, const Vec& b) {
    return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
inline double length(const Vec& a) {
    return std::sqrt(dot(a, a));
}
inline Vec lerp(const Vec& a, const Vec& b, double w) {
    return a + (b - a) * w;
}
inline Vec normalised(const Vec& a) {
    const double l = length(a);
    return l > 1e-12 ? a * (1 / l) : Vec{0, 1, 0};
}

/// The part of `a` at right angles to the unit vector `axis`.
inline Vec reject(const Vec& a, const Vec& axis) {
    return a - axis * dot(a, axis);
}

/// Columns are the images of the axes.
struct Rotation {
    Vec x{1, 0, 0}, y{0, 1, 0}, z{0, 0, 1};

    Vec operator*(const Vec& v) const { return x * v.x + y * v.y + z * v.z; }
    Rotation operator*(const Rotation& o) const { return {*this * o.x, *this * o.y, *this * o.z}; }

    /// Into this frame: the inverse applied to `v`.
    Vec into(const Vec& v) const { return {dot(x, v), dot(y, v), dot(z, v)}; }
};

/// Angles in degrees. Positive: turning left about y, leaning forward about x, leaning right about z.
inline Rotation about_x(double degrees) {
    const double c = std::cos(radians(degrees)), s = std::sin(radians(degrees));
    return {{1, 0, 0}, {0, c, s}, {0, -s, c}};
}
inline Rotation about_y(double degrees) {
    const double c = std::cos(radians(degrees)), s = std::sin(radians(degrees));
    return {{c, 0, -s}, {0, 1, 0}, {s, 0, c}};
}
inline Rotation about_z(double degrees) {
    const double c = std::cos(radians(degrees)), s = std::sin(radians(degrees));
    return {{c, s, 0}, {-s, c, 0}, {0, 0, 1}};
}

/// `v` turned by `degrees` about the unit vector `axis`.
inline Vec turned(const Vec& v, const Vec& axis, double degrees) {
    const double c = std::cos(radians(degrees)), s = std::sin(radians(degrees));
    return v * c + cross(axis, v) * s + axis * (dot(axis, v) * (1 - c));
}

/// Rest to rest with minimal jerk, for `u` in 0..1.
inline double ease(double u) {
    if (u <= 0) return 0;
    if (u >= 1) return 1;
    return u * u * u * (10 + u * (6 * u - 15));
}

}  // namespace actformer::ingest::synth
