#include "base/files/cache.hpp"

#include <cstdlib>

namespace actformer {

std::filesystem::path cache_folder() {
    const char* cache = std::getenv("XDG_CACHE_HOME");
    if (cache && *cache) return std::filesystem::path(cache) / "actformer";
    const char* home = std::getenv("HOME");
    return std::filesystem::path(home ? home : ".") / ".cache" / "actformer";
}

}  // namespace actformer
