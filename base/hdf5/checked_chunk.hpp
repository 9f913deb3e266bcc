// Chunks of float32 with their checksum behind, read past the library's filters, which take ten times as long and take a chunk
// that the file's index does not list for zeros.
#pragma once

#include <hdf5.h>

#include <span>
#include <vector>

#include "base/hdf5/handle.hpp"

namespace actformer::hdf5 {

/// The chunks of an array whose only filter is the checksum; empty for any other array.
Shape checked_chunk_of(hid_t plan, std::size_t rank);

/// The chunk that begins at `at`, in `memory`, which has room for one number more. False where it is not there whole, or not what its
/// checksum says.
bool read_checked_chunk(hid_t set, const Shape& at, std::vector<float>& memory);

}  // namespace actformer::hdf5
