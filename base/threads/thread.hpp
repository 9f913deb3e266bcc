// Threads that the system may refuse.
#pragma once

#include <system_error>
#include <thread>
#include <utility>

namespace actformer {

/// Throws Error: no thread could be had, for `why`.
[[noreturn]] void fail_without_thread(const std::system_error& why);

/// Throws Error where so many more threads cannot be had together. For libraries that abort or hang when theirs are refused.
void expect_threads(unsigned count);

/// A thread that does `work`. Throws Error where the system gives none.
template <typename Work>
std::jthread new_thread(Work work) {
    try {
        return std::jthread(std::move(work));
    } catch (const std::system_error& e) {
        fail_without_thread(e);
    }
}

}  // namespace actformer
