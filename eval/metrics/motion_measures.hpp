// What is measured of motions themselves, without a recogniser: how they accelerate, how fast the root moves, whether feet slide, and how far persons
// keep from each other.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace actformer::eval {

/// What it takes to measure a body.
struct MeasuredBody {
    std::vector<int> parents;       ///< (K) -1 for the root
    std::vector<std::size_t> feet;  ///< joints; none where their names do not tell
    std::size_t up = 1;             ///< axis along which bodies are tall
    double up_sign = 1;             ///< -1 where it points down
    double fps = 30;
};

/// Joints called a foot or a toe; where none is, those called an ankle.
std::vector<std::size_t> feet_among(std::span<const std::string> names);

/// Of n motions, one after another.
struct MotionMeasures {
    /// (n) means over frames, persons and limbs: lengths of the second differences of a limb (child minus parent) and of the
    /// root's position, m/s^2. Motions of under three frames have 0.
    std::vector<float> limb_acceleration, root_acceleration;

    /// (n) mean over steps from frame to frame and persons: speed of the root, m/s. Motions of one frame have 0.
    std::vector<float> root_speed;

    /// (n) mean horizontal speed, m/s, of a foot while it is within near_floor of the lowest that a foot comes to in the motion;
    /// empty where there are no feet.
    std::vector<float> foot_sliding;

    /// (n, columns) metres between the roots of two persons, each pair in distance_frames frames; no column for one person.
    std::vector<float> distances;
    std::size_t columns = 0;

    std::size_t size() const { return limb_acceleration.size(); }
};

constexpr double near_floor = 0.05;         ///< metres
constexpr std::size_t distance_frames = 8;  ///< evenly over the motion

/// Adds one motion: joint positions (frames, persons, joints, 3) in metres.
void measure(std::span<const float> positions, std::size_t frames, std::size_t persons,
             const MeasuredBody& body, MotionMeasures& to);

/// The motions `which`, in that order.
MotionMeasures subset(const MotionMeasures& from, const std::vector<std::size_t>& which);

/// Generated motions beside real ones.
struct MotionScore {
    std::optional<double> limb_acceleration;  ///< times that of real motions
    std::optional<double> root_acceleration;
    std::optional<double> root_speed;
    std::optional<double> foot_sliding;  ///< m/s
    std::optional<double>
        root_distance;  ///< Wasserstein-1, metres, between the distributions of distances between roots
};

/// Over the motions named; nothing where a side has none.
MotionScore compare(const MotionMeasures& real, std::span<const std::size_t> of_real,
                    const MotionMeasures& generated, std::span<const std::size_t> of_generated);

/// Wasserstein-1 of two sets of numbers, at least one each: the area between their distribution functions.
double wasserstein(std::vector<float> a, std::vector<float> b);

}  // namespace actformer::eval
