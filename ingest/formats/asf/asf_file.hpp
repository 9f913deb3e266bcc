// Acclaim's skeletons (.asf), as CMU's motion capture database has them.
#pragma once

#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "ingest/formats/format.hpp"
#include "ingest/formats/skeletal/matrix.hpp"
#include "kernels/forward_kinematics.hpp"

namespace actformer::ingest {

/// A stick from its parent's end to its own. Its numbers turn it about its start, in axes of its own.
struct AsfBone {
    std::string name;                        ///< printable
    int parent = -1;                         ///< index of the bone at whose end it starts; -1: at the root
    Vector3 stick{};                         ///< from start to end with nothing turned, in the file's units
    Matrix3 axes = identity3;                ///< its own axes
    std::vector<kernels::Channel> channels;  ///< turns only, about its own axes; the first turns first
};

struct AsfSkeleton {
    std::vector<AsfBone> bones;                   ///< depth first, each after its parent
    std::vector<kernels::Channel> root_channels;  ///< what a frame says of the root
    Vector3 root_position{};                      ///< added to the root's place
    Matrix3 root_axes = identity3;
    double radians_to_degrees = 1;  ///< of an .amc that does not say which it is in
};

/// Reads a whole file. 64 zero bytes follow `text`. Throws nothing for what is in the text. Refused beside what is malformed: bones
/// that slide or stretch, more than 1024 bones.
std::variant<AsfSkeleton, Rejection> parse_asf(std::string_view text);

}  // namespace actformer::ingest
