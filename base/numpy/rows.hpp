// The rows of a NumPy array: what it has for each index of its first axis.
#pragma once

#include <algorithm>
#include <cstdint>
#include <string_view>
#include <vector>

#include "base/numpy/array.hpp"

namespace actformer {

/// The array must outlive this.
class NumpyRows {
  public:
    /// Throws Error, naming the array `name`, unless it holds numbers and has the axes (rows, inner...), where `inner` has one or two
    /// of them.
    NumpyRows(const NumpyArray& array, std::string_view name, const std::vector<std::uint64_t>& inner);

    /// The first `count` rows, or all where there are fewer.
    NumpyRows first(std::uint64_t count) const {
        auto out = *this;
        out.count_ = std::min(count_, count);
        return out;
    }

    std::uint64_t count() const { return count_; }
    std::size_t size() const { return static_cast<std::size_t>(outer_ * columns_); }  ///< numbers of a row

    /// Row `i` < count(), its last axis varying fastest.
    void read(std::uint64_t i, double* to) const;

  private:
    const NumpyArray* array_;
    std::uint64_t count_ = 0, rows_ = 0;     ///< that are read, and that the array has
    std::uint64_t outer_ = 1, columns_ = 1;  ///< of a row: (outer, columns)
};

}  // namespace actformer
