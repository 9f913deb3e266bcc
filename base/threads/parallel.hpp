// A loop over all cores.
#pragma once

#include <algorithm>
#include <atomic>
#include <exception>
#include <mutex>
#include <thread>
#include <vector>

#include "base/threads/thread.hpp"

namespace actformer {

/// As many threads as asked for; 0 asks for one a core.
inline unsigned thread_count(unsigned wanted) {
    return wanted ? wanted : std::max(1U, std::thread::hardware_concurrency());
}

/// Calls body(i, thread) for every i below n, in any order. The first exception stops the loop and is thrown again here; so is Error
/// where a thread cannot be had.
template <typename Body>
void parallel_for(std::size_t n, unsigned threads, Body body) {
    std::atomic<std::size_t> next{0};
    std::exception_ptr failure;
    std::mutex failed;
    const auto stop = [&] {
        const std::lock_guard lock(failed);
        if (!failure) failure = std::current_exception();
        next = n;
    };
    const auto work = [&](unsigned thread) {
        try {
            for (std::size_t i = next++; i < n; i = next++) body(i, thread);
        } catch (...) {
            stop();
        }
    };
    {
        std::vector<std::jthread> others;
        try {
            for (unsigned t = 1; t < std::min<std::size_t>(threads, n); ++t)
                others.push_back(new_thread([&work, t] { work(t); }));
        } catch (...) {
            stop();
        }
        work(0);
    }
    if (failure) std::rethrow_exception(failure);
}

}  // namespace actformer
