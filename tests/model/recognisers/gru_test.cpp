// `train recogniser` with `model: gru` as its users meet it, on toy motions.
#include <gtest/gtest.h>

#include <filesystem>
#include <nlohmann/json.hpp>

#include "base/hdf5/reader.hpp"
#include "tests/support/checkpoints.hpp"
#include "tests/support/made_dataset.hpp"
#include "tests/support/run_log.hpp"
#include "tests/support/toy_dataset.hpp"

using namespace actformer;
using namespace actformer::test;
namespace fs = std::filesystem;

namespace {

struct TrainGru : testing::Test {
    void SetUp() override {
        write_file(dir / "gru.yaml",
                   "model: gru\nframes: 32\nbatch: 12\nepochs: 3\ntrain_split: s/train\ntest_split: "
                   "s/test\nseed: 4\n"
                   "threads: 1\ncheckpoint_minutes: 0\n");
    }
    CommandResult train(const std::string& run, const std::string& more, const fs::path& data = toy()) const {
        return run_actformer("train recogniser -c " + (dir / "gru.yaml").string() + " --data " +
                             data.string() + " -o " + (dir / run).string() + " " + more);
    }
    TempDir dir;
};

}  // namespace

TEST_F(TrainGru, LearnsToyClassesAndGivesFeatures) {
    const auto result = train("run", "epochs=60 rate=0.004 --json 2>/dev/null");
    ASSERT_EQ(result.exit, 0) << result.output;
    const auto log = log_of(dir / "run");
    EXPECT_LT(log.back().at("loss").get<double>(), 0.3 * log.front().at("loss").get<double>());
    EXPECT_GE(nlohmann::json::parse(result.output).at("best_class_accuracy").get<double>(), 0.9);
    const auto features =
        run_actformer("features --recogniser " + (dir / "run").string() + " " + toy().string() +
                      " --split s/test --window 32 --json -o " + (dir / "f.h5").string());
    ASSERT_EQ(features.exit, 0) << features.output;
    const auto seen = nlohmann::json::parse(features.output);
    EXPECT_EQ(seen.at("features"), 30);
    // The device sees what training saw: the accuracy is the one that training found.
    EXPECT_NEAR(seen.at("accuracy").get<double>(),
                nlohmann::json::parse(result.output).at("best_class_accuracy"), 1e-6);
    const auto noisy =
        run_actformer("features --recogniser " + (dir / "run").string() + " " + toy().string() +
                      " --split s/test --window 32 --initial-noise 1 -o " + (dir / "n.h5").string());
    ASSERT_EQ(noisy.exit, 0) << noisy.output;
    EXPECT_NE(hdf5::Reader(dir / "f.h5").read<float>("features"),
              hdf5::Reader(dir / "n.h5").read<float>("features"));
}

TEST_F(TrainGru, GoesOnToTheSameBits) {
    for (const ingest::Representation how : {ingest::Representation::xyz, ingest::Representation::rot6d}) {
        const auto& data = arms_in(how);
        const auto whole = how.name() + "-whole", parts = how.name() + "-parts";
        ASSERT_EQ(train(whole, "epochs=2", data).exit, 0);
        ASSERT_EQ(train(parts, "epochs=1", data).exit, 0);
        ASSERT_EQ(train(parts, "epochs=2", data).exit, 0);
        const auto last = newest(dir / whole);
        ASSERT_EQ(newest(dir / parts), last);
        expect_same_checkpoint(dir / whole / last, dir / parts / last);
    }
    expect_refused(train("toy", "width=1"), {"width"});
    expect_refused(train("toy", "classes=7"), {"classes: 7"});
}

TEST_F(TrainGru, SaysWhatItIs) {
    const auto model = run_actformer("model " + (dir / "gru.yaml").string() + " --data " + toy().string());
    ASSERT_EQ(model.exit, 0) << model.output;
    EXPECT_NE(model.output.find("linear1"), std::string::npos) << model.output;
}
