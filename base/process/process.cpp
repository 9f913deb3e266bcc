#include "base/process/process.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <signal.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <fstream>

#include "base/error.hpp"

namespace actformer {
namespace {

/// In the child: only what is safe between fork and exec.
[[noreturn]] void become(char* const* arguments, int log, pid_t parent) {
    ::prctl(PR_SET_PDEATHSIG, SIGTERM);
    if (::getppid() != parent) ::_exit(143);
    const int nothing = ::open("/dev/null", O_RDONLY);
    ::dup2(nothing, 0);
    ::dup2(log, 1);
    ::dup2(log, 2);
    ::execvp(arguments[0], arguments);
    static_cast<void>(::dprintf(2, "%s: cannot be run: %s\n", arguments[0], std::strerror(errno)));
    ::_exit(127);
}

/// The last line of what stands in the file from `start` on that is not empty. A bar that overwrites itself ends with \r.
std::string last_line(const std::filesystem::path& path, std::uintmax_t start) {
    std::ifstream file(path, std::ios::binary);
    file.seekg(static_cast<std::streamoff>(start));
    std::string last;
    for (std::string line; std::getline(file, line);) {
        line = line.substr(line.rfind('\r') == std::string::npos ? 0 : line.rfind('\r') + 1);
        if (line.find_first_not_of(" \t\033[K") != std::string::npos) last = line;
    }
    return last;
}

}  // namespace

ProcessResult run_process(const std::vector<std::string>& command, const std::filesystem::path& log) {
    const int file = ::open(log.c_str(), O_CREAT | O_WRONLY | O_APPEND | O_CLOEXEC, 0644);
    if (file < 0) throw Error("{}: cannot be written: {}", log.string(), std::strerror(errno));
    std::error_code error;
    const auto start = std::filesystem::file_size(log, error);
    std::vector<char*> arguments;
    for (const auto& word : command) arguments.push_back(const_cast<char*>(word.c_str()));
    arguments.push_back(nullptr);
    const auto parent = ::getpid();
    const auto child = ::fork();
    if (child == 0) become(arguments.data(), file, parent);
    ::close(file);
    if (child < 0) throw Error("{}: no process can be made: {}", command[0], std::strerror(errno));
    int status = 0;
    while (::waitpid(child, &status, 0) < 0 && errno == EINTR) {
    }
    return {WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status), last_line(log, start)};
}

std::filesystem::path program_folder() {
    std::error_code error;
    return std::filesystem::read_symlink("/proc/self/exe", error).parent_path();
}

std::string command_line(const std::vector<std::string>& command) {
    std::string out;
    for (const auto& word : command) {
        if (!out.empty()) out += ' ';
        if (!word.empty() && word.find_first_not_of("abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ"
                                                    "0123456789_-./=:,+@%") == std::string::npos) {
            out += word;
            continue;
        }
        out += '\'';
        for (const char c : word) c == '\'' ? out += "'\\''" : out += c;
        out += '\'';
    }
    return out;
}

}  // namespace actformer
