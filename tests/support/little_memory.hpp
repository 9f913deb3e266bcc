// A process that the system gives no more memory.
#pragma once

#include <sys/resource.h>

#include <fstream>

namespace actformer::test {

/// Leaves this process 64 MiB: room for a few threads' stacks.
inline void leave_little_memory() {
    std::size_t pages = 0;
    std::ifstream("/proc/self/statm") >> pages;
    const rlim_t most = pages * 4096 + (rlim_t{64} << 20);
    const rlimit limit{most, most};
    ::setrlimit(RLIMIT_AS, &limit);
}

#if defined(__SANITIZE_ADDRESS__)
inline constexpr bool address_sanitized = true;
#elif defined(__has_feature)
inline constexpr bool address_sanitized = __has_feature(address_sanitizer);
#else
inline constexpr bool address_sanitized = false;
#endif
inline constexpr const char* why_not =
    "a sanitizer wants memory of its own, and ends where it is refused that";

}  // namespace actformer::test
