// A thread that does jobs while the next ones are prepared. `./run sanitize thread` runs these under ThreadSanitizer.
#include "base/threads/worker.hpp"

#include <gtest/gtest.h>

#include <stdexcept>
#include <vector>

using namespace actformer;

TEST(Workers, DoJobsInTheirOrder) {
    std::vector<int> done;  // by the worker alone until finish() returns
    Worker worker(2);
    for (int i = 0; i < 1000; ++i) worker.add([&done, i] { done.push_back(i); });
    worker.finish();
    ASSERT_EQ(done.size(), 1000U);
    for (int i = 0; i < 1000; ++i) EXPECT_EQ(done[static_cast<std::size_t>(i)], i);
}

TEST(Workers, ThrowWhatAJobThrewAndBeginNoOther) {
    bool later = false;
    Worker worker(8);
    worker.add([] { throw std::runtime_error("broken"); });
    EXPECT_THROW(worker.finish(), std::runtime_error);
    EXPECT_THROW(worker.add([&later] { later = true; }), std::runtime_error);
    EXPECT_FALSE(later);
}
