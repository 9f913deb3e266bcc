// Threads that the system refuses: a limit on memory that leaves no room for their stacks.
#include <gtest/gtest.h>
#include <sys/resource.h>

#include <cstring>
#include <fstream>

#include "base/error.hpp"
#include "base/threads/parallel.hpp"
#include "base/threads/worker.hpp"

using namespace actformer;

namespace {

/// Leaves this process room for a few stacks.
void leave_little_memory() {
    std::size_t pages = 0;
    std::ifstream("/proc/self/statm") >> pages;
    const rlim_t most = pages * 4096 + (rlim_t{64} << 20);
    const rlimit limit{most, most};
    ::setrlimit(RLIMIT_AS, &limit);
}

/// Ends this process with 3 where `work` is refused a thread.
template <typename Work>
[[noreturn]] void end_with_refusal(Work work) {
    leave_little_memory();
    try {
        work();
    } catch (const Error& e) {
        std::_Exit(std::strstr(e.what(), "no thread can be had") ? 3 : 4);
    }
    std::_Exit(5);
}

#if defined(__SANITIZE_ADDRESS__)
constexpr bool sanitized = true;
#elif defined(__has_feature)
constexpr bool sanitized = __has_feature(address_sanitizer);
#else
constexpr bool sanitized = false;
#endif
constexpr const char* why_not = "a sanitizer wants memory of its own, and ends where it is refused that";

}  // namespace

TEST(RefusedThreads, StopALoopThatWantsThem) {
    if (sanitized) GTEST_SKIP() << why_not;
    const auto loop = [] {
        std::atomic<int> begun{0};
        parallel_for(100'000, 500, [&](std::size_t, unsigned) { ++begun; });
    };
    EXPECT_EXIT(end_with_refusal(loop), testing::ExitedWithCode(3), "");
}

TEST(RefusedThreads, AreToldBeforeALibraryWantsThem) {
    if (sanitized) GTEST_SKIP() << why_not;
    EXPECT_EXIT(end_with_refusal([] { expect_threads(500); }), testing::ExitedWithCode(3), "");
    expect_threads(4);
}
