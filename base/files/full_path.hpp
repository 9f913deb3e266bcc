// Paths whose parts can be told, however they were typed.
#pragma once

#include <filesystem>

namespace actformer {

/// From the top, without "." and "..", and without a slash at its end: filename() is its last part, parent_path() the folder around it.
std::filesystem::path full_path(const std::filesystem::path& path);

}  // namespace actformer
