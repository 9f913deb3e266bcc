// Paths that name the same file or folder, however they are typed.
#pragma once

#include <algorithm>
#include <filesystem>
#include <optional>
#include <vector>

namespace actformer::reports {

/// The first of `paths` that names what one before it names; none where all differ. Where nothing lies, nothing is named.
inline std::optional<std::filesystem::path> given_twice(const std::vector<std::filesystem::path>& paths) {
    for (auto path = paths.begin(); path != paths.end(); ++path) {
        const auto is_same = [&](const std::filesystem::path& other) {
            std::error_code missing;
            return std::filesystem::equivalent(*path, other, missing);
        };
        if (std::any_of(paths.begin(), path, is_same)) return *path;
    }
    return {};
}

}  // namespace actformer::reports
