// BABEL's annotations: what they may hold, and that odd ones take no time.
#include "ingest/formats/babel/annotations.hpp"

#include <gtest/gtest.h>

#include "tests/support/thread_seconds.hpp"

namespace actformer::ingest {
namespace {

TEST(BabelAnnotations, TakesEachCategoryOfALabelOnceHoweverManyThereAre) {
    constexpr std::size_t categories = 200'000;
    std::string names = "\"walk\", \"walk\"";
    for (std::size_t i = 0; i < categories; ++i) names += ", \"c" + std::to_string(i) + "\"";
    const auto text =
        R"({"1": {"feat_p": "a/b_poses.npz", "seq_ann": {"labels": [{"act_cat": [)" + names + "]}]}}}";
    const auto begin = test::thread_seconds();
    const auto found = read_annotations(text);
    EXPECT_LT(test::thread_seconds() - begin, 10);
    ASSERT_TRUE(std::holds_alternative<Annotations>(found));
    const auto& sequences = std::get<Annotations>(found).sequences;
    ASSERT_EQ(sequences.size(), 1U);
    ASSERT_EQ(sequences[0].segments.size(), 1U);
    const auto& taken = sequences[0].segments[0].categories;
    ASSERT_EQ(taken.size(), categories + 1);
    EXPECT_EQ(taken[0], "walk");
    EXPECT_EQ(taken[1], "c0");
}

}  // namespace
}  // namespace actformer::ingest
