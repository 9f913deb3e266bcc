// Skeletons that move, made up, and the way back to joint positions by plain matrices.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>

#include <array>
#include <cmath>
#include <random>
#include <vector>

#include "ingest/export/skeleton_motion.hpp"
#include "tests/support/larger.hpp"

namespace actformer::test {

using ingest::Point;
using ingest::Quaternion;
using Matrix = std::array<Point, 3>;  ///< rows

inline Matrix matrix(const Quaternion& q) {
    const double s = q.w, x = q.x, y = q.y, z = q.z;
    return {{{1 - 2 * (y * y + z * z), 2 * (x * y - s * z), 2 * (x * z + s * y)},
             {2 * (x * y + s * z), 1 - 2 * (x * x + z * z), 2 * (y * z - s * x)},
             {2 * (x * z - s * y), 2 * (y * z + s * x), 1 - 2 * (x * x + y * y)}}};
}

inline Matrix product(const Matrix& a, const Matrix& b) {
    Matrix out{};
    for (std::size_t i = 0; i < 3; ++i)
        for (std::size_t j = 0; j < 3; ++j)
            for (std::size_t k = 0; k < 3; ++k) out[i][j] += a[i][k] * b[k][j];
    return out;
}

inline Point product(const Matrix& a, const Point& p) {
    Point out{};
    for (std::size_t i = 0; i < 3; ++i)
        for (std::size_t k = 0; k < 3; ++k) out[i] += a[i][k] * p[k];
    return out;
}

inline double distance(const Point& a, const Point& b) {
    return std::hypot(a[0] - b[0], a[1] - b[1], a[2] - b[2]);
}

/// (frames, K) places in the world.
inline std::vector<Point> joints_of(const ingest::SkeletonMotion& motion) {
    const auto k = motion.joints();
    std::vector<Point> places(motion.frames * k);
    std::vector<Matrix> turned(k);
    for (std::size_t t = 0; t < motion.frames; ++t)
        for (const auto j : motion.topology.order()) {
            const int parent = motion.topology.parents[j];
            const Matrix above = parent < 0 ? matrix({}) : turned[parent];
            const auto step = product(above, motion.place(t, j));
            for (std::size_t d = 0; d < 3; ++d)
                places[t * k + j][d] = step[d] + (parent < 0 ? 0 : places[t * k + parent][d]);
            turned[j] = product(above, matrix(motion.turn(t, j)));
        }
    return places;
}

/// A tree of `joints`, any of them below any that stands before it in a shuffled order.
inline ingest::Topology made_tree(std::size_t joints, std::mt19937& random) {
    std::vector<int> order(joints);
    for (std::size_t j = 0; j < joints; ++j) order[j] = static_cast<int>(j);
    std::shuffle(order.begin() + 1, order.end(), random);
    ingest::Topology tree{std::vector<std::string>(joints), std::vector<int>(joints, -1)};
    for (std::size_t i = 0; i < joints; ++i) {
        tree.names[i] = "joint" + std::to_string(i);
        if (i > 0) tree.parents[order[i]] = order[random() % i];
    }
    return tree;
}

inline Quaternion made_rotation(std::mt19937& random) {
    std::normal_distribution<double> normal;
    Quaternion q{normal(random), normal(random), normal(random), normal(random)};
    const double length = std::sqrt(q.w * q.w + q.x * q.x + q.y * q.y + q.z * q.z);
    return {q.w / length, q.x / length, q.y / length, q.z / length};
}

inline Point made_point(std::mt19937& random, double size) {
    std::normal_distribution<double> normal(0, size);
    return {normal(random), normal(random), normal(random)};
}

/// Bones that keep their lengths and their angles; the root wanders.
inline ingest::SkeletonMotion made_motion(const ingest::Topology& tree, std::uint32_t frames,
                                          std::mt19937& random) {
    ingest::SkeletonMotion motion;
    motion.topology = tree;
    motion.frames = frames;
    motion.rest.assign(tree.joints(), Point{});
    motion.slides.assign(tree.joints(), false);
    motion.slides[0] = true;
    for (std::size_t j = 1; j < tree.joints(); ++j) motion.rest[j] = made_point(random, 0.2);
    for (std::uint32_t t = 0; t < frames; ++t)
        for (std::size_t j = 0; j < tree.joints(); ++j) {
            motion.rotation.push_back(made_rotation(random));
            motion.position.push_back(j == 0 ? made_point(random, 2) : motion.rest[j]);
        }
    return motion;
}

/// The largest distance between joints of the same place.
inline double furthest(const std::vector<Point>& a, const std::vector<Point>& b) {
    EXPECT_EQ(a.size(), b.size());
    EXPECT_FALSE(b.empty());
    double most = 0;
    for (std::size_t i = 0; i < std::min(a.size(), b.size()); ++i) most = larger(most, distance(a[i], b[i]));
    return most;
}

}  // namespace actformer::test
