// Features of a dataset's split, made once: scoring asks for the same real side over and over.
#pragma once

#include "eval/scoring/features.hpp"
#include "eval/scoring/features_file.hpp"
#include "eval/scoring/windows_source.hpp"

namespace actformer::eval {

/// Where the features of those windows are kept: cache_folder()/features/KEY.h5. The key is a checksum of all that decides
/// them: the recogniser's weights, the dataset's shards, the split's clips, the window, the device with its driver and
/// tiles, and the program's version. A few dozen MB a split at paper scale; any of them may be deleted.
std::filesystem::path features_cached_at(const FeatureExtractor& extractor, const WindowsOptions& windows,
                                         const kernels::Device& device);

struct CachedFeatures {
    StoredFeatures features;
    std::filesystem::path file;  ///< that they are in
    std::string note{};  ///< of kept ones that were damaged and have been made anew; empty where none were
};

/// Reads them from there, where need be making them first. Of several processes that want the same features one makes them
/// and the others wait; what is damaged is made anew. `elsewhere` is written only where the cache cannot be. Throws Error as
/// open_windows, write_features and read_features do.
CachedFeatures cached_features(FeatureExtractor& extractor, const WindowsOptions& windows,
                               const std::filesystem::path& elsewhere, kernels::Device& device,
                               const OnProgress& tell = {});

}  // namespace actformer::eval
