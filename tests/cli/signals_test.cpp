// Signals, and output that nobody takes, as a shell or a batch system meets them.
#include <fcntl.h>
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <chrono>
#include <thread>

#include "tests/support/command.hpp"
#include "tests/support/sweep.hpp"
#include "tests/support/temp_dir.hpp"

using namespace actformer::test;
namespace fs = std::filesystem;

namespace {

template <typename There>
void wait_until(There there) {
    const auto end = std::chrono::steady_clock::now() + std::chrono::minutes(1);
    bool is_there = there();
    for (; !is_there && std::chrono::steady_clock::now() < end; is_there = there())
        std::this_thread::sleep_for(std::chrono::milliseconds(1));
    ASSERT_TRUE(is_there);
}

std::size_t entries(const fs::path& folder) {
    return static_cast<std::size_t>(std::distance(fs::directory_iterator(folder), fs::directory_iterator()));
}

/// A command that has a temporary folder in `temporary`, and waits for a program in it.
struct Signals : testing::Test {
    void SetUp() override {
        fs::create_directory(dir / "temporary");
        write_file(dir / "it's slow.sh", "exec sleep 600\n");
        write_file(dir / "fails.sh", "exit 1\n");
    }
    std::string bench(const std::string& peer) const {
        return "bench score --classes 2 --dimensions 2 --real 4 --generated 4 --repeats 1 --python /bin/sh "
               "--peer "
               "\"" +
               (dir / peer).string() + "\"";
    }
    std::string environment() const { return "TMPDIR=" + (dir / "temporary").string(); }
    std::string output() const { return read_file(dir / "output"); }

    TempDir dir;
};

struct SweepSignals : SweepFixture {};

}  // namespace

TEST_F(Signals, EndACommandInOrder) {
    for (const auto& [signal, name] :
         {std::pair{SIGINT, "SIGINT"}, {SIGTERM, "SIGTERM"}, {SIGHUP, "SIGHUP"}}) {
        Child child(bench("it's slow.sh"), (dir / "output").string(), environment());
        wait_until([&] { return entries(dir / "temporary") == 1; });
        ::kill(child.pid(), signal);
        EXPECT_EQ(child.wait(), 128 + signal);
        EXPECT_EQ(output(), fmt::format("actformer: stopped by {}\n", name));
        EXPECT_EQ(entries(dir / "temporary"), 0U);
    }
}

TEST_F(Signals, WhatTheCallerIgnoresStaysIgnored) {
    Child child(bench("it's slow.sh"), (dir / "output").string(), environment() + " nohup");
    wait_until([&] { return entries(dir / "temporary") == 1; });
    ::kill(child.pid(), SIGHUP);
    ::kill(child.pid(), SIGTERM);
    EXPECT_EQ(child.wait(), 128 + SIGTERM);
    EXPECT_NE(output().find("stopped by SIGTERM"), std::string::npos) << output();
    EXPECT_EQ(output().find("SIGHUP"), std::string::npos) << output();
}

TEST_F(Signals, WhatAKilledCommandLeavesIsRemovedByTheNext) {
    {
        const Child child(bench("it's slow.sh"), (dir / "output").string(), environment());
        wait_until([&] { return entries(dir / "temporary") == 1; });
        const auto other = run_command(environment() + " " + program() + " " + bench("fails.sh"));
        EXPECT_EQ(other.exit, 1) << other.output;
        EXPECT_EQ(entries(dir / "temporary"), 1U) << "its owner lives";
    }
    EXPECT_EQ(entries(dir / "temporary"), 1U);
    run_command(environment() + " " + program() + " " + bench("fails.sh"));
    EXPECT_EQ(entries(dir / "temporary"), 0U);
}

TEST_F(Signals, OutputThatNobodyTakes) {
    int ends[2];
    ASSERT_EQ(::pipe2(ends, O_CLOEXEC), 0);
    ::close(ends[0]);
    ASSERT_EQ(::dup2(ends[1], 9), 9);
    const auto closed = run_command(program() + " devices >&9");
    ::close(9);
    ::close(ends[1]);
    EXPECT_EQ(closed.exit, 128 + SIGPIPE);
    EXPECT_EQ(closed.output, "") << "as whoever closed it expects";
    expect_refused(run_command(program() + " devices >/dev/full"), {"standard output", "No space left"});
}

TEST_F(Signals, StandardErrorThatCannotBeWrittenEndsNothing) {
    const auto synth = program() + " synth ntu -o " + (dir / "raw").string() + " --clips ";
    for (const std::string errors : {" 2>/dev/full", " 2>&-"}) {
        EXPECT_EQ(run_command(synth + "0" + errors).exit, 1) << errors;
        EXPECT_EQ(run_command(synth + "1" + errors).exit, 0) << errors;
    }
    expect_refused(run_command(program() + " devices >&-"), {"standard output", "Bad file descriptor"});
}

TEST_F(Signals, NoFileIsOpenedInPlaceOfAClosedStandardError) {
    write_file(dir / "looks.sh", "readlink /proc/$PPID/fd/2 >'" + (dir / "seen").string() + "'; exit 1\n");
    EXPECT_EQ(run_command(environment() + " " + program() + " " + bench("looks.sh") + " 2>&-").exit, 1);
    EXPECT_EQ(read_file(dir / "seen"), "/dev/null\n");
}

TEST_F(Signals, ALimitOnTheSizeOfFilesIsALine) {
    expect_refused(
        run_command("ulimit -f 4; " + program() + " synth ntu --clips 1 -o " + (dir / "raw").string()),
        {"raw", "File too large"});
}

TEST_F(SweepSignals, GoToTheJobsAndMarkNoneOfThemFailed) {
    sweep_file("  a row: {}\n");
    write_file(dir / "pause", "600");
    Child child(
        "sweep " + at("sweep.yaml") + " -o " + at("out") + " --program " + at("actformer") + " --jobs 2",
        at("said"));
    wait_until([&] { return read_file(dir / "calls").find("synth") != std::string::npos; });
    ::kill(child.pid(), SIGTERM);
    EXPECT_EQ(child.wait(), 128 + SIGTERM) << read_file(dir / "said");
    const auto said = read_file(dir / "said");
    EXPECT_NE(said.find("stopped by SIGTERM; 0 of "), std::string::npos) << said;
    EXPECT_NE(said.find("the same command goes on"), std::string::npos) << said;
    EXPECT_EQ(said.find("failed"), std::string::npos) << said;
    fs::remove(dir / "pause");
    const auto again = sweep();
    EXPECT_EQ(again.exit, 0) << again.output;
}

TEST_F(SweepSignals, ASecondInterruptionStopsAtOnce) {
    sweep_file("  a row: {}\n");
    // A job that no signal ends: the sweep waits for it after the first.
    write_file(dir / "actformer",
               "#!/bin/sh\ntrap '' INT TERM\nhere=$(dirname \"$0\")\necho began >> \"$here/calls\"\n"
               "while [ ! -e \"$here/stop\" ]; do sleep 0.1; done\n");
    Child child("sweep " + at("sweep.yaml") + " -o " + at("out") + " --program " + at("actformer"),
                at("said"));
    wait_until([&] { return fs::exists(dir / "calls"); });
    ::kill(child.pid(), SIGINT);
    std::this_thread::sleep_for(std::chrono::milliseconds(200));
    EXPECT_EQ(::waitpid(child.pid(), nullptr, WNOHANG), 0) << "it waits for its job";
    // Again where the two came as one.
    siginfo_t ended{};
    wait_until([&] {
        ::kill(child.pid(), SIGINT);
        std::this_thread::sleep_for(std::chrono::milliseconds(50));
        return ::waitid(P_PID, static_cast<id_t>(child.pid()), &ended, WEXITED | WNOHANG | WNOWAIT) != 0 ||
               ended.si_pid != 0;
    });
    EXPECT_EQ(child.wait(), 128 + SIGINT);
    write_file(dir / "stop", "");
}
