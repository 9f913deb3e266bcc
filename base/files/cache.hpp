// The user's cache folder: results that can be computed again.
#pragma once

#include <filesystem>

namespace actformer {

/// $XDG_CACHE_HOME/actformer, or the same under ~/.cache.
std::filesystem::path cache_folder();

}  // namespace actformer
