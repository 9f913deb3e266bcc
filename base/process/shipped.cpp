#include "base/process/shipped.hpp"

#include <algorithm>

#include "base/error.hpp"
#include "base/files/nearest_file.hpp"
#include "base/process/process.hpp"
#include "base/text/suggestion.hpp"

namespace actformer {

namespace fs = std::filesystem;

namespace {

bool is_file(const fs::path& path) {
    std::error_code ignored;
    return fs::is_regular_file(path, ignored);
}

std::string meant(const fs::path& named, const std::string& folder) {
    if (auto beside = did_you_mean(named); !beside.empty()) return beside;
    return suggestion(named.stem().string(), shipped_names(folder));
}

}  // namespace

fs::path shipped_folder() {
    const auto program = program_folder();
    std::error_code ignored;
    for (const auto* up : {".", "..", "../.."})
        if (auto folder = (program / up / "share/actformer").lexically_normal();
            fs::is_directory(folder, ignored))
            return folder;
    return {};
}

fs::path here_or_shipped(const fs::path& path) {
    std::error_code ignored;
    const auto folder = shipped_folder();
    if (path.empty() || path.is_absolute() || folder.empty() || fs::exists(path, ignored)) return path;
    auto shipped = folder / path;
    return fs::exists(shipped, ignored) ? shipped : path;
}

fs::path file_or_shipped(const fs::path& named, const std::string& folder) {
    if (is_file(named)) return named;
    const auto shipped = shipped_folder();
    if (!shipped.empty() && named.is_relative())
        for (const auto& place : {shipped / named, shipped / folder / named})
            for (const auto* ending : {"", ".yaml"})
                if (const auto path = fs::path(place.string() + ending); is_file(path)) return path;
    std::error_code ignored;
    if (fs::exists(named, ignored)) throw Error("{}: not a file; a .yaml file is expected", named.string());
    throw Error("{}: no such file, and none of that name in {}, which come with the program{}",
                named.string(), folder, meant(named, folder));
}

std::vector<std::string> shipped_names(const std::string& folder) {
    std::vector<std::string> names;
    std::error_code ignored;
    for (const auto& entry : fs::directory_iterator(shipped_folder() / folder, ignored))
        if (entry.path().extension() == ".yaml") names.push_back(entry.path().stem().string());
    std::ranges::sort(names);
    return names;
}

}  // namespace actformer
