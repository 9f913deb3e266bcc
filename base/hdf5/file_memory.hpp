// Memory for an HDF5 file that never was on disk.
#pragma once

#include <hdf5.h>

#include <cstddef>
#include <memory>

namespace actformer::hdf5 {

struct Unmap {
    std::size_t bytes = 0;
    void operator()(char* memory) const;
};

/// Grows with the file and begins at a page, as must what is written to disk past the page cache. Outlives the file. It is mapped
/// on its own: such large blocks, made and freed in the heap, leave it in pieces too small for the next one.
class FileMemory {
  public:
    /// Room for `expected` bytes is set aside; the system gives it as it fills.
    explicit FileMemory(std::size_t expected) : expected_(expected) {}

    /// Makes the file that is opened with `access` live here.
    void serve(hid_t access);

  private:
    void* resize(std::size_t size);

    std::size_t expected_, used_ = 0;
    std::unique_ptr<char, Unmap> block_;
};

}  // namespace actformer::hdf5
