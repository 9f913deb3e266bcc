// Opening HDF5 files to read, and why one does not open.
#pragma once

#include <filesystem>
#include <string_view>

#include "base/hdf5/handle.hpp"

namespace actformer::hdf5 {

/// Throws Error: no such file, no regular file, open for writing elsewhere, left open by a program that was killed, no HDF5 file, or
/// damaged, as the checksum at its end tells where there is one.
Handle open_to_read(const std::filesystem::path& path);

/// A copy of `image`. Throws Error, beginning with `name`.
Handle open_in_memory(std::string_view image, const std::string& name);

}  // namespace actformer::hdf5
