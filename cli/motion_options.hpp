// The options of commands that show a recogniser motions or a dataset.
#pragma once

#include <CLI/CLI.hpp>
#include <filesystem>
#include <memory>
#include <string>

#include "eval/scoring/feature_extractor.hpp"

namespace actformer::cli {

struct MotionOptions {
    std::filesystem::path recogniser, input;
    std::uint32_t frames = 0, window = 60, batch = 64;
    std::string split = "all", device;
    const CLI::App* command = nullptr;  ///< what it was given to

    /// The input: a dataset's split in windows, or a file's motions. Throws Error where there is neither, for options of the other kind of
    /// input, and as open_windows and open_motions do.
    std::unique_ptr<eval::MotionSource> open(kernels::Device& on,
                                             const eval::FeatureExtractor& extractor) const;
};

void add_motion_options(CLI::App* command, MotionOptions& options);

}  // namespace actformer::cli
