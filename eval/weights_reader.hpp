// What recognisers' weights files have in common. Errors are one line that names the file and the place in it.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "ingest/dataset/representation.hpp"

namespace actformer::hdf5 {
class Reader;
}

namespace actformer::eval {

using TensorShape = std::vector<std::uint64_t>;

/// The attributes `channels`, `classes`, `parents`, and where they are there `representation` (else limbs) and `class_names`.
struct RecogniserAttributes {
    std::uint32_t channels = 0, classes = 0;
    std::vector<int> parents;  ///< (K) a tree; -1 for the root
    ingest::Representation representation;
    std::vector<std::string> class_names;  ///< (classes), or empty
};

/// Throws Error for what is missing or out of range, for parents that are no tree and names of other classes.
RecogniserAttributes read_attributes(const hdf5::Reader& file, const std::string& path);

/// Throws Error unless the attribute is one number from `least` to `most`.
std::uint32_t one_number(const hdf5::Reader& file, const std::string& path, const std::string& name,
                         std::int64_t least, std::int64_t most);

/// Throws Error for an array that is missing, of another shape, or not finite.
std::vector<float> read_tensor(const hdf5::Reader& file, const std::string& path, const std::string& name,
                               const TensorShape& expected);

}  // namespace actformer::eval
