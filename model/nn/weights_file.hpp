// Weights on disk: HDF5, one float32 dataset an array.
#pragma once

#include <string>
#include <vector>

#include "base/hdf5/reader.hpp"
#include "base/hdf5/writer.hpp"
#include "model/nn/array.hpp"

namespace actformer::model {

/// A file in memory with a dataset of float32, which readers expect, for every array.
hdf5::Writer weights_writer(const std::vector<Array>& arrays);

/// All arrays of such a file. Throws Error as hdf5::Reader does, and of numbers that are not finite; `where` names the file there.
std::vector<Array> read_arrays(const hdf5::Reader& file, const std::string& where);

}  // namespace actformer::model
