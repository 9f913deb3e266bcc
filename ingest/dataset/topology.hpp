// A skeleton's joints and how they hang together.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

namespace actformer::ingest {

/// Of a body. Markers, fingers and faces fit in.
inline constexpr std::size_t most_joints = 4096;

/// Joints of a tree. Joint 0 is the root; joints may come in any order otherwise.
struct Topology {
    std::vector<std::string> names;
    std::vector<int> parents;  ///< -1 for the root

    std::size_t joints() const { return parents.size(); }

    /// Every joint after its parent.
    std::vector<std::uint32_t> order() const;

    /// Throws Error, beginning with `where`, unless this is one tree of at most `most_joints`, rooted at joint 0, with distinct names.
    void check(const std::string& where) const;

    bool operator==(const Topology&) const = default;
};

/// Limb parents of ntu25().
constexpr std::array<int, 25> ntu25_parents{-1, 0,  20, 2, 20, 4,  5,  6, 20, 8, 9,  10, 0,
                                            12, 13, 14, 0, 16, 17, 18, 1, 7,  7, 11, 11};

/// The 25 joints of Kinect v2, as NTU RGB+D has them; limbs run from the hand to its tip and to its thumb.
const Topology& ntu25();

}  // namespace actformer::ingest
