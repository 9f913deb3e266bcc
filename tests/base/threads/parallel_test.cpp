// Loops over several threads. `./run sanitize thread` runs these under ThreadSanitizer.
#include "base/threads/parallel.hpp"

#include <gtest/gtest.h>

#include <numeric>
#include <stdexcept>

using namespace actformer;

TEST(ParallelFor, VisitsEachOnceAndTellsThreadsApart) {
    constexpr std::size_t n = 10'000;
    constexpr unsigned threads = 4;
    std::vector<int> visits(n, 0), by_thread(threads, 0);  // no two threads write to the same
    parallel_for(n, threads, [&](std::size_t i, unsigned thread) {
        ++visits[i];
        ++by_thread.at(thread);
    });
    EXPECT_EQ(visits, std::vector<int>(n, 1));
    EXPECT_EQ(std::accumulate(by_thread.begin(), by_thread.end(), 0), static_cast<int>(n));
}

TEST(ParallelFor, ThrowsWhatItsBodyThrewAndStops) {
    std::atomic<std::size_t> begun{0};
    const auto loop = [&] {
        parallel_for(10'000'000, 4, [&](std::size_t i, unsigned) {
            ++begun;
            if (i == 10) throw std::runtime_error("ten");
        });
    };
    EXPECT_THROW(loop(), std::runtime_error);
    EXPECT_LT(begun, 10'000'000U);
    parallel_for(0, 4, [](std::size_t, unsigned) { FAIL() << "there is nothing to do"; });
}
