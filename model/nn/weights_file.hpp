// Weights on disk: HDF5, one float32 dataset an array.
#pragma once

#include <vector>

#include "base/hdf5/writer.hpp"
#include "model/nn/array.hpp"

namespace actformer::model {

/// A file in memory with a dataset of float32, which readers expect, for every array.
hdf5::Writer weights_writer(const std::vector<Array>& arrays);

}  // namespace actformer::model
