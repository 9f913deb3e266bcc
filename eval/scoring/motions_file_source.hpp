// Motions out of a file in the public layout.
#pragma once

#include <filesystem>
#include <map>
#include <optional>
#include <string>

#include "eval/scoring/motion_source.hpp"

namespace actformer::eval {

struct MotionsFileOptions {
    std::uint32_t frames = 0;  ///< how many of the first frames to take; 0 takes all
    std::uint32_t batch = 64;  ///< the most motions in memory at once

    /// Labels by name, before what names tell. Where it is not empty every motion must be in it.
    std::map<std::string, std::uint32_t> labels;
};

/// Every motion whole, or its first frames; motions of one length come together. Labels are known where every motion has the
/// attribute `label` or a name that tells its action (A001_0, S001C002P003R001A001). Throws Error naming the file, the motion and
/// the remedy: for a file that cannot be read or holds no motions, motions of different joints or channels, motions shorter than
/// `frames` or without frames; and, as they come, for numbers that are not finite.
std::unique_ptr<MotionSource> open_motions(const std::filesystem::path& file,
                                           MotionsFileOptions options = {});

/// Motions in a file; the set's key is the file's checksum with the options. Throws Error where it cannot be read.
MotionSet motions_in(const std::filesystem::path& file, const MotionsFileOptions& options);

}  // namespace actformer::eval
