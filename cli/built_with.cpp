#include "cli/built_with.hpp"

#include <fmt/format.h>

#include <string_view>

namespace actformer::cli {
namespace {

#if defined __clang__
constexpr const char* compiler = "Clang " __clang_version__;
#else
constexpr const char* compiler = "GCC " __VERSION__;
#endif

}  // namespace

std::string built_with() {
    const std::string_view of(commit);
    return fmt::format("{}{}\nbuilt by {}, {}\nwith {}", ACTFORMER_VERSION,
                       of.empty() ? "" : fmt::format(" (commit {})", of), compiler, ACTFORMER_BUILD,
                       ACTFORMER_LIBRARIES);
}

}  // namespace actformer::cli
