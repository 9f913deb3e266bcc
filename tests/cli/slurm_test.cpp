// `actformer sweep --slurm` through a real Slurm, where one answers.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <chrono>
#include <cstdlib>
#include <thread>

#include "tests/support/sweep.hpp"

using namespace actformer::test;
namespace fs = std::filesystem;

namespace {

/// Some node takes jobs.
bool has_slurm() {
    const auto nodes = run_command("timeout 3 sinfo --noheader --states=idle,mixed,allocated --format=%D");
    return nodes.exit == 0 && std::atoi(nodes.output.c_str()) > 0;
}

struct Slurm : SweepFixture {
    void SetUp() override {
        if (!has_slurm())
            GTEST_SKIP()
                << "no Slurm answers; tests/slurm/one_node.sh start DIR, then SLURM_CONF=DIR/slurm.conf "
                   "before the test, makes one of one node";
        SweepFixture::SetUp();
        sweep_file(two_rows);
    }
    /// What is left over of a test that failed.
    void TearDown() override {
        if (const auto ids = unfinished(); !ids.empty()) run_command("scancel " + ids);
    }
    /// Slurm's numbers of the jobs it still has, as scancel takes them.
    std::string unfinished(const std::string& more = "") const {
        const auto json = nlohmann::json::parse(read_file(dir / "out/slurm.json"), nullptr, false);
        if (!json.is_object()) return {};
        std::string ids;
        const auto queue = run_command("squeue --noheader --me --format=%i " + more).output;
        for (const auto& [job, number] : json.items())
            if (("\n" + queue).find("\n" + number.get<std::string>() + "\n") != std::string::npos)
                ids += " " + number.get<std::string>();
        return ids;
    }
    /// Polls --status until `ready` likes what it says; what it says in the end.
    template <class Ready>
    std::string status_when(Ready ready) const {
        const auto end = std::chrono::steady_clock::now() + std::chrono::seconds(60);
        for (;;) {
            const auto said = sweep("--status").output;
            if (ready(said)) return said;
            if (std::chrono::steady_clock::now() > end) {
                ADD_FAILURE() << "not in 60 s:\n" << said << run_command("squeue").output;
                return said;
            }
            std::this_thread::sleep_for(std::chrono::milliseconds(200));
        }
    }
    /// Nothing is left to begin or to end.
    std::string status_at_the_end() const {
        return status_when([](const std::string& said) {
            return said.find("\nqueued ") == std::string::npos && said.find("queued ") != 0 &&
                   said.find("running ") == std::string::npos && said.find("to do  ") == std::string::npos;
        });
    }
    void expect_submitted(int jobs) const {
        const auto result = sweep("--slurm");
        EXPECT_EQ(result.exit, 0) << result.output;
        EXPECT_EQ(result.output.find(fmt::format("{} jobs submitted", jobs)), 0U) << result.output;
    }
    /// Every call that begins with `first` has ended before any that begins with `then` begins.
    void expect_order(const std::string& first, const std::string& then) const {
        const auto lines = lines_of("order");
        std::size_t last_end = lines.size(), first_begin = 0;
        for (std::size_t i = 0; i < lines.size(); ++i)
            if (lines[i].starts_with("ends: " + first)) last_end = i;
        for (std::size_t i = lines.size(); i-- > 0;)
            if (lines[i].starts_with("begins: " + then)) first_begin = i;
        EXPECT_LT(last_end, first_begin) << first << ", " << then << ":\n" << read_file(dir / "order");
    }
};

bool says(const std::string& text, const std::string& words) {
    return text.find(words) != std::string::npos;
}

}  // namespace

TEST_F(Slurm, DoesAsALocalRunDoes) {
    write_file(dir / "broken", "prior=gaussian");
    write_file(dir / "pause", "0.5");
    expect_submitted(8);
    EXPECT_PRED2(says, sweep("--status").output, "queued ");
    expect_submitted(0);
    const auto status = status_at_the_end();
    EXPECT_PRED2(says, status, "failed: gaussian: gaussian, seed 0: generator: actformer: out of luck");
    EXPECT_PRED2(says, status, "1 of 2 rows done");
    for (const auto* once : {"synth", "ingest ntu", "train recogniser", "generate --", "score"})
        EXPECT_EQ(calls_of(once), 1) << once;
    EXPECT_EQ(calls_of("train generator"), 2) << "the row that fails is not tried twice";
    expect_order("synth", "ingest");
    expect_order("ingest ntu", "train");
    expect_order("train generator", "generate");
    expect_order("train", "score");
    const auto through_slurm = read_file(dir / "out/results.json");
    fs::rename(dir / "out", dir / "slurm");
    EXPECT_EQ(sweep("--jobs 2").exit, 1);
    EXPECT_EQ(read_file(dir / "out/results.json"), through_slurm);
}

TEST_F(Slurm, TriesAgainWhatFailed) {
    write_file(dir / "broken", "train generator");
    expect_submitted(8);
    EXPECT_PRED2(says, status_at_the_end(), "0 of 2 rows done");
    fs::remove(dir / "broken");
    expect_submitted(6);
    EXPECT_PRED2(says, status_when([](const auto& said) { return says(said, "2 of 2 rows done"); }),
                 "2 of 2 rows done");
    status_at_the_end();
    EXPECT_EQ(calls_of("train recogniser"), 1);
    expect_submitted(0);
}

TEST_F(Slurm, GoesOnAfterACancelledJob) {
    write_file(dir / "pause", "30");
    expect_submitted(8);
    status_when([](const auto& said) { return says(said, "running  ingest"); });
    const auto running = unfinished("--states=RUNNING");
    ASSERT_FALSE(running.empty());
    ASSERT_EQ(run_command("scancel " + running).exit, 0);
    write_file(dir / "pause", "0");
    expect_submitted(8);  // at once: the old ones may not have left the queue yet
    status_when([](const auto& said) { return says(said, "2 of 2 rows done"); });
    status_at_the_end();
    EXPECT_EQ(calls_of("synth"), 2) << "the one that was cancelled, and its like";
    EXPECT_EQ(calls_of("train generator"), 2);
}

TEST_F(Slurm, TellsOfWhatWasCancelled) {
    write_file(dir / "pause", "30");
    expect_submitted(8);
    ASSERT_EQ(run_command("scancel " + unfinished()).exit, 0);
    status_when([](const auto& said) {
        return says(said, "8 of them neither done nor in Slurm's queue; --slurm submits them again");
    });
}
