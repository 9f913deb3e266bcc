#include "ingest/dataset/own_kind.hpp"

#include <algorithm>
#include <map>

#include "base/error.hpp"
#include "base/hdf5/reader.hpp"

namespace actformer::ingest {
namespace {

namespace fs = std::filesystem;

bool holds(const fs::path& folder, const char* name) {
    std::error_code unread;
    return fs::exists(folder / name, unread);
}

std::string_view kind_of_folder(const fs::path& folder) {
    if (holds(folder, "config.yaml") && (holds(folder, "log.jsonl") || holds(folder, "lock")))
        return own::training;
    if (holds(folder, "dataset.json")) return own::dataset;
    if (holds(folder, "results.json")) return own::sweep;
    return holds(folder, "synth.json") ? own::raw : std::string_view();
}

/// Arrays (P*C, K, T) alone, whoever wrote them.
bool holds_motions(const hdf5::Reader& file) {
    const auto names = file.names();
    return !names.empty() && std::ranges::all_of(names, [&](const auto& name) {
        return file.is_array(name) && file.shape(name).size() == 3;
    });
}

}  // namespace

std::string_view own_kind(const hdf5::Reader& file) {
    if (file.has_attribute("model")) return own::generator;
    if (file.has_attribute("kind")) return own::recogniser;
    if (file.has("features") && file.shape("features").size() == 2) return own::features;
    if (file.has("motion") && file.has("clip") && !file.is_array("clip")) return own::shard;
    return {};
}

std::string_view own_kind(const fs::path& path) {
    std::error_code unread;
    if (fs::is_directory(path, unread)) return kind_of_folder(path);
    try {
        return fs::is_regular_file(path, unread) ? own_kind(hdf5::Reader(path)) : std::string_view();
    } catch (const Error&) {
        return {};  // what is wrong with it is told where it is read
    }
}

std::string_view other_kind(const fs::path& path, std::string_view wanted) {
    const auto kind = own_kind(path);
    const bool of_weights = wanted == own::generator || wanted == own::recogniser;
    return kind == wanted || (of_weights && kind == own::training) ? std::string_view() : kind;
}

void refuse_other_than_motions(const hdf5::Reader& file, const std::string& where) {
    static const std::map<std::string_view, const char*> remedies{
        {own::generator, "`actformer generate` makes motions with them"},
        {own::recogniser, "name a motions file, as `generate` and `export` make them"},
        {own::features, "name the motions that they are of"},
        {own::shard, "name its folder, the dataset"}};
    const auto kind = own_kind(file);
    if (const auto found = remedies.find(kind); found != remedies.end())
        throw Error("{}: {}, not motions; {}", where, kind, found->second);
}

void refuse_other_file(const hdf5::Reader& file, const std::string& where, std::string_view wanted,
                       std::string_view remedy) {
    auto kind = own_kind(file);
    if (kind.empty() && holds_motions(file)) kind = "motions";
    if (!kind.empty() && kind != wanted) throw Error("{}: holds {}, not {}; {}", where, kind, wanted, remedy);
}

void refuse_other_folder(const fs::path& out, std::string_view wanted) {
    std::error_code unread;
    if (fs::exists(out, unread) && !fs::is_directory(out, unread))
        throw Error("{}: a file, and a folder is expected; choose another -o", out.string());
    if (const auto kind = other_kind(out, wanted); !kind.empty())
        throw Error("{}: holds {}, not {}; choose another -o", out.string(), kind, wanted);
}

}  // namespace actformer::ingest
