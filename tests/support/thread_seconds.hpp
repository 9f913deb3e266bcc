// Time that work takes however busy the machine is.
#pragma once

#include <ctime>

namespace actformer::test {

/// Seconds that this thread has had a processor.
inline double thread_seconds() {
    timespec now{};
    ::clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
    return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

}  // namespace actformer::test
