// Every test draws the same numbers, whichever tests run before it in its process.
#include <ATen/ATen.h>
#include <gtest/gtest.h>

namespace {

class Seeds : public testing::EmptyTestEventListener {
    void OnTestStart(const testing::TestInfo&) override { at::manual_seed(0); }
};

const bool seeded = [] {
    testing::UnitTest::GetInstance()->listeners().Append(new Seeds);  // which deletes it
    return true;
}();

}  // namespace
