// A dataset that says so is seen in centred windows, whoever looks at it.
#include "ingest/dataset/view.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/support/command.hpp"
#include "tests/support/temp_dir.hpp"

using namespace actformer;
using namespace actformer::test;

namespace {

/// Someone who walks 2 cm a frame for 120 frames.
std::string long_walk() {
    std::string text =
        "HIERARCHY\nROOT Hips\n{\nOFFSET 0 0 0\nCHANNELS 3 Xposition Yposition Zposition\n"
        "JOINT Head\n{\nOFFSET 0 70 0\nCHANNELS 1 Zrotation\nEnd Site\n{\nOFFSET 0 10 0\n}\n}\n}\n"
        "MOTION\nFrames: 120\nFrame Time: 0.0333333\n";
    for (int t = 0; t < 120; ++t) text += fmt::format("{} 90 0 5\n", 2 * t);
    return text;
}

/// Mean x of the root in the first of the clip's windows of 60 frames.
double first_window_mean(const std::string& options) {
    const TempDir dir;
    write_file(dir / "raw/walk_1.bvh", long_walk());
    const auto result = run_actformer("ingest bvh " + (dir / "raw").string() + " -o " +
                                      (dir / "walks").string() + " --name '{action}_{index}' " + options);
    EXPECT_EQ(result.exit, 0) << result.output;
    kernels::Device device;
    const auto view = ingest::load_view(device, ingest::Dataset(dir / "walks"), "all");
    kernels::Batch batch(view.store, 1, 60);
    kernels::WindowCutter(view.store, kernels::consecutive_windows(view.store.table().frames, 60))
        .cut(0, batch);
    double sum = 0;
    const auto seen = batch.map();
    for (std::size_t t = 0; t < 60; ++t) sum += seen.values[t * 2];
    return sum / 60;
}

}  // namespace

TEST(ViewsOnDevice, AreCentredWhereTheDatasetSaysSo) {
    // 120 frames of 2 cm about their mean, 1.19 m: the first 60 lie 0.6 m behind it on average
    EXPECT_NEAR(first_window_mean(""), -0.6, 1e-5);
    EXPECT_NEAR(first_window_mean("--centre-windows"), 0, 1e-6);
}
