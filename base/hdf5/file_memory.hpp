// Memory for an HDF5 file that never was on disk.
#pragma once

#include <hdf5.h>

#include <cstddef>
#include <cstdlib>
#include <memory>

namespace actformer::hdf5 {

/// Grows with the file and begins at a page, as must what is written to disk past the page cache. Outlives the file.
class FileMemory {
  public:
    /// Room for `expected` bytes is set aside; the system gives it as it fills.
    explicit FileMemory(std::size_t expected) : expected_(expected) {}

    /// Makes the file that is opened with `access` live here.
    void serve(hid_t access);

  private:
    void* resize(std::size_t size);

    std::size_t expected_, used_ = 0, room_ = 0;
    std::unique_ptr<char, decltype(&std::free)> bytes_{nullptr, &std::free};
};

}  // namespace actformer::hdf5
