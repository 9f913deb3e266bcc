// Running programs as the user would, one command line each.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "base/process/child.hpp"

namespace actformer {

struct ProcessResult {
    int exit = -1;          ///< exit code, or 128 + the signal that ended it
    std::string last_line;  ///< of what it wrote: where it failed, why
};

/// Runs command[0] with the arguments that follow and waits. What it writes is appended to `log`; it reads nothing. A signal that
/// this process catches reaches it too, as SIGTERM, and it does not outlive this process. Throws Error where the log cannot be
/// opened, is a link or no regular file, or no process can be made; a program that is not there gives exit code 127.
ProcessResult run_process(const std::vector<std::string>& command, const std::filesystem::path& log);

struct Answer {
    int exit = -1;       ///< as ProcessResult's
    std::string output;  ///< all of its standard output
    std::string why;     ///< the last line of its standard error
};

/// As run_process(), of a program whose standard output is an answer: of what it writes, standard error alone goes to `log`.
Answer answer_of(const std::vector<std::string>& command, const std::filesystem::path& log,
                 OnSignal on_signal = OnSignal::end);

/// The folder that this program lies in: its sister programs lie there too.
std::filesystem::path program_folder();

/// As one would type it: words with spaces or other special characters in quotes.
std::string command_line(const std::vector<std::string>& command);

}  // namespace actformer
