// Weights out of the files that PyTorch's users have.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "model/nn/array.hpp"

namespace actformer::model {

struct TorchArrays {
    std::vector<Array> arrays;          ///< named by all keys on their way, as in "decoder.output.weight"
    std::vector<std::string> prefixes;  ///< that dicts give their arrays, as in "model."; the first is empty

    /// Those behind a prefix, without it.
    std::vector<Array> behind(const std::string& prefix) const;
};

/// Of a state_dict, or a dict that holds state_dicts, saved by torch.save. Nothing in the file is run. Throws Error, one line
/// that names the file and the place in it, for what is damaged, would have to be run, or was made to exhaust its readers.
TorchArrays read_torch_arrays(const std::filesystem::path& file);

/// The shape of an array of two axes; {0, 0} where there is none of that name.
std::pair<std::int64_t, std::int64_t> matrix_shape(const std::vector<Array>& arrays, const std::string& name);

/// "'a', 'b', 'c' and 12 more"
std::string names_of(const std::vector<Array>& arrays);

}  // namespace actformer::model
