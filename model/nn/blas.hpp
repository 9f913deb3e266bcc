// Whether libtorch's matrix products run at the machine's speed.
#pragma once

#include <string>

namespace actformer::model {

struct BlasCheck {
    std::string library;  ///< file that matrix products come from; empty where it is inside libtorch
    std::string core;     ///< processor that OpenBLAS takes this one for; empty for others
    double gflops = 0;    ///< measured, on the threads set
    bool slow = false;
    std::string line;  ///< all of it in one line, with the remedy where it is slow
};

/// Takes some ten milliseconds. Debian's libtorch falls back to the reference BLAS where OpenBLAS is not installed, and
/// OpenBLAS itself to kernels of 2004 on a processor newer than it.
BlasCheck check_blas();

/// Sets the threads of libtorch, which starts with one unless told; 0 means OMP_NUM_THREADS, or where that is not set as many as this
/// process may use. Returns how many were set. Throws Error where memory or threads for them cannot be had.
int set_threads(int threads);

}  // namespace actformer::model
