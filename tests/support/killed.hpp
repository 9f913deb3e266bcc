// Commands killed at a call of the system in which they are held (failing_calls.cpp): however busy the machine is, no kill comes too late.
#pragma once

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <chrono>
#include <filesystem>
#include <sstream>
#include <string>
#include <thread>
#include <vector>

#include "tests/support/command.hpp"
#include "tests/support/temp_dir.hpp"

namespace actformer::test {

struct WatchedRun {
    CommandResult result;
    std::vector<std::string>
        calls;  ///< that change files below the folder, in order: of each its name and path

    /// Which of them, from 1, is the `nth` with `words` in its line; 0, and a failure, where there is none.
    std::size_t call(const std::string& words, std::size_t nth = 1) const {
        for (std::size_t i = 0; i < calls.size(); ++i)
            if (calls[i].find(words) != std::string::npos && --nth == 0) return i + 1;
        ADD_FAILURE() << "no such call: " << words;
        return 0;
    }
};

/// Runs the program with `arguments` to its end and looks at what it does below `folder`.
inline WatchedRun watched_run(const std::string& arguments, const std::filesystem::path& folder) {
    const TempDir dir;
    WatchedRun run;
    run.result = run_command(fmt::format("LD_PRELOAD={} FAIL_BELOW={} FAIL_LIST={} {} {}", failing_calls(),
                                         folder.string(), (dir / "calls").string(), program(), arguments));
    std::istringstream text(read_file(dir / "calls"));
    for (std::string call; std::getline(text, call);) run.calls.push_back(call);
    return run;
}

/// Starts the program with `arguments` and kills it when it is about to make the call `call`, from 1, of those below `folder`.
inline void kill_before(std::size_t call, const std::string& arguments, const std::filesystem::path& folder) {
    const TempDir dir;
    Child child(
        arguments, (dir / "said").string(),
        fmt::format("LD_PRELOAD={} FAIL_BELOW={} FAIL_LIST={} FAIL_AT={} FAIL_WAITS={}", failing_calls(),
                    folder.string(), (dir / "calls").string(), call, (dir / "never").string()));
    const auto waits = [&] { return static_cast<std::size_t>(lines_in(read_file(dir / "calls"))) >= call; };
    for (int i = 0; i < 600'000 && !waits() && !child.has_ended(); ++i)
        std::this_thread::sleep_for(std::chrono::milliseconds(1));
    EXPECT_TRUE(waits()) << read_file(dir / "said");
    ::kill(child.pid(), SIGKILL);
    EXPECT_EQ(child.wait(), 128 + SIGKILL) << read_file(dir / "said");
}

}  // namespace actformer::test
