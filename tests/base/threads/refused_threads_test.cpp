// Threads that the system refuses: a limit on memory that leaves no room for their stacks.
#include <gtest/gtest.h>

#include <cstring>

#include "base/error.hpp"
#include "base/threads/parallel.hpp"
#include "base/threads/worker.hpp"
#include "tests/support/little_memory.hpp"

using namespace actformer;
using namespace actformer::test;

namespace {

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

}  // namespace

TEST(RefusedThreads, StopALoopThatWantsThem) {
    if (address_sanitized) GTEST_SKIP() << why_not;
    const auto loop = [] {
        std::atomic<int> begun{0};
        parallel_for(100'000, 500, [&](std::size_t, unsigned) { ++begun; });
    };
    EXPECT_EXIT(end_with_refusal(loop), testing::ExitedWithCode(3), "");
}

TEST(RefusedThreads, AreToldBeforeALibraryWantsThem) {
    if (address_sanitized) GTEST_SKIP() << why_not;
    EXPECT_EXIT(end_with_refusal([] { expect_threads(500); }), testing::ExitedWithCode(3), "");
    expect_threads(4);
}
