#include "eval/metrics/samples.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "base/error.hpp"
#include "tests/support/made_samples.hpp"

using namespace actformer;
using eval::Samples;
using test::made_samples;

TEST(Samples, AreChecked) {
    const auto says = [](const Samples& s) {
        try {
            check(s, "file.h5");
        } catch (const Error& e) {
            return std::string(e.what());
        }
        return std::string();
    };
    auto s = made_samples({3, 3}, 4, 1);
    EXPECT_EQ(says(s), "");
    s.features[9] = std::nan("");
    EXPECT_NE(says(s).find("file.h5: feature 1 of sample 2 is not finite"), std::string::npos) << says(s);
    s = made_samples({3, 3}, 4, 1);
    s.logits[3] = INFINITY;
    EXPECT_NE(says(s).find("logit 1 of sample 1"), std::string::npos) << says(s);
    s = made_samples({3, 3}, 4, 1);
    s.labels[5] = 2;
    EXPECT_NE(says(s).find("label 2"), std::string::npos) << says(s);
    s.labels.pop_back();
    EXPECT_NE(says(s).find("do not go with"), std::string::npos) << says(s);
    EXPECT_NE(says(Samples{}).find("no samples"), std::string::npos);
}
