// What every method of generating motions must do, whatever it is inside.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>

#include "base/error.hpp"
#include "ingest/dataset/dataset.hpp"
#include "model/generators/generator_file.hpp"
#include "model/generators/train_generator.hpp"
#include "tests/support/checkpoints.hpp"
#include "tests/support/error_of.hpp"
#include "tests/support/paths.hpp"
#include "tests/support/temp_dir.hpp"
#include "tests/support/toy_dataset.hpp"

using namespace actformer;
using namespace actformer::test;
using namespace actformer::model;

namespace {

/// Of an epoch on toy().
Config small_config(const std::string& method) {
    auto config = generator_config(method_named(method, "test"));
    for (const auto* key : {"frames=16", "batch=4", "epochs=1", "threads=1", "seed=3", "train_split=s/train"})
        config.override_with(key);
    config.override_with("data=" + toy().string());
    for (const auto& [key, value] :
         std::map<std::string, std::string>{{"width", "32"},
                                            {"hidden", "48"},
                                            {"layers", "2"},
                                            {"spread", "0.5"},
                                            {"average", "0.9"}})  // where it has them
        if (config.has(key)) config.override_with(key + "=" + value);
    return config;
}

struct EveryMethod : testing::TestWithParam<std::string> {
    Config config() const { return small_config(GetParam()); }
    TempDir dir;
};

std::vector<std::string> names() {
    std::vector<std::string> all;
    for (const auto& method : methods()) all.push_back(method.name);
    return all;
}

}  // namespace

TEST_P(EveryMethod, TrainsAndGeneratesOutOfItsFileAlone) {
    Measures losses;
    TrainingEvents events;
    events.epoch = [&](const EpochReport& report) { losses = report.losses; };
    const auto result = train_generator(config(), dir / "run", false, events);
    EXPECT_GT(result.steps, 0U);
    ASSERT_FALSE(losses.empty());
    EXPECT_TRUE(std::ranges::all_of(losses, [](const Measure& loss) { return std::isfinite(loss.value); }));

    const auto file = load_generator(dir / "run");
    EXPECT_EQ(file.method().name, GetParam());
    EXPECT_EQ(file.subjects, ingest::subjects_of(ingest::Dataset(toy())));
    const auto maker = file.maker("cpu");
    EXPECT_GE(maker->most_frames(), 16U);
    const auto motions = maker->make(7, 1, 0, 12);
    ASSERT_EQ(motions.size(), maker->batch() * 3U * 12U * file.subjects.topology.joints());
    EXPECT_TRUE(std::ranges::all_of(motions, [](float v) { return std::isfinite(v); }));
    EXPECT_NE(motions, maker->make(7, 1, 1, 12));
    EXPECT_NE(motions, maker->make(8, 1, 0, 12));
    EXPECT_EQ(motions, maker->make(7, 1, 0, 12));
    EXPECT_EQ(motions, file.maker("cpu")->make(7, 1, 0, 12));
}

TEST_P(EveryMethod, GoesOnToTheBitsOfAnUndisturbedTraining) {
    const auto train = [&](const char* run, const char* epochs) {
        auto config = this->config();
        config.override_with(epochs);
        train_generator(config, dir / run, false, {});
    };
    train("whole", "epochs=2");
    train("parts", "epochs=1");
    train("parts", "epochs=2");
    const auto last = newest(dir / "whole");
    ASSERT_EQ(newest(dir / "parts"), last);
    expect_same_checkpoint(dir / "whole" / last, dir / "parts" / last);
}

TEST_P(EveryMethod, SaysWhatItsNetworksAre) {
    const MotionSpec spec{ingest::Representation::limb, ingest::ntu25(), 1, 94, "ntu"};
    for (const auto& network : method_named(GetParam(), "test").networks(config(), spec)) {
        EXPECT_FALSE(network.lines.empty()) << network.name;
        EXPECT_GT(std::accumulate(network.lines.begin(), network.lines.end(), std::int64_t{0},
                                  [](std::int64_t sum, const auto& line) { return sum + line.parameters; }),
                  0)
            << network.name;
    }
}

TEST_P(EveryMethod, RefusesWeightsOfOtherSettings) {
    const auto result = train_generator(config(), dir / "run", false, {});
    auto file = load_generator(result.weights);
    file.subjects.classes.emplace_back("one more");
    EXPECT_THROW(file.maker("cpu"), Error);
    file.weights.clear();
    EXPECT_THROW(file.maker("cpu"), Error);
}

/// Before the network is made, which would be as large as the configuration says.
TEST_P(EveryMethod, MakesNoNetworkOfAnotherConfiguration) {
    auto wide = config();
    for (const auto* key : {"width", "hidden"})
        if (wide.has(key)) wide.override_with(std::string(key) + "=256");
    const auto subjects = ingest::subjects_of(ingest::Dataset(toy()));
    const std::vector<float> numbers{1};
    save_generator(dir / "w.h5", {{"input.weight", {1}, numbers}, {"up0.weight", {1}, numbers}}, wide,
                   subjects, {});
    const auto fault = error_of([&] { load_generator(dir / "w.h5").maker("cpu"); });
    EXPECT_TRUE(fault.starts_with((dir / "w.h5").string() + ": ")) << fault;
    EXPECT_TRUE(fault.ends_with(": damaged, or of another configuration")) << fault;
}

INSTANTIATE_TEST_SUITE_P(Generators, EveryMethod, testing::ValuesIn(names()),
                         [](const auto& one) { return one.param; });

TEST(Methods, AreCalledByName) {
    EXPECT_EQ(method_named("", "c.yaml").name, "actformer") << "a configuration without the line `model:`";
    EXPECT_EQ(method_named("generator", "c.yaml").name, "actformer") << "its name before there were others";
    try {
        method_named("actfromer", "c.yaml");
        ADD_FAILURE() << "taken";
    } catch (const Error& e) {
        EXPECT_STREQ(e.what(), "c.yaml: there is no method 'actfromer'; did you mean 'actformer'?");
    }
}

TEST(Methods, MakeMotionsOfFewPersons) {
    const TempDir dir;
    auto subjects = ingest::subjects_of(ingest::Dataset(toy()));
    subjects.persons = 101;
    subjects.bone_length.clear();
    save_generator(dir / "w.h5", {{"input.weight", {1}, std::vector<float>{1}}},
                   generator_config(methods().front()), subjects, {});
    EXPECT_EQ(error_of([&] { load_generator(dir / "w.h5"); }),
              (dir / "w.h5").string() + ": motions of 101 persons, and generators make up to 100: damaged");
}

TEST(Methods, HoldTheLastFrameOfShortClipsWhereThatIsAskedFor) {
    const TempDir dir;
    std::vector<std::string> asked;
    for (const auto& name : names()) {
        if (!small_config(name).has("padding")) continue;
        asked.push_back(name);
        const auto first_loss = [&](const std::string& padding) {
            auto config = small_config(name);
            config.override_with("frames=48");  // the clips have 40
            config.override_with("padding=" + padding);
            double loss = 0;
            TrainingEvents events;
            events.epoch = [&](const EpochReport& report) { loss = report.losses.at(0).value; };
            train_generator(config, dir / (name + padding), false, events);
            return loss;
        };
        EXPECT_NE(first_loss("hold"), first_loss("back-and-forth")) << name;
    }
    std::ranges::sort(asked);
    EXPECT_EQ(asked, (std::vector<std::string>{"action2motion", "actor"}));
}

TEST(Methods, AreNoRecognisers) {
    const auto file = source("model/configs/recogniser-gru.yaml");
    try {
        read_generator_config(file);
        ADD_FAILURE() << "taken";
    } catch (const Error& e) {
        EXPECT_EQ(e.what(), file +
                                ": a recogniser's configuration, as `model: gru` says; `actformer train "
                                "recogniser` takes it");
    }
}

TEST(Methods, ReadConfigurationsOfTheFirstVersion) {
    const TempDir dir;
    write_file(dir / "old.yaml", "model: generator\nwidth: 64\n");
    write_file(dir / "bare.yaml", "width: 32\n");
    EXPECT_EQ(read_generator_config(dir / "old.yaml").get<std::int64_t>("width"), 64);
    EXPECT_EQ(read_generator_config(dir / "bare.yaml").get<std::int64_t>("width"), 32);
    EXPECT_NE(read_generator_config(dir / "old.yaml").yaml().find("model: actformer\n"), std::string::npos);
}
