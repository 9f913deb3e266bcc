#include "base/threads/thread.hpp"

#include <latch>
#include <vector>

#include "base/error.hpp"

namespace actformer {

void fail_without_thread(const std::system_error& why) {
    throw Error(
        "no thread can be had: {}; ask for fewer (--threads, where there is one), or raise the limits on "
        "processes and memory (ulimit -u, ulimit -v)",
        why.code().message());
}

void expect_threads(unsigned count) {
    std::latch over(1);
    std::vector<std::jthread> all;
    try {
        for (unsigned i = 0; i < count; ++i) all.push_back(new_thread([&over] { over.wait(); }));
    } catch (...) {
        over.count_down();
        throw;
    }
    over.count_down();
}

}  // namespace actformer
