// Texts of variable length, whose characters lie in the file's global heaps (HDF5 File Format Specification, section III.E). They are
// read past the library: version 1.10.8 believes the lengths that a file states, and writes behind its own memory.
#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <string>
#include <string_view>
#include <vector>

namespace actformer::hdf5 {

/// `size` bytes of the file from `offset` on; fewer where the file ends before.
using FileBytes = std::function<std::string(std::uint64_t offset, std::uint64_t size)>;

/// The texts that `references` stand for: 16 bytes each, a length, a heap's address and an index into it. False where one leads
/// nowhere, or where they come to more than `most` bytes together.
bool read_variable_texts(std::string_view references, const FileBytes& file, std::uint64_t most,
                         std::vector<std::string>& texts);

}  // namespace actformer::hdf5
