#include "base/text/first_few.hpp"

#include <gtest/gtest.h>

using namespace actformer;

TEST(LongLists, AreCutWithDots) {
    EXPECT_EQ(first_few({}), "");
    EXPECT_EQ(first_few({"a", "b", "c"}), "a, b, c");
    EXPECT_EQ(first_few({"a", "b", "c", "d"}), "a, b, c, ...");
}

TEST(LongLists, AreCutWithTheNumberLeftOut) {
    EXPECT_EQ(few_and_more({}, 2), "");
    EXPECT_EQ(few_and_more({"a", "b"}, 2), "a, b");
    EXPECT_EQ(few_and_more({"a", "b", "c", "d", "e"}, 2), "a, b and 3 more");
}
