// The user's cache: what can be made again, kept to save the time.
#pragma once

#include <filesystem>

namespace actformer {

/// $XDG_CACHE_HOME/actformer, or the same under ~/.cache.
std::filesystem::path cache_folder();

}  // namespace actformer
