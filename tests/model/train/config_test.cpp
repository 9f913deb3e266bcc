// Configurations: what they refuse, and in which words.
#include "model/train/config.hpp"

#include <gtest/gtest.h>

#include "base/error.hpp"
#include "model/generators/method.hpp"
#include "model/recognisers/recogniser_settings.hpp"
#include "tests/support/error_of.hpp"
#include "tests/support/paths.hpp"
#include "tests/support/temp_dir.hpp"

using namespace actformer;
using namespace actformer::model;
using namespace actformer::test;

namespace {

struct Configs : testing::Test {
    Config load(const std::string& text) {
        write_file(dir / "c.yaml", text);
        auto config = recogniser_config();
        config.load(dir / "c.yaml");
        return config;
    }
    void expect_refused(const std::string& text, const std::vector<std::string>& words) {
        try {
            load(text);
            ADD_FAILURE() << "taken: " << text;
        } catch (const Error& e) {
            for (const auto& word : words)
                EXPECT_NE(std::string(e.what()).find(word), std::string::npos) << word << ": " << e.what();
        }
    }
    TempDir dir;
};

}  // namespace

TEST_F(Configs, TakesValuesAndKeepsPresets) {
    const auto config = load(
        "model: recogniser\nbatch: 32\nrate: 0.05\nrate_drops: [3, 7]\nnesterov: no\ndata: some where\n");
    const auto settings = recogniser_settings(config);
    EXPECT_EQ(settings.batch, 32U);
    EXPECT_EQ(settings.rate, 0.05);
    EXPECT_EQ(settings.rate_drops, (std::vector<std::int64_t>{3, 7}));
    EXPECT_FALSE(settings.nesterov);
    EXPECT_EQ(settings.data, "some where");
    EXPECT_EQ(settings.epochs, 80U);
    EXPECT_EQ(settings.rate_share(2), 1);
    EXPECT_DOUBLE_EQ(settings.rate_share(3), 0.1);
    EXPECT_DOUBLE_EQ(settings.rate_share(7), 0.01);
}

TEST_F(Configs, SuggestsTheRightKey) {
    expect_refused("model: recogniser\n\nbacth: 3\n", {"c.yaml:3", "'bacth'", "did you mean 'batch'"});
    expect_refused("model: recogniser\nlearning_rate: 3\n", {"c.yaml:2", "did you mean 'rate'"});
    expect_refused("model: recogniser\nqqqqqqqqqq: 3\n", {"c.yaml:2", "the keys are", "weight_decay"});
}

TEST_F(Configs, RefusesOtherTypesAndRanges) {
    expect_refused("model: recogniser\nbatch: many\n",
                   {"c.yaml:2", "batch must be a whole number from 1", "'many'"});
    expect_refused("model: recogniser\nbatch: 0\n", {"c.yaml:2", "batch"});
    expect_refused("model: recogniser\nbatch: 1.5\n", {"c.yaml:2", "batch"});
    expect_refused("model: recogniser\nbatch: [1]\n", {"c.yaml:2", "batch", "[1]"});
    expect_refused("model: recogniser\ndropout: 1.5\n", {"dropout must be a number from 0 to 0.99"});
    expect_refused("model: recogniser\nrate: nan\n", {"rate must be a number"});
    expect_refused("model: recogniser\nnesterov: 3\n", {"true or false"});
    expect_refused("model: recogniser\nrate_drops: 10\n", {"list of whole numbers"});
    expect_refused("model: recogniser\nbatch: 99999999999999999999\n", {"batch"});
}

TEST_F(Configs, RefusesFilesLargerThanAnyConfiguration) {
    const auto file = dir / "c.yaml";
    write_file(file, "model: recogniser\n");
    EXPECT_EQ(model_named_in(file), "recogniser");
    std::filesystem::resize_file(file, (std::uintmax_t{16} << 20) + 1);
    for (const auto& said : {error_of([&] { recogniser_config().load(file); }),
                             error_of([&] { static_cast<void>(model_named_in(file)); })})
        EXPECT_NE(said.find("c.yaml: 17 MiB, and a file of this kind has at most 16 MiB"), std::string::npos)
            << said;
    EXPECT_EQ(model_named_in(dir / "none.yaml"), "");
    EXPECT_NE(error_of([&] { recogniser_config().load(dir / "none.yaml"); }).find("cannot be read"),
              std::string::npos);
}

TEST_F(Configs, RefusesWhatIsNoConfiguration) {
    expect_refused("model: recogniser\nbatch: 1\nbatch: 2\n", {"c.yaml:3", "twice"});
    expect_refused("model: recogniser\n[batch]: 1\n", {"c.yaml:2", "a key must be a text"});
    expect_refused("batch: 1\n", {"`model: recogniser` is missing"});
    expect_refused("model: generator\n", {"c.yaml:1", "generator"});
    expect_refused("model: " + std::string(100'000, 'x') + "\n", {"c.yaml:1", "xxx...'"});
    expect_refused("model: [\n", {"c.yaml", "no YAML"});
    expect_refused("- a\n- b\n", {"key: value"});
    expect_refused("", {"key: value"});
    auto config = recogniser_config();
    EXPECT_THROW(config.load(dir / "none.yaml"), Error);
}

TEST_F(Configs, OverridesFromTheCommandLine) {
    auto config = load("model: recogniser\nbatch: 32\n");
    config.override_with("batch=16");
    config.override_with("rate_drops=4,5");
    config.override_with("data=/a/b: c=d");
    EXPECT_EQ(config.get<std::int64_t>("batch"), 16);
    EXPECT_EQ(config.get<std::vector<std::int64_t>>("rate_drops"), (std::vector<std::int64_t>{4, 5}));
    EXPECT_EQ(config.get<std::string>("data"), "/a/b: c=d");
    for (const auto* wrong : {"batch", "=3", "batch=x", "btach=3", "rate_drops=[", "model=generator"})
        EXPECT_THROW(config.override_with(wrong), Error) << wrong;
    try {
        config.override_with("model=gru");
        FAIL() << "taken";
    } catch (const Error& e) {
        EXPECT_NE(std::string(e.what()).find("choose a configuration of it"), std::string::npos) << e.what();
    }
}

TEST_F(Configs, WritesWhatItReads) {
    auto config = load(
        "model: recogniser\nrate: 0.1\nweight_decay: 1e-05\ndata: \"a # \\\"b\\\": c\"\nrate_drops: []\n");
    write_file(dir / "again.yaml", config.yaml());
    auto again = recogniser_config();
    again.load(dir / "again.yaml");
    EXPECT_TRUE(config.differences(again).empty());
    again.override_with("batch=3");
    EXPECT_EQ(config.differences(again), std::vector<std::string>{"batch is 3 there and 64 here"});
    again.override_with("batch=64");
    for (const auto* free : {"data=elsewhere", "epochs=3", "device=cuda", "opencl=1", "threads=7"})
        again.override_with(free);
    EXPECT_TRUE(config.differences(again).empty());
}

TEST_F(Configs, RefuseTextThatWouldComeBackChanged) {
    for (const std::string broken :
         {"/m\xE4rz", "\xEF\xBF\xBF", "a\xFF b"}) {  // Latin-1, a code that is no character, any byte
        expect_refused("model: recogniser\ndata: " + broken + "\n",
                       {"c.yaml:2", "data must be text in UTF-8"});
        EXPECT_THROW(load("model: recogniser\n").override_with("data=" + broken), Error);
    }
    for (const std::string whole : {"/m\u00E4rz", "a\tb", "\\xE4", "\U0001F483"}) {
        auto config = load("model: recogniser\n"), again = config;
        config.override_with("data=" + whole);
        again.load_text(config.yaml(), "again.yaml");
        EXPECT_EQ(again.get<std::string>("data"), whole);
    }
}

TEST_F(Configs, NameTheKindOfRecogniser) {
    const auto kind_of = [&](const std::string& text) {
        write_file(dir / "kind.yaml", text);
        return recogniser_kind_in(dir / "kind.yaml");
    };
    EXPECT_EQ(kind_of("model: recogniser\n"), RecogniserKind::stgcn);
    EXPECT_EQ(kind_of("model: stgcn\n"), RecogniserKind::stgcn);
    EXPECT_EQ(kind_of("model: gru\n"), RecogniserKind::gru);
    EXPECT_EQ(kind_of("batch: 1\n"), RecogniserKind::stgcn) << "loading says that the line is missing";
    try {
        kind_of("model: actformer\n");
        ADD_FAILURE() << "a generator's configuration was taken";
    } catch (const Error& e) {
        EXPECT_NE(std::string(e.what()).find("kind.yaml: a configuration for model 'actformer'"),
                  std::string::npos)
            << e.what();
    }
}

TEST(ShippedConfigs, AllLoad) {
    std::size_t count = 0;
    for (const auto& entry : std::filesystem::directory_iterator(source("model/configs"))) {
        const bool recogniser = entry.path().filename().string().starts_with("recogniser");
        auto config = recogniser ? recogniser_config(recogniser_kind_in(entry.path()))
                                 : read_generator_config(entry.path());
        config.load(entry.path());
        ++count;
    }
    EXPECT_GE(count, 8U);
}

TEST(ShippedConfigs, SwitchesThatThePapersDoNotHaveAreOffInTheirRecognisers) {
    for (const std::string name :
         {"recogniser.yaml", "recogniser-ntu-1p.yaml", "recogniser-ntu-2p.yaml", "recogniser-gru.yaml"}) {
        const auto file = source("model/configs/" + name);
        auto config = recogniser_config(recogniser_kind_in(file));
        config.load(file);
        const auto settings = recogniser_settings(config);
        EXPECT_EQ(settings.noise, 0) << name;
        EXPECT_EQ(settings.mirror, 0) << name;
        EXPECT_EQ(settings.turn, 0) << name;
    }
}
