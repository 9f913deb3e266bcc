// How many threads libtorch gets.
#include "model/nn/blas.hpp"

#include <ATen/Parallel.h>
#include <gtest/gtest.h>

#include <cstdlib>
#include <optional>
#include <string>

using namespace actformer::model;

namespace {

/// OMP_NUM_THREADS as it was when this goes.
struct Threads : ::testing::Test {
    Threads() {
        if (const char* text = std::getenv("OMP_NUM_THREADS")) before_ = text;
    }
    ~Threads() override {
        ::unsetenv("OMP_NUM_THREADS");
        if (before_) ::setenv("OMP_NUM_THREADS", before_->c_str(), 1);
        set_threads(0);
    }

    static int with(const char* text) {
        ::setenv("OMP_NUM_THREADS", text, 1);
        return set_threads(0);
    }

  private:
    std::optional<std::string> before_;
};

}  // namespace

TEST_F(Threads, AreThoseThatTheEnvironmentSays) {
    EXPECT_EQ(with("3"), 3);
    EXPECT_EQ(at::get_num_threads(), 3);
    EXPECT_EQ(with("1,2"), 1) << "of a list the first, as OpenMP takes it";
    EXPECT_EQ(set_threads(2), 2) << "a number goes before it";
}

TEST_F(Threads, AreAllWhereTheEnvironmentSaysNothingOfUse) {
    ::unsetenv("OMP_NUM_THREADS");
    const int all = set_threads(0);
    EXPECT_GE(all, 1);
    for (const char* text : {"", "0", "-2", "many"}) EXPECT_EQ(with(text), all) << text;
}
