#include "ingest/dataset/split.hpp"

#include <gtest/gtest.h>

#include "base/error.hpp"
#include "ingest/formats/ntu/ntu_format.hpp"
#include "tests/support/error_of.hpp"

using namespace actformer::ingest;

TEST(Split, HoldsWhereEveryConditionHolds) {
    const auto split = parse_split("s/train=style:active,normal;index!:007");
    EXPECT_EQ(split.name, "s/train");
    const std::vector<std::string> fields{"action", "style", "index"};
    EXPECT_TRUE(split.holds(fields, {"walk", "active", "001"}));
    EXPECT_FALSE(split.holds(fields, {"walk", "active", "007"}));
    EXPECT_FALSE(split.holds(fields, {"walk", "elderly", "001"}));
    EXPECT_THROW(split.holds({"action"}, {"walk"}), actformer::Error);
}

TEST(Split, RefusesWhatIsNotOfItsForm) {
    for (const char* text : {"", "a", "=style:x", "a=", "a=style", "a=style:", "a=:x", "a=!:x"})
        EXPECT_THROW(parse_split(text), actformer::Error) << text;
}

TEST(Split, HasANameOfItsOwn) {
    const auto refusal = [](std::vector<std::string> texts) {
        return actformer::test::error_of([&] { parse_splits(texts); });
    };
    EXPECT_EQ(refusal({"train=style:a", "test=style:b"}), "");
    EXPECT_EQ(refusal({"train=style:a", "test=style:b", "train=style:c"}),
              "split 'train=style:c': there is one called train before it; give it another name");
    EXPECT_EQ(refusal({"all=style:a"}),
              "split 'all=style:a': all is what every clip is in; give it another name");
}

TEST(NtuSplits, FollowTheProtocols) {
    const std::vector<std::string> fields{"setup", "camera", "performer", "replication", "action"};
    std::map<std::string, Split> splits;
    for (const auto& split : ntu_splits()) splits[split.name] = split;
    const auto holds = [&](const std::string& name, const std::vector<std::string>& clip) {
        return splits.at(name).holds(fields, clip);
    };
    int train = 0;
    for (int performer = 1; performer <= 106; ++performer)
        train += holds("xsub/train", {"1", "1", std::to_string(performer), "1", "1"});
    EXPECT_EQ(train, 53) << "NTU RGB+D 120 trains on 53 of its 106 performers";
    EXPECT_TRUE(holds("xsub/train", {"1", "1", "103", "1", "1"}));
    EXPECT_TRUE(holds("xsub/test", {"1", "1", "3", "1", "1"}));
    EXPECT_TRUE(holds("xview/train", {"1", "3", "3", "1", "60"}));
    EXPECT_TRUE(holds("xview/test", {"1", "1", "3", "1", "60"}));
    for (const auto* part : {"xview/train", "xview/test"})
        EXPECT_FALSE(holds(part, {"1", "2", "3", "1", "61"}));
    EXPECT_TRUE(holds("xset/train", {"32", "1", "3", "1", "1"}));
    EXPECT_TRUE(holds("xset/test", {"31", "1", "3", "1", "1"}));
}
