// What a sweep reads of the configurations that it names.
#include "reports/sweep/configuration.hpp"

#include <gtest/gtest.h>

#include "tests/support/temp_dir.hpp"

namespace actformer::reports {
namespace {

TEST(InConfiguration, TakesNothingOfAFileLargerThanAnyConfiguration) {
    const test::TempDir dir;
    const auto file = dir / "c.yaml";
    const std::string text = "epochs: 7\n";
    test::write_file(file, text);
    EXPECT_EQ(in_configuration(file, "epochs", 0), 7);
    EXPECT_EQ(in_configuration(dir / "none.yaml", "epochs", 0), 0);
    test::write_file(file, text + std::string(largest_yaml, '\n'));
    EXPECT_EQ(in_configuration(file, "epochs", 0), 0);
}

TEST(InConfiguration, TakesAKeyWithoutAValueAsATrainingDoes) {
    const test::TempDir dir;
    const auto file = dir / "c.yaml";
    test::write_file(file, "test_split:\nepochs: ~\n");
    EXPECT_EQ(text_in({}, file, "test_split", "all"), "");
    EXPECT_EQ(text_in({}, file, "train_split", "all"), "all");
    EXPECT_EQ(in_configuration(file, "epochs", 7), 7);
}

}  // namespace
}  // namespace actformer::reports
