// Losses of networks that no longer learn from each other.
#include "model/generators/adversarial/collapse.hpp"

#include <gtest/gtest.h>

using namespace actformer::model;

TEST(Collapse, IsToldByItsKind) {
    const auto of = [](const GanLosses& losses, Loss loss) { return collapse_in(losses, loss); };
    for (const auto loss : {Loss::hinge, Loss::wasserstein}) EXPECT_EQ(of({1.2, 0.4, -0.3, 0.3}, loss), "");
    EXPECT_NE(of({1e-5, 4, -4, 4}, Loss::hinge).find("for certain, and its gradient has vanished"),
              std::string::npos);
    EXPECT_EQ(of({-8, 4, -4, 4}, Loss::wasserstein), "") << "its loss may be below 0";
    EXPECT_NE(of({0, 4, 4, -4}, Loss::wasserstein).find("same score"), std::string::npos);
    EXPECT_NE(of({-1e7, 1e7, 0, 0}, Loss::wasserstein).find("run away"), std::string::npos);
}
