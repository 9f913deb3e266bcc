// NumPy's .npz files: zip archives with a NAME.npy an array, stored or deflated.
#pragma once

#include <functional>
#include <string>
#include <string_view>

#include "base/numpy/npy.hpp"

namespace actformer {

/// Calls `use` with each array in the order of the archive. The array lives until `use` returns. Where `heads_only` it comes without
/// values, and little of the archive is unpacked. Throws Error, saying which array is at fault but not in which file.
void read_npz(std::string_view bytes, bool heads_only,
              const std::function<void(const std::string& name, const NumpyArray& array)>& use);

}  // namespace actformer
