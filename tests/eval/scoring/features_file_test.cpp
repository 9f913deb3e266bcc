// Features files of other programs.
#include "eval/scoring/features_file.hpp"

#include <gtest/gtest.h>

#include "base/hdf5/writer.hpp"
#include "eval/metrics/confusion.hpp"
#include "tests/support/error_of.hpp"
#include "tests/support/temp_dir.hpp"

using namespace actformer;

namespace {

void write_features(const std::filesystem::path& path, std::size_t classes) {
    hdf5::Writer file(path);
    file.write<float>("features", {2, 1}, std::vector<float>{1, 2});
    file.write<std::uint32_t>("labels", {2}, std::vector<std::uint32_t>{0, 1});
    file.write<float>("logits", {2, classes}, std::vector<float>(2 * classes));
    file.finish();
}

}  // namespace

TEST(FeaturesOfOthers, HaveNoMoreClassesThanAConfusion) {
    const test::TempDir dir;
    write_features(dir / "most.h5", eval::most_confused_classes);
    EXPECT_EQ(eval::read_features(dir / "most.h5").samples.classes, eval::most_confused_classes);
    write_features(dir / "more.h5", eval::most_confused_classes + 1);
    const auto fault = test::error_of([&] { eval::read_features(dir / "more.h5"); });
    EXPECT_EQ(fault, (dir / "more.h5").string() +
                         ": 4097 classes, and scores are of up to 4096: leave out those without samples");
}
