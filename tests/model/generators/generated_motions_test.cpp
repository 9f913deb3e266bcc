// `actformer score --generator`: motions go to the recogniser without a file between, and are those of `generate`.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "eval/stgcn/weights.hpp"
#include "ingest/dataset/dataset.hpp"
#include "tests/support/toy_dataset.hpp"

using namespace actformer;
using namespace actformer::test;
namespace fs = std::filesystem;

namespace {

constexpr const char* tiny =
    "model: actformer\nframes: 16\nwidth: 16\nheads: 2\ndepth: 1\nlatent: 8\nd_width: 2\nbatch: 6\nepochs: "
    "1\ntrain_split: s/train\nseed: 4\nthreads: 1\n";

struct ScoreGenerator : testing::Test {
    void SetUp() override {
        ::setenv("XDG_CACHE_HOME", at("cache").c_str(), 1);
        write_file(dir / "toy.yaml", tiny);
        const auto trained = run_actformer("train generator -c " + at("toy.yaml") + " --data " +
                                           toy().string() + " -o " + at("run"));
        ASSERT_EQ(trained.exit, 0) << trained.output;
        const auto graph = eval::recogniser_graph(ingest::Dataset(toy()).header().topology.parents);
        eval::write_stgcn_weights(dir / "w.h5", eval::random_stgcn_weights(3, 3, graph, 0.125, 5));
    }
    void TearDown() override { ::unsetenv("XDG_CACHE_HOME"); }
    std::string at(const std::string& name) const { return (dir / name).string(); }
    std::string words(const std::string& more) const {
        return "score --recogniser " + at("w.h5") + " --real " + toy().string() + " --window 16 " + more;
    }
    CommandResult score(const std::string& more) const { return run_actformer(words(more)); }
    nlohmann::json scored(const std::string& more) const {
        const auto result = score(more + " --json");
        EXPECT_EQ(result.exit, 0) << result.output;
        return nlohmann::json::parse(result.output, nullptr, false);
    }
    std::string generator(const std::string& more) const {
        return "--generator " + at("run") + " --per-class 27 --seed 5 " + more;
    }

    TempDir dir;
};

}  // namespace

TEST_F(ScoreGenerator, IsTheScoreOfGeneratedFiles) {
    std::string files;
    for (unsigned seed = 5; seed < 7; ++seed) {
        const auto file = at(fmt::format("m{}.h5", seed));
        ASSERT_EQ(run_actformer(fmt::format("generate --generator {} -o {} --per-class 27 --seed {}",
                                            at("run"), file, seed))
                      .exit,
                  0);
        files += " " + file;
    }
    for (const std::string frames : {"", " --frames 12"}) {
        const auto here = scored(generator("--repeats 2" + frames));
        const auto there = scored("--seed 5 --generated" + files + frames);
        for (const auto* key : {"accuracy", "fid_mean", "fid_whole", "diversity", "multimodality",
                                "confusion", "per_class", "floor"})
            EXPECT_EQ(here[key], there[key]) << key << frames;
        EXPECT_EQ(here["provenance"]["generated"][1]["seed"], 6);
    }
    EXPECT_EQ(scored(generator("--repeats 1"))["fid_whole"]["repeats"][0],
              scored("--generator " + at("run/weights-last.h5") +
                     " --per-class 27 --seed 5")["fid_whole"]["repeats"][0])
        << "weights in place of their folder";
}

/// ACTOR can make motions of thousands of frames, and one that is asked for more begins otherwise.
TEST_F(ScoreGenerator, MakesMotionsAsLongAsGenerateDoes) {
    write_file(dir / "actor.yaml",
               "model: actor\nframes: 16\nwidth: 16\nheads: 2\nlayers: 1\nhidden: 16\nbatch: 6\nepochs: 1\n"
               "train_split: s/train\nseed: 4\nthreads: 1\n");
    ASSERT_EQ(run_actformer("train generator -c " + at("actor.yaml") + " --data " + toy().string() + " -o " +
                            at("actor"))
                  .exit,
              0);
    ASSERT_EQ(
        run_actformer("generate --generator " + at("actor") + " -o " + at("m.h5") + " --per-class 9 --seed 5")
            .exit,
        0);
    const auto here = scored("--generator " + at("actor") + " --per-class 9 --seed 5 --repeats 1");
    const auto there = scored("--seed 5 --generated " + at("m.h5"));
    for (const auto* key : {"fid_mean", "diversity", "confusion"}) EXPECT_EQ(here[key], there[key]) << key;
}

TEST_F(ScoreGenerator, MakesTheClassesOfTheSplitOnly) {
    const auto json = scored(generator("--split s/two"));
    EXPECT_EQ(json["per_class"][1]["generated"], 27);
    EXPECT_EQ(json["per_class"][2]["generated"], 0);
}

TEST_F(ScoreGenerator, MeasuresTheMotionsThemselves) {
    const auto json = scored(generator("--repeats 2"));
    // An untrained generator jitters: its frames know little of one another.
    EXPECT_GT(json["limb_acceleration"]["mean"], 1.5);
    EXPECT_EQ(json["real"]["limb_acceleration"], 1);
    EXPECT_NEAR(json["floor"]["limb_acceleration"].get<double>(), 1, 0.5) << "real against real";
    EXPECT_TRUE(json["per_class"][2]["limb_acceleration"].is_number());
    EXPECT_FALSE(json.contains("root_speed")) << "real roots of toy motions stand";
    EXPECT_FALSE(json.contains("foot_sliding")) << "no joint of toy motions is called a foot";
    EXPECT_FALSE(json.contains("root_distance")) << "one person";
    const auto file = at("m.h5");
    ASSERT_EQ(
        run_actformer("generate --generator " + at("run") + " -o " + file + " --per-class 27 --seed 5").exit,
        0);
    EXPECT_EQ(scored("--seed 5 --generated " + file)["limb_acceleration"]["repeats"][0],
              json["limb_acceleration"]["repeats"][0]);
}

TEST_F(ScoreGenerator, MeasuresAsActorDoes) {
    const auto of_generator = "--generator " + at("run") + " --protocol actor ";
    const auto json = scored(of_generator + "--split s/train --seed 3");
    EXPECT_EQ(json["protocol"], "actor");
    const auto& accuracy = json["accuracy"];
    ASSERT_EQ(accuracy["repeats"].size(), 20U) << "seeds";
    const auto windows = json["per_class"][1]["real"].get<int>();
    EXPECT_GT(windows, 12) << "more than clips";
    EXPECT_EQ(json["per_class"][1]["generated"], windows) << "a motion for each";
    double right = 0, squares = 0, all = 0;
    for (std::size_t t = 0; t < 3; ++t)
        for (std::size_t g = 0; g < 3; ++g) {
            all += json["confusion"][t][g].get<double>();
            if (t == g) right += json["confusion"][t][g].get<double>();
        }
    EXPECT_EQ(all, 20 * 3 * windows);
    const double mean = accuracy["mean"];
    EXPECT_NEAR(mean, right / all, 1e-12);
    for (const double value : accuracy["repeats"]) squares += (value - mean) * (value - mean);
    EXPECT_NEAR(accuracy["ci95"], 1.96 * std::sqrt(squares / 19 / 20), 1e-12);

    // Fewer motions than windows: classes as the windows drawn have them.
    const auto some = scored(of_generator + "--repeats 2 --samples 16 --kid --fid-infinity");
    int made = 0;
    for (const auto& one : some["per_class"]) made += one["generated"].get<int>();
    EXPECT_EQ(made, 16);
    EXPECT_EQ(some["accuracy"]["repeats"].size(), 2U);
    for (const auto* metric : {"kid_mean", "kid_whole", "fid_whole_infinity"}) {
        EXPECT_TRUE(some[metric]["mean"].is_number()) << metric;
        EXPECT_FALSE(json.contains(metric)) << metric << " was not asked for";
    }
}

TEST_F(ScoreGenerator, GoesOnWhereItWasInterrupted) {
    const auto arguments = generator("--repeats 2 -o " + at("s.json"));
    // The scores cannot be written: all is done but that. Their file and its lock are opened and closed before the work, to see
    // whether it can be made.
    EXPECT_EQ(run_command("FAIL_BELOW=" + at("s.json.partial") + " FAIL_AT=4 LD_PRELOAD=" + failing_calls() +
                          " " + program() + " " + words(arguments))
                  .exit,
              1);
    std::vector<fs::path> kept;
    for (const auto& entry : fs::directory_iterator(at("s.json.work")))
        if (entry.path().extension() == ".h5") kept.push_back(entry.path());
    ASSERT_EQ(kept.size(), 2U) << "features, and no motions";
    fs::copy_file(kept[0], kept[1], fs::copy_options::overwrite_existing);  // tells whether they are used
    ASSERT_EQ(score(arguments).exit, 0);
    const auto json = nlohmann::json::parse(read_file(at("s.json")));
    EXPECT_EQ(json["fid_whole"]["repeats"][0], json["fid_whole"]["repeats"][1]);
    EXPECT_FALSE(fs::exists(at("s.json.work")));
    const auto both = scored(generator("--repeats 2"))["fid_whole"]["repeats"];
    EXPECT_NE(both[0], both[1]) << "or the seeds would be alike anyway";
}

TEST_F(ScoreGenerator, RefusesWhatDoesNotFit) {
    const auto refused = [&](const std::string& more, const std::vector<std::string>& words) {
        const auto result = score(more + " -o " + at("refused.json"));
        EXPECT_EQ(result.exit, 1) << result.output;
        EXPECT_EQ(lines_in(result.output), 1) << result.output;
        for (const auto& word : words)
            EXPECT_NE(result.output.find(word), std::string::npos) << word << ": " << result.output;
        EXPECT_FALSE(fs::exists(at("refused.json")));
    };
    refused("--generator " + at("nowhere"), {"nowhere"});
    fs::create_directory(dir / "empty");
    refused("--generator " + at("empty"), {"empty", "weights-"});
    refused("--generator=" + at("w.h5"), {"w.h5", "generator"});
    refused(generator("--protocol actor"), {"--per-class", "leave it out"});
    refused(generator("--samples 9"), {"--samples", "--protocol actor"});
    refused(generator("--frames 17"), {"run", "17", "16"});
    refused(generator("--generate-on nonsense"), {"nonsense"});
    refused(generator("--generate-on meta"), {"libtorch: "});  // a device of libtorch's that has no numbers
    refused("--generator " + at("run") + " --generated " + at("m.h5"), {"either"});
    const auto graph = eval::recogniser_graph(ingest::Dataset(toy()).header().topology.parents);
    eval::write_stgcn_weights(dir / "w.h5", eval::random_stgcn_weights(6, 3, graph, 0.125, 5));
    refused(generator(""), {"w.h5", "channels"});
    const auto recogniser_for_generator =
        run_actformer("features --recogniser " + at("run") + " " + toy().string() + " -o " + at("f.h5"));
    EXPECT_NE(recogniser_for_generator.output.find("generator"), std::string::npos)
        << recogniser_for_generator.output;
}
