// Memory for HDF5 files that never were on disk, one after the other.
#pragma once

#include <hdf5.h>

#include <cstddef>
#include <memory>

namespace actformer::hdf5 {

struct Unmap {
    std::size_t bytes = 0;
    void operator()(char* memory) const;
};

/// Grows with the file and begins at a page, as must what is written to disk past the page cache. Outlives the file, and serves the
/// next one as it is: fresh pages, which the system clears, cost more than all else that is done to a file. It is mapped
/// on its own: such large blocks, made and freed in the heap, leave it in pieces too small for the next one.
class FileMemory {
  public:
    /// Makes the file that is opened with `access` live here, in place of the one before. Room for `expected` bytes is set aside; the
    /// system gives it as it fills.
    void serve(hid_t access, std::size_t expected);

  private:
    void* resize(std::size_t size);

    std::size_t expected_ = 0, used_ = 0;
    std::unique_ptr<char, Unmap> block_;
};

}  // namespace actformer::hdf5
