// Joint positions of clips on their way into a dataset of limbs or of positions: what all formats of joints share.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <span>
#include <variant>
#include <vector>

#include "ingest/dataset/dataset.hpp"
#include "ingest/formats/format.hpp"
#include "ingest/formats/motions/clip_positions.hpp"
#include "ingest/formats/skeletal/up.hpp"

namespace actformer::ingest {

struct PositionClip : RawClip {
    std::uint32_t frames = 0;
    std::vector<float> values;  ///< (frames, persons, nodes, numbers); of positions as ClipPositions has them
    std::vector<float> bone_length;  ///< (persons, joints) metres

    void take(ClipPositions&& positions);

    std::size_t bytes() const override {
        return sizeof *this + sizeof(float) * (values.size() + bone_length.size());
    }
};

/// Which axis of the recording each axis of the dataset is, for PositionsRequest::axes.
std::array<int, 3> axes_below(Up up);

/// One person's joints, (frames, joints, 3) metres, turned y up; rejected as read_positions rejects it. Throws Error where the array has
/// another shape.
std::variant<std::unique_ptr<PositionClip>, Rejection> position_clip(const NumpyArray& array, Up up,
                                                                     const DatasetHeader& header);

/// What Format::clean returns for PositionClips, not smoothed.
kernels::CleanedBatch cleaned(kernels::Device& device, std::span<const std::unique_ptr<RawClip>> clips,
                              const DatasetHeader& header, std::vector<std::uint32_t>& frames);

/// Of clips that hold what read_positions made: limbs or positions, as the header has it, about the clip's mean root; smoothed as
/// NTU's where `smooth`.
kernels::CleanedBatch cleaned(kernels::Device& device, std::span<const PositionClip* const> clips,
                              const DatasetHeader& header, bool smooth);

}  // namespace actformer::ingest
