// Runs a command line as a user would.
#pragma once

#include <signal.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <string>
#include <vector>

#include "tests/support/command_result.hpp"
#include "tests/support/paths.hpp"
#include "tests/support/warm_training.hpp"

namespace actformer::test {

inline CommandResult run_command(const std::string& line) {
    CommandResult result;
    FILE* pipe = ::popen(("(" + line + ") 2>&1").c_str(), "r");
    char buffer[4096];
    while (const auto n = std::fread(buffer, 1, sizeof buffer, pipe)) result.output.append(buffer, n);
    result.exit = exit_code_of(::pclose(pipe));
    return result;
}

/// The program built beside the tests.
inline CommandResult run_actformer(const std::string& arguments) {
    if (auto warm = run_in_warm_training(arguments)) return *std::move(warm);
    return run_command(program() + " " + arguments);
}

/// The same program running beside the test, gone at the latest with this.
class Child {
  public:
    /// `environment` as in "TMPDIR=/x", before the program's name.
    explicit Child(const std::string& arguments, const std::string& output = "/dev/null",
                   const std::string& environment = {})
        : pid_(::fork()) {
        if (pid_ != 0) return;
        ::prctl(PR_SET_PDEATHSIG, SIGKILL);  // it ends with the tests, however they end
        for (const int signal : {SIGINT, SIGTERM, SIGHUP})
            ::signal(signal, SIG_DFL);  // whatever the tests' caller does
        const auto command =
            "exec env " + environment + " " + program() + " " + arguments + " >" + output + " 2>&1";
        ::execl("/bin/sh", "sh", "-c", command.c_str(), nullptr);
        ::_exit(127);
    }
    ~Child() {
        if (pid_ > 0) ::kill(pid_, SIGKILL);
        wait();
    }
    Child(const Child&) = delete;
    Child& operator=(const Child&) = delete;

    pid_t pid() const { return pid_; }

    /// Whether it has ended, without waiting for that.
    bool has_ended() const {
        siginfo_t state{};
        return pid_ <= 0 ||
               (::waitid(P_PID, static_cast<id_t>(pid_), &state, WEXITED | WNOHANG | WNOWAIT) == 0 &&
                state.si_pid != 0);
    }

    /// Its exit code; 128 and the signal's number where one ended it.
    int wait() {
        if (pid_ > 0) ::waitpid(pid_, &status_, 0);
        pid_ = 0;
        return exit_code_of(status_);
    }

  private:
    pid_t pid_;
    int status_ = 0;
};

inline long lines_in(const std::string& text) {
    return std::count(text.begin(), text.end(), '\n');
}

/// Exit code 1 and, last of all, one line with every one of `words` in it.
inline void expect_refused(const CommandResult& result, const std::vector<std::string>& words) {
    EXPECT_EQ(result.exit, 1) << result.output;
    const auto at = result.output.rfind("actformer: ");
    ASSERT_NE(at, std::string::npos) << result.output;
    const auto last = result.output.substr(at);
    EXPECT_EQ(lines_in(last), 1) << result.output;
    for (const auto& word : words) EXPECT_NE(last.find(word), std::string::npos) << word << ": " << last;
}

/// Whether there is a program of this name.
inline bool has_program(const std::string& name) {
    return run_command("command -v " + name).exit == 0;
}

/// Whether Debian's own Python has these modules, as in "h5py, torch". They are looked for and not loaded: torch takes seconds.
inline bool python_has(const std::string& modules) {
    return run_command(
               "/usr/bin/python3 -c 'import sys; from importlib.util import find_spec; "
               "sys.exit(not all(map(find_spec, sys.argv[1].split(\", \"))))' '" +
               modules + "'")
               .exit == 0;
}

/// Debian's own Python with what eager PyTorch's side of a comparison needs.
inline bool has_eager_pytorch() {
    return python_has("h5py, torch");
}

/// Debian's own Python with the modules that the reference programs need.
inline bool has_reference_python() {
    return std::filesystem::exists(shared("reference/preprocess.py")) && python_has("h5py, scipy");
}

}  // namespace actformer::test
