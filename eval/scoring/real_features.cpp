#include "eval/scoring/real_features.hpp"

#include "base/checksum/checksum.hpp"
#include "base/error.hpp"
#include "base/files/cache.hpp"
#include "base/files/lock.hpp"
#include "eval/stgcn/tuning.hpp"
#include "ingest/dataset/dataset.hpp"

namespace actformer::eval {
namespace {

namespace fs = std::filesystem;

/// What can be read; none where the file is not there or damaged.
std::optional<StoredFeatures> read_if_whole(const fs::path& path) {
    if (!is_as_written(path)) return {};
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

fs::path features_cached_at(const FeatureExtractor& extractor, const WindowsOptions& windows,
                            const kernels::Device& device) {
    const ingest::Dataset dataset(windows.dataset);
    const auto& info = device.info();
    Checksum key;
    key.add(fmt::format("{}|{}|{}|{}|{}|{}|{}|", ACTFORMER_VERSION, extractor.checksum(),
                        extractor.persons() == FeatureExtractor::Persons::apart, windows.window, info.name,
                        info.platform, info.driver));
    key.add(describe(load_tiles(info)));
    if (dataset.header().centre_windows) key.add("|centred windows");
    if (windows.joints == ingest::Joints::common15) key.add("|common joints, centred windows");
    for (const auto& shard : dataset.shards()) key.add("|" + shard.checksum);
    for (const auto clip : dataset.split(windows.split)) key.add("|" + dataset.clips()[clip].name);
    return cache_folder() / "features" / (key.hex() + ".h5");
}

CachedFeatures cached_features(FeatureExtractor& extractor, const WindowsOptions& windows,
                               const fs::path& elsewhere, kernels::Device& device, const OnProgress& tell) {
    const auto make = [&](const fs::path& file) {
        const FeaturesTarget target{&extractor, file};
        write_features(*open_windows(device, windows), std::span(&target, 1), tell);
    };
    const auto path = features_cached_at(extractor, windows, device);
    if (!can_write(path.parent_path())) {
        make(elsewhere);
        return {read_features(elsewhere), elsewhere};
    }
    const FileLock lock(path.string() + ".lock");
    if (auto kept = read_if_whole(path)) return {std::move(*kept), path};
    const auto note = fs::exists(path)
                          ? fmt::format("{}: damaged, or of an earlier version; made anew", path.string())
                          : "";
    make(path);
    return {read_features(path), path, note};
}

}  // namespace actformer::eval
