// Signals in the middle of long work: what is done is kept for the next start, and a line says so.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <chrono>
#include <set>
#include <sstream>
#include <thread>

#include "tests/support/command.hpp"
#include "tests/support/temp_dir.hpp"
#include "tests/support/toy_dataset.hpp"
#include "tests/support/toy_recogniser.hpp"

namespace actformer::test {
namespace {

namespace fs = std::filesystem;

template <typename There>
void wait_for(There there) {
    const auto end = std::chrono::steady_clock::now() + std::chrono::minutes(5);
    while (!there() && std::chrono::steady_clock::now() < end)
        std::this_thread::sleep_for(std::chrono::milliseconds(1));
    ASSERT_TRUE(there());
}

bool has_ended(pid_t process) {
    siginfo_t ended{};
    return ::waitid(P_PID, static_cast<id_t>(process), &ended, WEXITED | WNOHANG | WNOWAIT) != 0 ||
           ended.si_pid != 0;
}

/// Whether the process has taken all signals that were sent to it.
bool has_taken_signals(pid_t process) {
    std::istringstream status(read_file("/proc/" + std::to_string(process) + "/status"));
    for (std::string line; std::getline(status, line);)
        if (line.starts_with("ShdPnd:")) return line.find_first_not_of("0\t ", 7) == std::string::npos;
    return true;
}

/// A command that is stopped in a call of the system which changes a file: the library of failing_calls.cpp holds it there.
struct StoppedWork : testing::Test {
    TempDir dir;

    std::string at(const std::string& name) const { return (dir / name).string(); }

    std::string environment(const fs::path& below) const {
        return fmt::format("XDG_CACHE_HOME={} FAIL_BELOW={} FAIL_LIST={} LD_PRELOAD={}", at("cache"),
                           below.string(), at("list"), failing_calls());
    }

    /// The calls of the last command, each its name and path.
    std::vector<std::string> calls() const {
        std::vector<std::string> all;
        std::istringstream lines(read_file(dir / "list"));
        for (std::string line; std::getline(lines, line);) all.push_back(line);
        return all;
    }

    std::string run(const std::string& arguments, const fs::path& below) const {
        fs::remove(dir / "list");
        const auto ran = run_command("env " + environment(below) + " " + program() + " " + arguments);
        EXPECT_EQ(ran.exit, 0) << ran.output;
        return ran.output;
    }

    /// Sends `signal` while the command is held in its call number `call`, and gives its last line.
    std::string stopped(const std::string& arguments, const fs::path& below, std::size_t call, int signal,
                        bool goes_on_to_a_safe_point) const {
        fs::remove(dir / "list");
        Child child(arguments, at("output"),
                    environment(below) + fmt::format(" FAIL_AT={} FAIL_WAITS={}", call, at("released")));
        wait_for([&] { return calls().size() >= call || has_ended(child.pid()); });
        ::kill(child.pid(), signal);
        if (goes_on_to_a_safe_point) {
            wait_for([&] { return has_taken_signals(child.pid()); });
            write_file(dir / "released", "");
        }
        const auto code = child.wait();
        const auto said = read_file(dir / "output");
        EXPECT_EQ(code, 128 + signal) << said;
        const auto last = said.rfind("actformer: ");
        return last == std::string::npos ? said : said.substr(last);
    }
};

}  // namespace

TEST_F(StoppedWork, ScoreKeepsFeatures) {
    write_toy_recogniser(toy(), dir / "r.h5");
    ASSERT_EQ(run_actformer("export " + toy().string() + " -o " + at("m.h5") + " --split s/train").exit, 0);
    write_file(dir / "labels.txt", labels_of_clips(toy()));
    const auto score = [&](const std::string& out) {
        return "score --recogniser " + at("r.h5") + " --real " + toy().string() +
               " --split s/train --generated " + at("m.h5") + " --labels " + at("labels.txt") + " -o " +
               at(out);
    };
    run(score("whole.json"), dir / "whole.json.work");
    const auto whole = calls();
    // Held where the file made last is brought to the disk: the others are done.
    std::size_t call = 0;
    std::vector<std::string> made;
    for (std::size_t i = 0; i < whole.size(); ++i) {
        if (whole[i].starts_with("fsync ") && whole[i].ends_with(".partial")) call = i + 1;
        if (whole[i].starts_with("rename")) made.push_back(fs::path(whole[i]).filename());
    }
    ASSERT_GE(made.size(), 2U) << fmt::format("{}", fmt::join(whole, "\n"));
    EXPECT_EQ(stopped(score("s.json"), dir / "s.json.work", call, SIGTERM, false),
              "actformer: stopped by SIGTERM; the same command goes on from there\n");
    EXPECT_FALSE(fs::exists(dir / "s.json"));
    std::set<std::string> kept;
    for (const auto& entry : fs::directory_iterator(dir / "s.json.work"))
        kept.insert(entry.path().filename());
    EXPECT_EQ(kept, std::set<std::string>(made.begin(), made.end() - 1));
    run(score("s.json"), dir / "s.json.work");
    for (const auto& line : calls())
        EXPECT_TRUE(line.find(made.back()) != std::string::npos || line.ends_with("s.json.work"))
            << "made again: " << line;
    EXPECT_EQ(read_file(dir / "s.json"), read_file(dir / "whole.json"));
    EXPECT_FALSE(fs::exists(dir / "s.json.work"));
}

TEST_F(StoppedWork, TrainingKeepsTheRunningStep) {
    if (!fs::exists(fs::path(program()).parent_path() / "actformer-train"))
        GTEST_SKIP() << "there is no libtorch";
    write_file(dir / "r.yaml",
               "model: recogniser\nwidth: 0.25\nframes: 16\nbatch: 12\nepochs: 20\nrate_drops: []\n"
               "train_split: s/train\ntest_split: s/test\nseed: 4\nthreads: 1\ncheckpoint_minutes: 1000\n");
    const auto train = [&](const std::string& out) {
        return "train recogniser -c " + at("r.yaml") + " --data " + toy().string() + " -o " + at(out);
    };
    run(train("whole"), dir / "whole/log.jsonl");
    const auto whole = calls();
    // Held where the log gets the second epoch's line.
    std::vector<std::size_t> writes;
    for (std::size_t i = 0; i < whole.size(); ++i)
        if (whole[i].starts_with("write ")) writes.push_back(i + 1);
    ASSERT_GE(writes.size(), 20U) << fmt::format("{}", fmt::join(whole, "\n"));
    const auto said = stopped(train("run"), dir / "run/log.jsonl", writes[1], SIGHUP, true);
    EXPECT_TRUE(said.starts_with("actformer: stopped by SIGHUP; ")) << said;
    EXPECT_NE(said.find(" of 60 is kept; the same command goes on from there\n"), std::string::npos) << said;
    EXPECT_EQ(lines_in(said), 1) << said;
    EXPECT_EQ(said.find("step 60 "), std::string::npos) << "it stopped at the end: " << said;
    const auto again = run(train("run"), dir / "run/log.jsonl");
    EXPECT_NE(again.find("going on after"), std::string::npos) << again;
    EXPECT_EQ(read_file(dir / "run/weights-last.h5"), read_file(dir / "whole/weights-last.h5"));
}

}  // namespace actformer::test
