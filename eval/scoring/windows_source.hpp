// A dataset's split as consecutive windows.
#pragma once

#include <filesystem>

#include "eval/scoring/motion_source.hpp"
#include "ingest/dataset/common_joints.hpp"
#include "ingest/dataset/dataset.hpp"

namespace actformer::eval {

struct WindowsOptions {
    std::filesystem::path dataset;
    std::string split = "all";
    std::uint32_t window = 60;  ///< frames
    std::uint32_t batch = 64;   ///< the most windows handed to the recogniser together
    ingest::Joints joints = ingest::Joints::own;
};

/// Every window of every clip, named CLIP@FIRST_FRAME. They lie on `device`, which the first one loads the split to and which
/// must outlive the source. Memory grows with the split's frames. Throws Error for a dataset that cannot be read, a split that
/// does not exist or is empty; and, as they come, for more frames than the device takes.
std::unique_ptr<MotionSource> open_windows(kernels::Device& device, const WindowsOptions& options);

/// What is known of a dataset's clips, without names and labels.
MotionsInfo describe(const ingest::Dataset& dataset, ingest::Joints joints = ingest::Joints::own);

/// The clip that a window's name tells, "walk" of "walk@60"; any other name is a clip's own.
std::string clip_of(const std::string& window);

}  // namespace actformer::eval
