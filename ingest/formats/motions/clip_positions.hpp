// The joint positions of one clip made ready for cleaning: persons chosen, what was not seen filled in, turned upright, in metres.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "ingest/dataset/topology.hpp"
#include "ingest/formats/format.hpp"
#include "ingest/formats/frame_span.hpp"
#include "ingest/formats/motions/joint_array.hpp"

namespace actformer::ingest {

struct PositionsRequest {
    const Topology* topology = nullptr;
    std::uint32_t persons = 1;
    double scale = 1;  ///< metres a unit
    std::array<int, 3> axes{
        1, 2,
        3};  ///< x, y, z of the dataset: which axis of the array, from 1, negative where it points the other way
    bool limbs = true;        ///< joints relative to their parents, or all to the same origin
    std::uint64_t start = 0;  ///< frames start .. end - 1 of the array
    std::optional<std::uint64_t> end;
};

struct ClipPositions {
    std::uint32_t frames = 0;

    /// (frames, persons, joints, 3) metres: child - parent, or all relative to an origin that the clip's bodies share. The root is relative
    /// to that origin either way.
    std::vector<float> values;
    std::vector<float>
        bone_length;  ///< (persons, joints) metres, the mean over frames, 0 for the root; of positions, not of limbs
    bool filled = false;  ///< some of it was not seen
    FrameSpan span;       ///< as the request has it
};

/// NaN is not seen; a body of zeros alone is not seen either. The bodies seen in most frames are kept, ties going to the first. Gaps are
/// filled linearly joint by joint, held before the first sight and after the last. Where clips share an array, frames at the end in which
/// nobody is seen are padding and left away. Rejects a clip with fewer persons, a joint that is never seen, and infinite numbers.
std::variant<ClipPositions, Rejection> read_positions(const JointArray& array, std::uint64_t clip,
                                                      const PositionsRequest& request);

/// (persons, joints) metres, 0 for the root: the mean over the frames of `positions`, (frames, persons, joints, 3).
std::vector<float> mean_limb_lengths(const std::vector<float>& positions, std::uint32_t persons,
                                     const Topology& topology);

}  // namespace actformer::ingest
