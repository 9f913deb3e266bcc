// MP4.
#pragma once

#include <filesystem>

#include "reports/pictures/film.hpp"

namespace actformer::reports {

/// Writes `film` to `path` as H.264, or MPEG-4 where OpenCV has no H.264 encoder. Throws Error naming `path`
/// where neither can be written; then no file is left.
void write_mp4(const std::filesystem::path& path, const Film& film, const Watcher& watch = {});

}  // namespace actformer::reports
