// HDF5 files that are written to disk.
#pragma once

#include <hdf5.h>

#include "base/files/aside.hpp"

namespace actformer::hdf5 {

/// Makes the library write the file that is made with `access` through `file`, which outlives it. The library may drop a failure, as
/// where it empties its caches: file.check() does not.
void serve(Aside& file, hid_t access);

}  // namespace actformer::hdf5
