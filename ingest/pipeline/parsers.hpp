// Threads that parse the items of several groups at once, so that none of them waits for a group's last item.
#pragma once

#include <condition_variable>
#include <deque>
#include <exception>
#include <functional>
#include <mutex>
#include <thread>
#include <utility>
#include <vector>

#include "ingest/pipeline/groups.hpp"

namespace actformer::ingest {

class Parsers {
  public:
    /// Reads and parses one item; `text` is the thread's own and keeps its memory from item to item.
    using Parse = std::function<void(Item&, std::vector<char>& text)>;

    Parsers(unsigned threads, Parse parse) : parse_(std::move(parse)) {
        for (unsigned t = 0; t < threads; ++t) threads_.emplace_back([this] { work(); });
    }

    /// Leaves out what has not been begun.
    ~Parsers() {
        {
            const std::lock_guard lock(mutex_);
            stopping_ = true;
        }
        changed_.notify_all();
    }
    Parsers(const Parsers&) = delete;
    Parsers& operator=(const Parsers&) = delete;

    void add(Group group) {
        {
            const std::lock_guard lock(mutex_);
            groups_.push_back({std::move(group)});
        }
        changed_.notify_all();
    }

    std::size_t groups() const { return groups_.size(); }

    /// The group added first, once all of it is parsed. Throws what parse threw.
    Group take() {
        std::unique_lock lock(mutex_);
        changed_.wait(
            lock, [this] { return groups_.front().done == groups_.front().group.items.size() || failure_; });
        if (failure_) std::rethrow_exception(failure_);
        auto group = std::move(groups_.front().group);
        groups_.pop_front();
        return group;
    }

  private:
    struct InHand {
        Group group;
        std::size_t begun = 0, done = 0;  ///< items
    };

    /// The earliest group with an item that nobody has begun; null where there is none. A deque keeps it in its place.
    InHand* next() {
        for (auto& group : groups_)
            if (group.begun < group.group.items.size()) return &group;
        return nullptr;
    }

    void work() {
        std::vector<char> text;
        std::unique_lock lock(mutex_);
        for (;;) {
            InHand* in_hand = nullptr;
            changed_.wait(lock, [&] { return stopping_ || (in_hand = next()); });
            if (stopping_) return;
            auto& item = in_hand->group.items[in_hand->begun++];
            lock.unlock();
            std::exception_ptr failure;
            try {
                parse_(item, text);
            } catch (...) {
                failure = std::current_exception();
            }
            lock.lock();
            if (failure) failure_ = failure;
            if (++in_hand->done == in_hand->group.items.size() || failure) changed_.notify_all();
        }
    }

    Parse parse_;
    std::mutex mutex_;
    std::condition_variable changed_;
    std::deque<InHand> groups_;
    std::exception_ptr failure_;
    bool stopping_ = false;
    std::vector<std::jthread> threads_;  // last: they use all the others
};

}  // namespace actformer::ingest
