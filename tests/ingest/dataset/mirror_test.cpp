// Which joint is which on the other side, by the names that tools give them.
#include "ingest/dataset/mirror.hpp"

#include <gtest/gtest.h>

#include "base/error.hpp"
#include "ingest/dataset/known_topologies.hpp"
#include "tests/support/error_of.hpp"

using namespace actformer;
using namespace actformer::ingest;

namespace {

using Others = std::vector<std::uint32_t>;

Topology two_hands(const std::string& left, const std::string& right) {
    return {{"Hips", left, right}, {-1, 0, 0}};
}

}  // namespace

TEST(Mirror, ExchangesTheSidesOfKinectsSkeleton) {
    const auto other = other_side(ntu25(), "ntu");
    const auto& names = ntu25().names;
    for (std::size_t k = 0; k < names.size(); ++k) {
        auto expected = names[k];
        if (const auto at = expected.find("left"); at != std::string::npos)
            expected.replace(at, 4, "right");
        else if (const auto at_right = expected.find("right"); at_right != std::string::npos)
            expected.replace(at_right, 5, "left");
        EXPECT_EQ(names[other[k]], expected);
        EXPECT_EQ(other[other[k]], k);
    }
}

TEST(Mirror, KnowsTheNamesThatToolsGive) {
    const std::vector<std::pair<std::string, std::string>> pairs{
        {"LeftHand", "RightHand"},  {"left_hand", "right_hand"},
        {"Hand_L", "Hand_R"},       {"lHand", "rHand"},
        {"LHipJoint", "RHipJoint"}, {"l_hand", "r_hand"},
        {"hand.L", "hand.R"},       {"mixamorig:LeftHand", "mixamorig:RightHand"}};
    for (const auto& [left, right] : pairs)
        EXPECT_EQ(other_side(two_hands(left, right), "x"), (Others{0, 2, 1})) << left;
}

TEST(Mirror, TakesNoLetterOfAWordForASide) {
    // "Lower", "Root" and "Collar" begin with or hold an l or an r.
    const Topology arms{{"Root", "Lower", "LCollar", "RCollar"}, {-1, 0, 1, 1}};
    EXPECT_EQ(other_side(arms, "x"), (Others{0, 1, 3, 2}));
}

TEST(Mirror, RefusesABodyWithoutSides) {
    using test::error_of;
    EXPECT_EQ(error_of([] { other_side(two_hands("a", "b"), "mine"); }),
              "mine: no joint's name tells left from right; leave out mirror");
    EXPECT_EQ(error_of([] { other_side(two_hands("left hand", "hook"), "mine"); }),
              "mine: joint 'left hand' has no counterpart on the other side; leave out mirror");
    const Topology askew{{"root", "left arm", "right arm", "left hand", "right hand"}, {-1, 0, 0, 1, 1}};
    EXPECT_NE(
        error_of([&] { other_side(askew, "mine"); }).find("do not hang on joints that mirror each other"),
        std::string::npos);
}
