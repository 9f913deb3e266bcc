#include "ingest/pipeline/packed_names.hpp"

#include <algorithm>
#include <array>
#include <span>

#include "base/text/counted.hpp"
#include "base/text/extension.hpp"
#include "base/text/first_few.hpp"
#include "base/text/printable.hpp"

namespace actformer::ingest {
namespace {

constexpr std::array<std::string_view, 7> archives{".zip", ".tar", ".tgz", ".tbz2", ".txz", ".7z", ".rar"};
constexpr std::array<std::string_view, 6> compressions{".gz", ".bz2", ".xz", ".zst", ".lz4", ".lz"};

bool ends_in_one(std::string_view path, std::span<const std::string_view> extensions) {
    return std::ranges::any_of(extensions,
                               [&](auto extension) { return ends_in_extension(path, extension); });
}

bool is_compressed(std::string_view path) {
    return ends_in_one(path, compressions);
}

bool is_archive(std::string_view path) {
    return ends_in_one(path, archives) ||
           (is_compressed(path) && ends_in_extension(path.substr(0, path.rfind('.')), ".tar"));
}

/// `noun` is what they are; `remedy` names them by {}.
std::string remark(const std::filesystem::path& folder, const std::vector<std::string>& paths,
                   const std::string& noun, fmt::format_string<const char*&> remedy) {
    const bool one = paths.size() == 1;
    const char* them = one ? "it" : "them";
    return fmt::format("{} in {} {} not read ({}): {}", counted(paths.size(), noun),
                       printable(folder.string()), one ? "is" : "are", first_few(paths),
                       fmt::format(remedy, them));
}

}  // namespace

bool is_packed(std::string_view path) {
    return is_archive(path) || is_compressed(path);
}

std::vector<std::string> remarks_on_packed(const std::filesystem::path& folder,
                                           std::vector<std::string> paths) {
    std::ranges::sort(paths);
    std::vector<std::string> whole, single;
    for (const auto& path : paths) (is_archive(path) ? whole : single).push_back(printable(path));
    std::vector<std::string> lines;
    if (!whole.empty())
        lines.push_back(remark(folder, whole, "archive", "unless unpacked there, give {} as RAW too"));
    if (!single.empty()) lines.push_back(remark(folder, single, "compressed file", "unpack {}"));
    return lines;
}

}  // namespace actformer::ingest
