#include <gtest/gtest.h>

#include "base/error.hpp"
#include "ingest/formats/name_pattern.hpp"

namespace actformer::ingest {
namespace {

using Values = std::vector<std::string>;

Values match(const char* pattern, const char* stem) {
    return NamePattern(pattern).match(stem).value_or(Values{});
}

TEST(NamePattern, TakesFieldsApart) {
    const NamePattern pattern("dataset-2_{action}_{style}_{index}");
    EXPECT_EQ(pattern.fields(), (Values{"action", "style", "index"}));
    EXPECT_EQ(pattern.action(), 0U);
    EXPECT_EQ(pattern.match("dataset-2_walk-turn-left_active_012"),
              (Values{"walk-turn-left", "active", "012"}));
    EXPECT_EQ(pattern.match("dataset-1_walk_active_012"), std::nullopt);
    EXPECT_EQ(pattern.match("dataset-2_walk_active"), std::nullopt);
    EXPECT_EQ(pattern.match(""), std::nullopt);
}

TEST(NamePattern, FieldsTakeTheShortestRunAndTheLastOneTheRest) {
    EXPECT_EQ(match("{subject}_{action}", "a_b_c_d"), (Values{"a", "b_c_d"}));
    EXPECT_EQ(match("{action}--{n}", "a-b---c"), (Values{"a-b", "-c"}));
    EXPECT_EQ(match("{action}_x", "a_x_x"), (Values{"a_x"}));
    EXPECT_EQ(match("{action}_{n}_x", "a_b_x_x"), (Values{"a", "b_x"}));
    EXPECT_EQ(match("{action}ab{n}", "abab1"), (Values{"ab", "1"}));
}

TEST(NamePattern, EveryFieldHoldsACharacterAtLeast) {
    EXPECT_EQ(match("{action}_{n}", "_b"), Values{});
    EXPECT_EQ(match("{action}_{n}", "a_"), Values{});
    EXPECT_EQ(match("{action}_{n}", "__b"), (Values{"_", "b"}));
    EXPECT_EQ(match("a{action}a", "aa"), Values{});
    EXPECT_EQ(match("ab{action}bc", "abc"), Values{});
    EXPECT_EQ(match("{action}", "x"), (Values{"x"}));
}

TEST(NamePattern, ForgetsWhatDoesNotMatter) {
    const NamePattern pattern("{*}_{action}_{*}");
    EXPECT_EQ(pattern.fields(), Values{"action"});
    EXPECT_EQ(pattern.match("s01_run_3_b"), Values{"run"});
}

TEST(NamePattern, IgnoresTheExtension) {
    EXPECT_EQ(NamePattern("{action}_{n}.BVH").text(), "{action}_{n}");
    EXPECT_EQ(match("{action}.bvh", "run"), Values{"run"});
}

TEST(NamePattern, SpeaksOfFolders) {
    const NamePattern pattern("{action}/{index}");
    EXPECT_EQ(pattern.match("/data/captures/walk/001"), (Values{"walk", "001"}));
    EXPECT_EQ(pattern.match("walk/001"), (Values{"walk", "001"}));
    EXPECT_EQ(pattern.match("001"), std::nullopt);
    EXPECT_EQ(match("{subject}/mocap/{*}_{action}.bvh", "/x/s1/mocap/a_run"), (Values{"s1", "run"}));
    EXPECT_EQ(match("{subject}/mocap/{*}_{action}", "/x/s1/video/a_run"), Values{});
    // No field reaches across a /, and a pattern without one sees the file's name alone.
    EXPECT_EQ(match("a{action}b/{n}", "a/xb/1"), Values{});
    EXPECT_EQ(match("{action}", "walk/001"), Values{"001"});
    EXPECT_EQ(NamePattern("{take}/{person}", false).action(), 2U);
}

TEST(NamePattern, MakesValuesPrintable) {
    EXPECT_EQ(match("{action}", "r\xFFn\n"), Values{"r\\xFFn\\x0A"});
}

TEST(NamePattern, RefusesBadPatternsShowingTheRightForm) {
    for (const char* bad :
         {"", "walk", "{style}", "{action", "action}", "{}_{action}", "{action}{style}", "{action}{*}",
          "{action}_{action}", "{action}_{a b}", "{action}_{{n}}", "{action}_{label}", "{*}", "{action}/",
          "/{action}", "{action}//{n}", "{action}/{action}"})
        try {
            const NamePattern pattern(bad);
            ADD_FAILURE() << "took " << bad;
        } catch (const Error& e) {
            EXPECT_NE(std::string(e.what()).find("{action}_{style}_{index}"), std::string::npos) << e.what();
        }
}

}  // namespace
}  // namespace actformer::ingest
