// Motions to a picture file of any kind.
#pragma once

#include <filesystem>
#include <vector>

#include "reports/pictures/contact_sheet.hpp"

namespace actformer::reports {

/// What `path` will be, by its extension: .png a contact sheet, .gif or .mp4 an animation.
enum class PictureKind { png, gif, mp4 };

/// Throws Error listing the three where `path` has another extension.
PictureKind picture_kind(const std::filesystem::path& path);

/// Draws `motions` and writes them to `path`, whole or not at all. Throws Error naming the motion or file at
/// fault.
void render(const std::vector<JointMotion>& motions, const Layout& layout, const std::filesystem::path& path,
            const Watcher& watch = {});

/// Writes `picture` (8UC3) as PNG. Throws Error naming `path` where it cannot be written; then no file is
/// left.
void write_png(const std::filesystem::path& path, const cv::Mat& picture);

}  // namespace actformer::reports
