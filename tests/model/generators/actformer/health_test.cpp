// When a game of two networks is beyond hope.
#include "model/generators/actformer/health.hpp"

#include <gtest/gtest.h>

#include <limits>

using namespace actformer::model;

TEST(Health, OfAFairGame) {
    for (const auto loss : {Loss::hinge, Loss::wasserstein}) {
        Health health(loss);
        for (int i = 0; i < 1000; ++i) health.see({1.2, 0.4, -0.3, 0.3}, 10);
        EXPECT_TRUE(health.sound());
        EXPECT_EQ(health.verdict(), "");
    }
}

TEST(Health, NumbersThatAreNoneEndItAtOnce) {
    Health health(Loss::hinge);
    health.see({1, 0.4, -0.3, std::numeric_limits<double>::quiet_NaN()}, 1);
    EXPECT_FALSE(health.sound());
    EXPECT_NE(health.verdict().find("no numbers"), std::string::npos);
    health.see({1, 0.4, -0.3, 0.3}, 1);
    EXPECT_NE(health.verdict(), "");
}

TEST(Health, ACollapseNeedsPatience) {
    const Losses certain{1e-5, 4, -4, 4}, fair{1, 0.4, -0.3, 0.3};
    Health health(Loss::hinge);
    health.see(certain, Health::patience - 1);
    EXPECT_FALSE(health.sound());  // nothing to keep
    EXPECT_EQ(health.verdict(), "");
    health.see(fair, 1);
    EXPECT_TRUE(health.sound());
    health.see(certain, Health::patience);
    EXPECT_NE(health.verdict().find("for certain"), std::string::npos);

    Health critic(Loss::wasserstein);  // whose loss is free to be below 0
    critic.see({-8, 4, -4, 4}, Health::patience);
    EXPECT_TRUE(critic.sound());
    critic.see({0, 4, 4, -4}, Health::patience);
    EXPECT_NE(critic.verdict().find("same score"), std::string::npos);
    Health wild(Loss::wasserstein);
    wild.see({-1e7, 1e7, 0, 0}, Health::patience);
    EXPECT_NE(wild.verdict().find("run away"), std::string::npos);
}
