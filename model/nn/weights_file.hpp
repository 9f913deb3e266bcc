// Weights on disk: HDF5, a recogniser's under the public ST-GCN's names (DESIGN 3).
#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "base/hdf5/writer.hpp"
#include "model/nn/array.hpp"
#include "model/recognisers/stgcn.hpp"

namespace actformer::model {

/// A file in memory with a dataset of float32, which readers expect, for every array.
hdf5::Writer weights_writer(const std::vector<Array>& arrays);

/// Those datasets; attributes kind, channels, classes, class_names, parents, center, and `notes` as text (version, configuration, inputs).
/// The file appears whole or not at all. Throws Error where it cannot be written.
void save_weights(const std::filesystem::path& path, const StgcnSettings& settings,
                  const std::vector<Array>& arrays, const std::map<std::string, std::string>& notes,
                  const std::vector<std::string>& class_names = {});

}  // namespace actformer::model
