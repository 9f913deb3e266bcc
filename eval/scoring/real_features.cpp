#include "eval/scoring/real_features.hpp"

#include "base/checksum/checksum.hpp"
#include "base/error.hpp"
#include "base/files/cache.hpp"
#include "base/files/lock.hpp"
#include "eval/stgcn/tuning.hpp"

namespace actformer::eval {
namespace {

namespace fs = std::filesystem;

/// What can be read; none where the file is not there or damaged.
std::optional<StoredFeatures> read_if_whole(const fs::path& path) {
    if (!fs::exists(path)) return {};
    try {
        return read_features(path);
    } catch (const Error&) {
        return {};
    }
}

bool can_write(const fs::path& folder) {
    std::error_code error;
    fs::create_directories(folder, error);
    if (error) return false;
    const auto probe = folder / "lock";
    const FileLock lock(probe);
    return fs::exists(probe);
}

}  // namespace

fs::path features_cached_at(const FeaturesRequest& request, const kernels::Device& device) {
    const ingest::Dataset dataset(request.input);
    const auto& info = device.info();
    Checksum key;
    key.add(fmt::format("{}|{}|{}|{}|{}|{}|{}|", ACTFORMER_VERSION, checksum_file(request.recogniser),
                        request.persons_apart, request.window, info.name, info.platform, info.driver));
    key.add(describe(load_tiles(info)));
    if (dataset.header().centre_windows) key.add("|centred windows");
    for (const auto& shard : dataset.shards()) key.add("|" + shard.checksum);
    for (const auto clip : dataset.split(request.split)) key.add("|" + dataset.clips()[clip].name);
    return cache_folder() / "features" / (key.hex() + ".h5");
}

CachedFeatures cached_features(FeaturesRequest request, kernels::Device& device, const Tell& tell) {
    const auto path = features_cached_at(request, device);
    if (!can_write(path.parent_path())) {
        make_features(request, device, tell);
        return {read_features(request.out), request.out};
    }
    const FileLock lock(path.string() + ".lock");
    if (auto kept = read_if_whole(path)) return {std::move(*kept), path};
    request.out = path;
    make_features(request, device, tell);
    return {read_features(path), path};
}

}  // namespace actformer::eval
