// A recogniser's weights on disk: HDF5, float32 under the public ST-GCN's names.
#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "model/nn/array.hpp"
#include "model/recognisers/stgcn.hpp"

namespace actformer::model {

/// Datasets of `arrays`; attributes kind ("stgcn"), channels, classes, class_names, parents, center, and `notes` as text (version, configuration, inputs).
/// The file appears whole or not at all. Throws Error where it cannot be written.
void save_stgcn_weights(const std::filesystem::path& path, const StgcnSettings& settings,
                        const std::vector<Array>& arrays, const std::map<std::string, std::string>& notes,
                        const std::vector<std::string>& class_names = {});

}  // namespace actformer::model
