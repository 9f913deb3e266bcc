// Classes by name or by number, and what is said of others.
#include "ingest/dataset/classes.hpp"

#include <gtest/gtest.h>

#include "base/error.hpp"

namespace actformer::ingest {
namespace {

const std::vector<std::string> classes{"drink water", "shaking hands", "Walk", "walk", "2"};

TEST(Classes, AreCalledByNameOrCountedFromOne) {
    for (const auto* said : {"2", "shaking hands", "Shaking Hands"})
        EXPECT_EQ(label_called(said, classes, "x"), said == std::string("2") ? 4U : 1U) << said;
    EXPECT_EQ(label_called("1", classes, "x"), 0U);
    EXPECT_EQ(label_called("5", classes, "x"), 4U);
    EXPECT_EQ(label_called("A005", classes, "x"), 4U);
    EXPECT_EQ(label_called("a3", classes, "x"), 2U);
    EXPECT_EQ(label_called("walk", classes, "x"), 3U) << "as it is written comes first";
    EXPECT_EQ(label_called("WALK", classes, "x"), 2U);
    EXPECT_EQ(label_called("120", {}, "x"), 119U);
    EXPECT_EQ(label_called(" Shaking hands ", classes, "x"), 1U) << "behind a comma and a blank";
    EXPECT_EQ(label_called(" 1", classes, "x"), 0U);
    EXPECT_EQ(label_called(" go", {"go", " go"}, "x"), 1U) << "as it is written comes first";
}

std::string refusal(const std::string& said, const std::vector<std::string>& all = classes) {
    try {
        label_called(said, all, "ntu-2p");
    } catch (const Error& e) {
        return e.what();
    }
    return "taken";
}

TEST(Classes, OthersAreRefusedWithWhatWasMeant) {
    EXPECT_EQ(refusal("shakin hands"),
              "ntu-2p: there is no class 'shakin hands'; did you mean 'shaking hands'?");
    EXPECT_EQ(refusal(" Shakin hands"),
              "ntu-2p: there is no class 'Shakin hands'; did you mean 'shaking hands'?");
    EXPECT_EQ(refusal("hands"), "ntu-2p: there is no class 'hands'; did you mean 'shaking hands'?");
    for (const auto* said : {"0", "6", "A006", "A000"})
        EXPECT_NE(refusal(said).find("numbered from 1 to 5 ('drink water' .. '2')"), std::string::npos)
            << refusal(said);
    for (const auto* said : {"", "A", "-1", "1.5", "99999999999", "xyzzy\n"}) {
        EXPECT_NE(refusal(said).find("there is no class"), std::string::npos) << said;
        EXPECT_EQ(refusal(said).find('\n'), std::string::npos) << said;
    }
    EXPECT_NE(refusal("walk", {}).find("only numbers from 1 on"), std::string::npos);
    EXPECT_NE(refusal("0", {}).find("only numbers from 1 on"), std::string::npos);
}

}  // namespace
}  // namespace actformer::ingest
