// What makes joint positions of a motion's numbers.
#pragma once

#include <array>
#include <cmath>
#include <vector>

#include "ingest/dataset/motion.hpp"
#include "ingest/dataset/representation.hpp"

namespace actformer::ingest {

struct BodyModel {
    Representation representation;
    Topology topology;
    std::vector<float> bone_length;  ///< (persons, joints) metres, 0 for the root; limbs need it
    std::vector<float>
        rest;  ///< (joints, 3) metres from the parent in the rest pose, the root's from the origin; rotations need it

    bool operator==(const BodyModel&) const = default;
};

/// Throws Error, naming the motion, where it has other nodes or numbers than the body model, or the model lacks what the
/// representation needs.
void check_fits(const Motion& motion, const BodyModel& body);

/// (frames, persons, joints, 3) joint positions in metres. Limbs: parent + bone length * limb, persons beyond those whose lengths are
/// known as long as the first. Rotations: forward kinematics of the rest pose, as in SMPL (Loper et al. 2015, equations 2 and 3): the
/// root turns about its own joint, and the translation comes on top. Throws Error as check_fits does.
std::vector<float> joint_positions(const Motion& motion, const BodyModel& body);

/// Row-major.
using Rotation = std::array<double, 9>;

/// `b` first, then `a`.
inline Rotation product(const Rotation& a, const Rotation& b) {
    Rotation out;
    for (std::size_t i = 0; i < 9; i += 3)
        for (std::size_t j = 0; j < 3; ++j)
            out[i + j] = a[i] * b[j] + a[i + 1] * b[3 + j] + a[i + 2] * b[6 + j];
    return out;
}

/// (joints) metres of a rest pose, (joints, 3) from the parent; 0 for the root.
template <typename Number>
std::vector<float> rest_lengths(const std::vector<Number>& rest) {
    std::vector<float> out(rest.size() / 3, 0);
    for (std::size_t j = 1; j < out.size(); ++j)
        out[j] = static_cast<float>(std::hypot(rest[3 * j], rest[3 * j + 1], rest[3 * j + 2]));
    return out;
}

/// The rotation whose first two rows these six numbers are nearest to by Gram and Schmidt: the first row keeps its direction.
/// Zeros where they have none.
Rotation rotation_of(const float* six);

}  // namespace actformer::ingest
