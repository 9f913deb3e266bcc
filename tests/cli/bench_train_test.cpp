// `actformer bench train` at a size that takes no time. How fast it is stands in no test.
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>

#include "tests/support/command.hpp"
#include "tests/support/temp_dir.hpp"

using namespace actformer::test;

namespace {

bool has_training() {
    return std::filesystem::exists(std::filesystem::path(program()).parent_path() / "actformer-train");
}

}  // namespace

TEST(BenchTrain, TellsWhereTheTimeGoes) {
    if (!has_training()) GTEST_SKIP() << "this build has no libtorch";
    const auto result = run_actformer(
        "bench train --persons 2 --classes 3 --frames 16 --batch 2 --threads 1 --rounds 1 --json "
        "2>/dev/null");
    ASSERT_EQ(result.exit, 0) << result.output;
    const auto json = nlohmann::json::parse(result.output, nullptr, false);
    for (const auto* step : {"discriminator step", "generator step"}) {
        const double seconds = json[step]["seconds"];
        double layers = 0;
        for (const auto& layer : json[step]["milliseconds"])
            layers += layer["forward"].get<double>() + layer["backward"].get<double>();
        EXPECT_GT(layers, 0) << step;
        EXPECT_LE(layers, 1e3 * seconds) << step << ": layers run one after another on the step's own thread";
    }
    EXPECT_TRUE(json["generator step"]["milliseconds"].contains("attention over persons"));
    EXPECT_FALSE(json["generator step"].contains("ratio")) << "no peer was asked";
    double layers = 0;
    const auto& motions = json["9,400 motions"];
    EXPECT_TRUE(motions["milliseconds"].contains("attention over frames"));
    for (const auto& layer : motions["milliseconds"]) layers += layer["forward"].get<double>();
    EXPECT_GT(layers, 1e3 * motions["seconds"].get<double>() / 94) << "of as many motions as the seconds";
}

TEST(BenchTrain, TimesAMethodWithSettingsOfItsOwn) {
    if (!has_training()) GTEST_SKIP() << "this build has no libtorch";
    for (const std::string method :
         {"actformer width=16 heads=2 latent=4 d_width=2 d_joints=8", "csgn width=8 d_width=2"}) {
        const auto result = run_actformer(
            "bench train --persons 1 --classes 3 --frames 16 --batch 2 --threads 1 --rounds 1 --json "
            "--method " +
            method + " 2>/dev/null");
        ASSERT_EQ(result.exit, 0) << method << ": " << result.output;
        const auto json = nlohmann::json::parse(result.output, nullptr, false);
        EXPECT_GT(json["step"]["seconds"].get<double>(), 0) << method;
        EXPECT_GT(json["step, processors"]["seconds"].get<double>(), 0) << method;
        EXPECT_TRUE(json["step"].contains("milliseconds")) << method << ": its layers";
        EXPECT_FALSE(json.contains("discriminator step")) << method << ": the step is timed whole";
        EXPECT_GT(json["100 motions"]["seconds"].get<double>(), 0) << method;
    }
}

TEST(BenchTrain, ComparesWithWhatThePeerPrintsLast) {
    if (!has_training()) GTEST_SKIP() << "this build has no libtorch";
    const TempDir folder;
    const auto bench = [&](const std::string& peer, const std::string& more) {
        std::ofstream(folder.path() / "actformer_speed.py") << peer;
        const auto path = folder.path().string();
        return run_actformer(
            "bench train --persons 1 --classes 3 --frames 16 --batch 8 --threads 1 --rounds 1 "
            "--python /bin/sh --json --peers " +
            path + " " + more + " 2>/dev/null");
    };
    const auto phases = bench(
        "test \"$*\" = '--persons 1 --classes 3 --frames 16 --batch 8 --repeats 1' && echo 1000 2000 3000\n",
        "");
    ASSERT_EQ(phases.exit, 0) << phases.output;
    auto json = nlohmann::json::parse(phases.output, nullptr, false);
    EXPECT_EQ(json["discriminator step"]["pytorch"], 1000);
    EXPECT_EQ(json["generator step"]["pytorch"], 2000);
    EXPECT_EQ(json["9,400 motions"]["pytorch"], 94 * 3000);
    EXPECT_GT(json["9,400 motions"]["ratio"].get<double>(), 1);

    const auto path = (folder.path() / "actformer_speed.py").string();
    const auto whole = bench(
        "shift\ntest \"$*\" = '--persons 1 --classes 3 --frames 16 --batch 2 --rounds 1' && "
        "echo 1000 2000 3000 4000\n",
        "--method csgn --peer " + path + " width=8 d_width=2 batch=2");
    ASSERT_EQ(whole.exit, 0) << whole.output;
    json = nlohmann::json::parse(whole.output, nullptr, false);
    EXPECT_EQ(json["batch"], 2) << "the setting's word counts, for the peer too";
    EXPECT_EQ(json["step, processors"]["pytorch"], 2000);
    EXPECT_EQ(json["100 motions"]["pytorch"], 3000);

    for (const std::string said : {"1 2", "1 2 3 4", "0 1 2", "-1 1 2", "nan 1 2", "1 2 3x", "banana"})
        EXPECT_NE(bench("echo " + said + "\n", "").exit, 0) << said << ": no three times";
    EXPECT_NE(bench("exit 3\n", "").exit, 0);
    const auto alone = run_actformer("bench train --method csgn --peer " + path);
    EXPECT_NE(alone.exit, 0);
    EXPECT_NE(alone.output.find("--peer requires --peers"), std::string::npos) << alone.output;
}

// No shell is between: whatever a path holds arrives whole.
TEST(BenchTrain, HandsPathsToThePeerAsTheyAre) {
    if (!has_training()) GTEST_SKIP() << "this build has no libtorch";
    const TempDir dir;
    const auto folder = dir / "it's $HOME; `x`";
    write_file(folder / "actformer_speed.py", "");
    write_file(folder / "peer's.sh", "test -f \"$1/actformer_speed.py\" && echo 1 2 3 4\n");
    const auto quoted = [&](const std::string& name) {
        return "\"" + dir.path().string() + "/it's \\$HOME; \\`x\\`" + name + "\"";
    };
    const auto result = run_actformer(
        "bench train --persons 1 --classes 3 --frames 16 --batch 2 --threads 1 --rounds 1 --json --method "
        "csgn "
        "width=8 d_width=2 --python /bin/sh --peers " +
        quoted("") + " --peer " + quoted("/peer's.sh") + " 2>/dev/null");
    ASSERT_EQ(result.exit, 0) << result.output;
    EXPECT_EQ(nlohmann::json::parse(result.output)["step, processors"]["pytorch"], 2);
}

TEST(BenchTrain, RefusesAFolderWithoutThePeer) {
    if (!has_training()) GTEST_SKIP() << "this build has no libtorch";
    expect_refused(run_actformer("bench train --frames 16 --batch 1 --rounds 1 --peers /nowhere"),
                   {"/nowhere", "actformer_speed.py", "--peers"});
}

TEST(BenchTrain, RefusesSettingsThatItHasOptionsFor) {
    if (!has_training()) GTEST_SKIP() << "this build has no libtorch";
    const std::string bench = "bench train --method actformer --frames 16 --batch 1 --rounds 1 ";
    expect_refused(run_actformer(bench + "threads=1"), {"threads=1", "--threads"});
    expect_refused(run_actformer(bench + "data=cmu"), {"data=cmu", "invented motions"});
}

TEST(BenchTrain, OpenBlasUsesTheProcessorsVectorsUnlessToldOtherwise) {
    if (!has_training()) GTEST_SKIP() << "this build has no libtorch";
#if !defined(__x86_64__)
    GTEST_SKIP() << "of processors other than these OpenBLAS knows what it needs";
#else
    if (!__builtin_cpu_supports("avx2")) GTEST_SKIP() << "a processor without wide vectors";
    const auto banner = [](const std::string& core) {
        return run_command("env " + core + " " + program() +
                           " bench train --persons 1 --classes 2 --frames 16 --batch 1 --rounds 1")
            .output;
    };
    if (banner("OPENBLAS_CORETYPE=Haswell").find("OpenBLAS for Haswell") == std::string::npos)
        GTEST_SKIP() << "libtorch's products are not OpenBLAS's";
    EXPECT_EQ(banner("-u OPENBLAS_CORETYPE").find("OpenBLAS takes this processor for"), std::string::npos);
    EXPECT_NE(banner("OPENBLAS_CORETYPE=Prescott").find("OpenBLAS takes this processor for a Prescott"),
              std::string::npos)
        << "the user's word counts";
#endif
}
