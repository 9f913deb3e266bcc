// Runs a command line as a user would.
#pragma once

#include <sys/wait.h>

#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <string>

namespace actformer::test {

struct CommandResult {
    int exit = -1;
    std::string output;  ///< standard output and error together
};

inline CommandResult run_command(const std::string& line) {
    CommandResult result;
    FILE* pipe = ::popen(("(" + line + ") 2>&1").c_str(), "r");
    char buffer[4096];
    while (const auto n = std::fread(buffer, 1, sizeof buffer, pipe)) result.output.append(buffer, n);
    const int status = ::pclose(pipe);
    result.exit = WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
    return result;
}

/// The program built beside the tests.
inline CommandResult run_actformer(const std::string& arguments) {
    return run_command(std::string(ACTFORMER_PROGRAM) + " " + arguments);
}

inline long lines_in(const std::string& text) {
    return std::count(text.begin(), text.end(), '\n');
}

/// Debian's own Python with the modules that the reference programs need.
inline bool has_reference_python() {
    return std::filesystem::exists(ACTFORMER_SHARED "/reference/preprocess.py") &&
           run_command("/usr/bin/python3 -c 'import h5py, scipy'").exit == 0;
}

}  // namespace actformer::test
