// Animated GIF.
#pragma once

#include <filesystem>

#include "reports/pictures/film.hpp"

namespace actformer::reports {

/// GIF counts hundredths of a second, and viewers slow down what is faster than this.
constexpr double most_gif_fps = 50;

/// Writes `film` to `path`, looping for ever. Frames above 50 a second are left out. One palette of 255
/// colours, no dithering; each frame stores only what changed. Throws Error naming `path` where it cannot be
/// written; then no file is left.
void write_gif(const std::filesystem::path& path, const Film& film, const Watcher& watch = {});

}  // namespace actformer::reports
