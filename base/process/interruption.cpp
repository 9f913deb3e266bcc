#include "base/process/interruption.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <signal.h>
#include <unistd.h>

#include <cerrno>
#include <mutex>
#include <thread>

#include "base/files/temporary.hpp"
#include "base/process/signal_mask.hpp"
#include "base/text/printable.hpp"

namespace actformer {
namespace {

struct Signals {
    std::mutex mutex;
    int first = 0;  ///< signal that came first; 0: none
    int interrupts = 0;
    int safe_points = 0;
    std::list<pid_t> children;
    std::list<std::string> goes_on;
};

/// Never destroyed: a signal may come while the process ends.
Signals& signals() {
    static auto& one = *new Signals;
    return one;
}

std::string stopped_by(int signal, const std::string& how_to_go_on) {
    return fmt::format("stopped by SIG{}{}{}", sigabbrev_np(signal), how_to_go_on.empty() ? "" : "; ",
                       how_to_go_on);
}

/// Holds the mutex, so that nothing else begins.
[[noreturn]] void end(const Signals& now, int signal) {
    remove_temporaries();
    const auto line =
        fmt::format("{}actformer: {}\n", ::isatty(STDERR_FILENO) ? "\r\033[K" : "",
                    printable(stopped_by(signal, now.goes_on.empty() ? "" : now.goes_on.back())));
    [[maybe_unused]] const auto written = ::write(STDERR_FILENO, line.data(), line.size());
    ::_exit(128 + signal);
}

void take(int signal) {
    auto& now = signals();
    const std::lock_guard lock(now.mutex);
    now.interrupts += signal == SIGINT;
    if (now.safe_points == 0 || now.interrupts > 1) end(now, signal);
    if (now.first != 0) return;
    now.first = signal;
    for (const auto child : now.children) ::kill(child, SIGTERM);
}

sigset_t set_of(std::initializer_list<int> signals) {
    sigset_t set;
    ::sigemptyset(&set);
    for (const int signal : signals) ::sigaddset(&set, signal);
    return set;
}

/// Files opened later must not become what is written to standard output or error. The stand-in for a closed one fails in the same way.
void take_closed_streams() {
    for (const int stream : {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO})
        if (::fcntl(stream, F_GETFD) < 0 && errno == EBADF)
            ::open("/dev/null", stream == STDIN_FILENO ? O_WRONLY : O_RDONLY);
}

bool is_ignored(int signal) {
    struct sigaction found {};
    return ::sigaction(signal, nullptr, &found) == 0 && found.sa_handler == SIG_IGN;
}

}  // namespace

void end_in_order() {
    take_closed_streams();
    // Blocked in all threads, as they take it from this one: LLVM, inside OpenCL, has handlers of its own for all of these, and asks
    // nobody. Those that end the program are waited for, also where its caller ignores them, and then nothing is done.
    ::signal(SIGPIPE, SIG_IGN);
    ::signal(SIGXFSZ, SIG_IGN);
    block_signals();
    const auto ending = set_of({SIGINT, SIGTERM, SIGHUP});
    sigset_t ignored;
    ::sigemptyset(&ignored);
    for (const int signal : {SIGINT, SIGTERM, SIGHUP})
        if (is_ignored(signal)) ::sigaddset(&ignored, signal);
    try {
        std::thread([ending, ignored] {
            for (;;) {
                int signal = 0;
                if (::sigwait(&ending, &signal) == 0 && ::sigismember(&ignored, signal) == 0) take(signal);
            }
        }).detach();
    } catch (
        const std::
            system_error&) {  // without a thread to wait for them they end the program, as they do any other
        ::pthread_sigmask(SIG_UNBLOCK, &ending, nullptr);
    }
}

void restore_signals() {
    ::signal(SIGPIPE, SIG_DFL);
    ::signal(SIGXFSZ, SIG_DFL);
    sigset_t none;
    ::sigemptyset(&none);
    ::sigprocmask(SIG_SETMASK, &none, nullptr);
}

Interrupted::Interrupted(int signal, const std::string& how_to_go_on)
    : signal_(signal), text_(printable(stopped_by(signal, how_to_go_on))) {}

SafePoints::SafePoints() : exceptions_(std::uncaught_exceptions()) {
    auto& now = signals();
    const std::lock_guard lock(now.mutex);
    ++now.safe_points;
}

SafePoints::~SafePoints() {
    auto& now = signals();
    const std::lock_guard lock(now.mutex);
    if (--now.safe_points == 0 && now.first != 0 && std::uncaught_exceptions() == exceptions_)
        end(now, now.first);
}

bool SafePoints::asked() const {
    auto& now = signals();
    const std::lock_guard lock(now.mutex);
    return now.first != 0;
}

void SafePoints::stop(const std::string& how_to_go_on) const {
    auto& now = signals();
    std::unique_lock lock(now.mutex);
    const int signal = now.first;
    lock.unlock();
    throw Interrupted(signal, how_to_go_on);
}

PassedOn::PassedOn(pid_t child) {
    auto& now = signals();
    const std::lock_guard lock(now.mutex);
    now.children.push_front(child);
    here_ = now.children.begin();
    if (now.first != 0) ::kill(child, SIGTERM);
}

PassedOn::~PassedOn() {
    auto& now = signals();
    const std::lock_guard lock(now.mutex);
    now.children.erase(here_);
}

GoesOn::GoesOn(const std::string& how) {
    auto& now = signals();
    const std::lock_guard lock(now.mutex);
    here_ = now.goes_on.insert(now.goes_on.end(), how);
}

GoesOn::~GoesOn() {
    auto& now = signals();
    const std::lock_guard lock(now.mutex);
    now.goes_on.erase(here_);
}

}  // namespace actformer
