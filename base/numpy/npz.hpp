// NumPy's .npz files: zip archives with a NAME.npy an array, stored or deflated.
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <string_view>

#include "base/numpy/npy.hpp"

namespace actformer {

/// What of an archive is read.
struct NpzSelection {
    bool heads_only = false;  ///< large arrays come without values, and little of the archive is unpacked
    std::uint64_t largest = std::uint64_t{4} << 30;  ///< bytes that an array may have, for it lies in memory
    std::function<bool(const std::string& name)>
        wanted{};  ///< the others are passed over; empty: all are wanted
};

/// Calls `use` with each array in the order of the archive. The array lives until `use` returns. Throws Error, saying which array is at
/// fault but not in which file.
void read_npz(std::string_view bytes, const NpzSelection& selection,
              const std::function<void(const std::string& name, const NumpyArray& array)>& use);

}  // namespace actformer
