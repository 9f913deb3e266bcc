// `actformer bench train` at a size that takes no time. How fast it is stands in no test.
#include <gtest/gtest.h>

#include <filesystem>
#include <nlohmann/json.hpp>

#include "tests/support/command.hpp"

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
        EXPECT_GT(json["100 motions"]["seconds"].get<double>(), 0) << method;
    }
}

TEST(BenchTrain, RefusesAFolderWithoutThePeer) {
    if (!has_training()) GTEST_SKIP() << "this build has no libtorch";
    expect_refused(run_actformer("bench train --frames 16 --batch 1 --rounds 1 --peers /nowhere"),
                   {"/nowhere", "actformer_speed.py", "--peers"});
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
