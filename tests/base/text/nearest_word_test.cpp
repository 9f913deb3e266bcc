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

}  // namespace
}  // namespace actformer
