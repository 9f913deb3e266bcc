#include "base/text/nearest_word.hpp"

#include <gtest/gtest.h>

namespace actformer {
namespace {

TEST(NearestWord, CountsSwapsAndParts) {
    const std::vector<std::string> words{"batch", "rate", "epochs"};
    EXPECT_EQ(nearest_word("bathc", words), "batch");
    EXPECT_EQ(nearest_word("epoch", words), "epochs");
    EXPECT_EQ(nearest_word("learning_rate", words), "rate");
    EXPECT_EQ(nearest_word("zzzzzz", words), "");
    EXPECT_EQ(nearest_word("table-smal", {"table", "table-small"}), "table-small")
        << "more of it is the same";
}

TEST(NearestWord, CountsTheFewestEdits) {
    EXPECT_EQ(edit_distance("", ""), 0U);
    EXPECT_EQ(edit_distance("", "abc"), 3U);
    EXPECT_EQ(edit_distance("abc", ""), 3U);
    EXPECT_EQ(edit_distance("kitten", "sitting"), 3U);
    EXPECT_EQ(edit_distance("abcd", "badc"), 2U) << "two swaps";
    EXPECT_EQ(edit_distance("ca", "abc"), 3U) << "no letter is moved twice";
}

TEST(NearestWord, OfHugeWordsThereIsNone) {
    const std::string huge(10'000'000, 'x');
    EXPECT_EQ(nearest_word(huge, {huge + "y", "x"}), "");
    EXPECT_EQ(nearest_word("xx", {huge, "xy"}), "xy");
}

}  // namespace
}  // namespace actformer
