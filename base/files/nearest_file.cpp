#include "base/files/nearest_file.hpp"

#include <fmt/format.h>

#include <vector>

#include "base/text/nearest_word.hpp"
#include "base/text/printable.hpp"

namespace actformer {

namespace fs = std::filesystem;

namespace {

/// The entry of its folder that is called most like it; empty where none is.
fs::path nearest_entry(const fs::path& missing) {
    constexpr std::size_t most = 10'000;  // a folder of a million clips is not searched
    // Files are called in too many ways: their first letters must be those, or all but one letter of the name.
    constexpr std::size_t sure = 2;
    const auto name = missing.filename().string();
    std::vector<std::string> names;
    std::error_code ignored;
    const auto folder = missing.has_parent_path() ? missing.parent_path() : fs::path(".");
    for (fs::directory_iterator at(folder, ignored), end; !ignored && at != end && names.size() < most;
         at.increment(ignored))
        if (auto other = at->path().filename().string();
            other != name && (other.starts_with(name.substr(0, sure)) || edit_distance(name, other) == 1))
            names.push_back(std::move(other));
    const auto nearest = nearest_word(name, names);
    return nearest.empty() ? fs::path{} : missing.parent_path() / nearest;
}

}  // namespace

std::string did_you_mean(const fs::path& missing) {
    auto path = missing.lexically_normal();
    if (!path.has_filename()) path = path.parent_path();  // as in "ntu/"
    std::error_code ignored;
    bool folder = false;
    while (path.has_parent_path() && path.parent_path() != path &&
           !fs::is_directory(path.parent_path(), ignored)) {
        path = path.parent_path();
        folder = true;
    }
    const auto nearest = nearest_entry(path);
    if (nearest.empty()) return {};
    return folder ? fmt::format("; there is no {}, did you mean {}?", printable(path.string()),
                                printable(nearest.string()))
                  : fmt::format("; did you mean {}?", printable(nearest.string()));
}

}  // namespace actformer
