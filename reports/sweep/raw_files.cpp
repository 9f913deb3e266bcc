#include "reports/sweep/raw_files.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <set>
#include <vector>

#include "base/checksum/checksum.hpp"
#include "ingest/dataset/own_kind.hpp"

namespace actformer::reports {
namespace {

namespace fs = std::filesystem;

/// Lists the files below a folder, in an order that depends on names alone. Links to folders are followed, each folder once.
class Listing {
  public:
    explicit Listing(const fs::path& left_out) {
        std::error_code ignored;
        passed_.insert(fs::canonical(left_out, ignored));
    }

    std::vector<fs::path> files_below(const fs::path& folder) {
        std::vector<fs::path> files;
        walk(folder, files);
        return files;
    }

  private:
    void walk(const fs::path& folder, std::vector<fs::path>& files) {
        std::error_code error, ignored;
        if (!passed_.insert(fs::canonical(folder, ignored)).second) return;
        std::vector<fs::directory_entry> entries;
        for (fs::directory_iterator it(folder, error), end; !error && it != end; it.increment(error))
            if (!is_aside(it->path().filename().native())) entries.push_back(*it);
        std::sort(entries.begin(), entries.end());
        for (const auto& entry : entries) {
            if (!entry.is_directory(ignored))
                files.push_back(entry.path());
            else if (!is_made(entry.path()))
                walk(entry.path(), files);
        }
    }

    /// By this program, out of raw files.
    static bool is_made(const fs::path& folder) {
        const auto kind = ingest::own_kind(folder);
        return kind == ingest::own::dataset || kind == ingest::own::training || kind == ingest::own::sweep;
    }

    /// Hidden ones, as network drives leave them, and editors' copies.
    static bool is_aside(const std::string& name) { return name.starts_with('.') || name.ends_with('~'); }

    std::set<fs::path> passed_;
};

}  // namespace

std::string listing_of(const fs::path& raw, const fs::path& left_out) {
    std::error_code ignored;
    const bool folder = fs::is_directory(raw, ignored);
    Checksum sum;
    for (const auto& file : folder ? Listing(left_out).files_below(raw) : std::vector{raw}) {
        const auto size = fs::file_size(file, ignored);
        const auto changed = fs::last_write_time(file, ignored).time_since_epoch().count();
        sum.add(
            fmt::format("{}\n{} {}\n", folder ? file.lexically_relative(raw).string() : "", size, changed));
    }
    return sum.hex();
}

}  // namespace actformer::reports
