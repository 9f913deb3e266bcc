#include "base/process/child.hpp"

#include <fcntl.h>
#include <signal.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <cstring>

#include "base/error.hpp"
#include "base/text/printable.hpp"

namespace actformer {
namespace {

/// What execvpe() takes, and more that must be made before the fork.
struct Start {
    char* const* arguments;
    char* const* environment;
    const char* name;  ///< of the program, as a terminal may show it
    int out, errors;
    bool in_our_group;  ///< of processes, which the terminal's signals reach
    pid_t parent;
};

/// In the child: only what is safe between fork and exec.
[[noreturn]] void become(const Start& start) {
    if (!start.in_our_group) ::setpgid(0, 0);  // before a signal of the terminal's can end it
    restore_signals();
    ::prctl(PR_SET_PDEATHSIG, SIGKILL);
    if (::getppid() != start.parent) ::_exit(128 + SIGKILL);
    const int nothing = ::open("/dev/null", O_RDONLY);
    ::dup2(nothing, 0);
    ::dup2(start.out, 1);
    ::dup2(start.errors, 2);
    ::execvpe(start.arguments[0], start.arguments, start.environment);
    static_cast<void>(::dprintf(2, "%s: cannot be run: %s\n", start.name, std::strerror(errno)));
    ::_exit(127);
}

/// This process's environment with `more` in it.
std::vector<std::string> environment_with(const Child::Environment& more) {
    std::vector<std::string> all;
    for (char** one = environ; *one; ++one) {
        const std::string text = *one;
        if (!more.contains(text.substr(0, text.find('=')))) all.push_back(text);
    }
    for (const auto& [name, value] : more) all.push_back(name + "=" + value);
    return all;
}

std::vector<char*> pointers_to(const std::vector<std::string>& words) {
    std::vector<char*> out;
    for (const auto& word : words) out.push_back(const_cast<char*>(word.c_str()));
    out.push_back(nullptr);
    return out;
}

}  // namespace

Child::Child(const std::vector<std::string>& command, int out, int errors, const Environment& more,
             OnSignal on_signal) {
    const auto words = environment_with(more);
    const auto arguments = pointers_to(command), environment = pointers_to(words);
    const auto name = printable(command[0]);
    const bool ends = on_signal == OnSignal::end;
    const Start start{arguments.data(), environment.data(), name.c_str(), out, errors, ends, ::getpid()};
    pid_ = ::fork();
    if (pid_ == 0) become(start);
    if (pid_ < 0) throw Error("{}: no process can be made: {}", command[0], std::strerror(errno));
    if (ends) signals_.emplace(pid_);
}

Child::~Child() {
    wait();
}

int Child::wait() {
    if (pid_ < 0) return exit_;
    int status = 0;
    while (::waitpid(pid_, &status, 0) < 0 && errno == EINTR) {
    }
    pid_ = -1;
    signals_.reset();
    exit_ = WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
    return exit_;
}

}  // namespace actformer
