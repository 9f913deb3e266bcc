#include "base/files/temporary.hpp"

#include <mutex>
#include <thread>

namespace actformer {

namespace fs = std::filesystem;

namespace {

struct Living {
    std::mutex mutex;
    std::list<Temporary::Entry> all;
};

/// Never destroyed: a signal may come while the process ends.
Living& living() {
    static auto& one = *new Living;
    return one;
}

/// Other threads may still write into a folder; what they add while it is emptied goes in the next round.
void remove(const Temporary::Entry& entry) {
    if (entry.removes == Temporary::Removes::nothing) return;
    std::error_code error;
    for (int round = 0; round < 100; ++round) {
        if (entry.removes == Temporary::Removes::empty_folder)
            fs::remove(entry.path, error);
        else
            fs::remove_all(entry.path, error);
        if (error != std::errc::directory_not_empty || entry.removes == Temporary::Removes::empty_folder)
            return;
        std::this_thread::yield();
    }
}

}  // namespace

Temporary::Temporary(const std::function<fs::path()>& make, Removes removes) {
    auto& mine = living();
    const std::lock_guard lock(mine.mutex);
    mine.all.push_front({{}, removes});
    here_ = mine.all.begin();
    try {
        here_->path = make();
    } catch (...) {
        mine.all.erase(here_);
        throw;
    }
}

Temporary::~Temporary() {
    auto& mine = living();
    const std::lock_guard lock(mine.mutex);
    mine.all.erase(here_);
}

void Temporary::keep_as(const fs::path& to, std::error_code& error) {
    const std::lock_guard lock(living().mutex);
    fs::rename(here_->path, to, error);
    if (!error) here_->removes = Removes::nothing;
}

void remove_temporaries() {
    auto& mine = living();
    mine.mutex.lock();  // for good
    for (const auto& entry : mine.all) remove(entry);
}

}  // namespace actformer
