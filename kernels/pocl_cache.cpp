#include "kernels/pocl_cache.hpp"

#include <unistd.h>

#include <cstdlib>
#include <string>
#include <system_error>

namespace actformer::kernels {
namespace {

namespace fs = std::filesystem;

/// Empty where the variable is not set.
std::string environment(const char* name) {
    const char* value = std::getenv(name);
    return value ? value : "";
}

/// Whether the loader finds a driver that is called so.
bool has_pocl() {
    const auto given = environment("OCL_ICD_VENDORS");
    std::error_code ignored;
    fs::directory_iterator entry(given.empty() ? "/etc/OpenCL/vendors" : given, ignored);
    for (; !ignored && entry != fs::directory_iterator(); entry.increment(ignored))
        if (entry->path().filename().string().find("pocl") != std::string::npos) return true;
    return false;
}

/// As PoCL chooses it.
fs::path pocl_cache() {
    if (const auto given = environment("POCL_CACHE_DIR"); !given.empty()) return given;
    if (const auto cache = environment("XDG_CACHE_HOME"); !cache.empty())
        return fs::path(cache) / "pocl/kcache";
    const auto home = environment("HOME");
    return home.empty() ? fs::path("/tmp/pocl/kcache") : fs::path(home) / ".cache/pocl/kcache";
}

}  // namespace

fs::path unwritable_pocl_cache() {
    if (!has_pocl()) return {};
    auto cache = pocl_cache();
    std::error_code error;
    fs::create_directories(cache, error);
    return error || ::access(cache.c_str(), W_OK) != 0 ? cache : fs::path();
}

}  // namespace actformer::kernels
