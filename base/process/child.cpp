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

namespace actformer {
namespace {

/// In the child: only what is safe between fork and exec.
[[noreturn]] void become(char* const* arguments, char* const* environment, int out, int errors,
                         pid_t parent) {
    restore_signals();
    ::prctl(PR_SET_PDEATHSIG, SIGKILL);
    if (::getppid() != parent) ::_exit(128 + SIGKILL);
    const int nothing = ::open("/dev/null", O_RDONLY);
    ::dup2(nothing, 0);
    ::dup2(out, 1);
    ::dup2(errors, 2);
    ::execvpe(arguments[0], arguments, environment);
    static_cast<void>(::dprintf(2, "%s: cannot be run: %s\n", arguments[0], std::strerror(errno)));
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

Child::Child(const std::vector<std::string>& command, int out, int errors, const Environment& more) {
    const auto words = environment_with(more);
    const auto arguments = pointers_to(command), environment = pointers_to(words);
    const auto parent = ::getpid();
    pid_ = ::fork();
    if (pid_ == 0) become(arguments.data(), environment.data(), out, errors, parent);
    if (pid_ < 0) throw Error("{}: no process can be made: {}", command[0], std::strerror(errno));
    signals_.emplace(pid_);
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
