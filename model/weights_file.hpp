// Recogniser weights on disk: HDF5 under the public ST-GCN's names (DESIGN 3).
#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "model/array.hpp"
#include "model/stgcn.hpp"

namespace actformer::model {

/// float32 datasets; attributes channels, classes, parents, center, and `notes` as text (version, configuration, inputs).
/// The file appears whole or not at all. Throws Error where it cannot be written.
void save_weights(const std::filesystem::path& path, const StgcnSettings& settings,
                  const std::vector<Array>& arrays, const std::map<std::string, std::string>& notes);

}  // namespace actformer::model
