// A limit on the memory of this process. Needs nothing of the project.
#pragma once

#include <sys/resource.h>

#include <cstddef>

namespace actformer {

/// What OpenBLAS maps for each of its threads and each that calls it (its BUFFER_SIZE on x86-64), and keeps; bytes. It asks without end
/// where it gets none.
inline constexpr std::size_t openblas_buffer = std::size_t{128} << 20;

/// Whether the system gives this process no more than so much of it (ulimit -v).
inline bool memory_is_limited() {
    rlimit limit{};
    return ::getrlimit(RLIMIT_AS, &limit) == 0 && limit.rlim_cur != RLIM_INFINITY;
}

}  // namespace actformer
