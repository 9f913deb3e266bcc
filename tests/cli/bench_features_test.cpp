// `actformer bench features` at a size that takes no time. How fast it is stands in no test.
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "tests/support/command.hpp"
#include "tests/support/temp_dir.hpp"

using namespace actformer::test;

namespace {

/// Beside a peer that is the shell's.
CommandResult bench(const std::string& peer, const std::string& more = "") {
    const TempDir folder;
    write_file(folder / "stgcn.py", peer);
    return run_actformer("bench features --frames 8 --batch 1 --rounds 1 --python /bin/sh --peers " +
                         folder.path().string() + " " + more);
}

}  // namespace

TEST(BenchFeatures, TellsByHowManyThreadsThePeerWorks) {
    const auto result = bench("test $OMP_NUM_THREADS = 2 && echo 12.5", "--json");
    ASSERT_EQ(result.exit, 0) << result.output;
    const auto peers = nlohmann::json::parse(result.output).at("peers");
    EXPECT_EQ(peers.at("pytorch").at("sequences_a_second"), 12.5);
    EXPECT_EQ(peers.at("pytorch").at("threads"), 2);
    EXPECT_FALSE(peers.contains("onnxruntime")) << "none was named";
}

TEST(BenchFeatures, RefusesAPeerThatFails) {
    expect_refused(bench("exit 3"), {"stgcn.py", "--frames 8", "failed"});
    expect_refused(bench("echo banana"), {"stgcn.py", "prints", "banana"});
    expect_refused(bench("echo 0"), {"stgcn.py", "prints"});
}
