// The arrays of a body model's file, whichever way they were written.
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <string_view>
#include <vector>

namespace actformer::ingest {

/// Numbers in C order: the last axis varies fastest.
struct ModelArray {
    std::vector<std::uint64_t> shape;
    std::vector<double> values;

    /// "(24, 6890)"
    std::string shape_text() const;
};

using ModelArrays = std::map<std::string, ModelArray>;

/// Those arrays of `wanted` that a .npz has, of any type and order of bytes and axes. Throws Error, saying which array is at fault but
/// not in which file, where the archive is damaged or one of them is no array of numbers.
ModelArrays read_model_npz(std::string_view bytes, const std::vector<std::string>& wanted);

/// The same of a pickled dict whose values are NumPy's arrays, matrices of scipy's csc format, or chumpy's Ch and Select over arrays.
ModelArrays read_model_pickle(std::string_view bytes, const std::vector<std::string>& wanted);

}  // namespace actformer::ingest
