// When a training is beyond hope.
#include "model/train/divergence.hpp"

#include <gtest/gtest.h>

#include <limits>

using namespace actformer::model;

namespace {

const Measures fair{{"loss", "loss", 1.2}, {"score", "score", -0.3}};

}  // namespace

TEST(Divergence, IsNotSeenInATrainingThatGoesWell) {
    DivergenceWatch watch;
    for (int i = 0; i < 1000; ++i) watch.see(fair, "", 10);
    EXPECT_TRUE(watch.sound());
    EXPECT_EQ(watch.verdict(), "");
}

TEST(Divergence, LossesThatAreNotFiniteEndItAtOnce) {
    DivergenceWatch watch;
    watch.see({fair[0], {"score", "score", std::numeric_limits<double>::quiet_NaN()}}, "", 1);
    EXPECT_FALSE(watch.sound());
    EXPECT_NE(watch.verdict().find("NaN or infinite"), std::string::npos);
    watch.see(fair, "", 1);
    EXPECT_NE(watch.verdict(), "");
}

TEST(Divergence, TroubleNeedsPatience) {
    DivergenceWatch watch;
    watch.see(fair, "it is certain", DivergenceWatch::patience - 1);
    EXPECT_FALSE(watch.sound());  // nothing to keep
    EXPECT_EQ(watch.verdict(), "");
    watch.see(fair, "", 1);
    EXPECT_TRUE(watch.sound());
    watch.see(fair, "it is certain", 1);
    watch.see(fair, "it is certain", DivergenceWatch::patience - 1);
    EXPECT_EQ(watch.verdict(), "for 200 steps it is certain");
}
