// An attribute's stored bytes, out of the header of what it belongs to (HDF5 File Format Specification, section IV.A). The library gives
// attributes in memory alone, and texts of variable length must be read past it: see variable_texts.hpp.
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "base/hdf5/variable_texts.hpp"

namespace actformer::hdf5 {

/// Of the attribute `name` of the object whose header is at `address`. None where it does not lie in the header: those of objects with
/// many attributes do not, in files of the newest form.
std::optional<std::string> attribute_bytes(std::uint64_t address, const std::string& name,
                                           const FileBytes& file);

}  // namespace actformer::hdf5
