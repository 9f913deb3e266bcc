// A limit on the memory of this process. Needs nothing of the project.
#pragma once

#include <sys/resource.h>

namespace actformer {

/// Whether the system gives this process no more than so much of it (ulimit -v).
inline bool memory_is_limited() {
    rlimit limit{};
    return ::getrlimit(RLIMIT_AS, &limit) == 0 && limit.rlim_cur != RLIM_INFINITY;
}

}  // namespace actformer
