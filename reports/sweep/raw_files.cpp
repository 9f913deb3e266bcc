#include "reports/sweep/raw_files.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <set>
#include <vector>

#include "base/checksum/checksum.hpp"

namespace actformer::reports {
namespace {

namespace fs = std::filesystem;

/// Links to folders are followed, each folder once.
std::vector<fs::path> files_below(const fs::path& folder, const fs::path& left_out) {
    std::vector<fs::path> files;
    std::error_code error, ignored;
    std::set<fs::path> passed{fs::canonical(left_out, ignored)};
    const auto options = fs::directory_options::follow_directory_symlink;
    for (fs::recursive_directory_iterator it(folder, options, error), end; !error && it != end;
         it.increment(error)) {
        if (!it->is_directory(ignored))
            files.push_back(it->path());
        else if (!passed.insert(fs::canonical(it->path(), ignored)).second)
            it.disable_recursion_pending();
    }
    std::sort(files.begin(), files.end());
    return files;
}

}  // namespace

std::string listing_of(const fs::path& raw, const fs::path& left_out) {
    std::error_code ignored;
    const bool folder = fs::is_directory(raw, ignored);
    Checksum sum;
    for (const auto& file : folder ? files_below(raw, left_out) : std::vector{raw}) {
        const auto size = fs::file_size(file, ignored);
        const auto changed = fs::last_write_time(file, ignored).time_since_epoch().count();
        sum.add(
            fmt::format("{}\n{} {}\n", folder ? file.lexically_relative(raw).string() : "", size, changed));
    }
    return sum.hex();
}

}  // namespace actformer::reports
