// Threads that parse the files of several groups at once, so that none of them waits for a group's last file.
//
// What they parse comes out in the files' order whatever thread is faster. A file of many clips comes out in portions: its thread
// waits once `most_parsed` bytes of clips are waiting, so that no file need fit in memory.
#pragma once

#include <algorithm>
#include <condition_variable>
#include <deque>
#include <exception>
#include <functional>
#include <mutex>
#include <thread>
#include <utility>
#include <vector>

#include "base/threads/thread.hpp"
#include "ingest/pipeline/groups.hpp"

namespace actformer::ingest {

inline constexpr std::size_t most_parsed = std::size_t{16} << 20;  // bytes of one file's clips

/// What follows in a group: some files whole, or parts of one.
struct Portion {
    std::vector<Item> items;  ///< an item that is not `done` goes on in the next portion
    bool ends_group = false, ends_tranche = false;
    double fraction = 0;  ///< of the source that has been read with the group
};

class Parsers {
  public:
    /// Reads and parses one file; the memory is the thread's own.
    using Parse = std::function<void(Item&, ClipSink&, TextMemory&)>;

    Parsers(unsigned threads, std::uint64_t largest_file, Parse parse)
        : parse_(std::move(parse)), largest_file_(largest_file), count_(threads) {
        try {
            for (unsigned t = 0; t < threads; ++t) threads_.push_back(new_thread([this] { work(); }));
        } catch (...) {
            stop();
            throw;
        }
    }

    /// Leaves out what has not been begun, and what waits for room.
    ~Parsers() { stop(); }
    Parsers(const Parsers&) = delete;
    Parsers& operator=(const Parsers&) = delete;

    void add(Group group) {
        {
            const std::lock_guard lock(mutex_);
            groups_.push_back({std::move(group)});
        }
        changed_.notify_all();
    }

    /// How many groups have not been taken whole.
    std::size_t groups() const { return groups_.size(); }

    /// What comes next of the group added first, once it is parsed whole or a file in it has filled its room. Throws what parse threw.
    Portion take() {
        std::unique_lock lock(mutex_);
        changed_.wait(lock, [this] { return failure_ || groups_.front().ready(); });
        if (failure_) std::rethrow_exception(failure_);
        auto portion = groups_.front().take();
        if (portion.ends_group) groups_.pop_front();
        lock.unlock();
        changed_.notify_all();
        return portion;
    }

  private:
    void stop() {
        {
            const std::lock_guard lock(mutex_);
            stopping_ = true;
        }
        changed_.notify_all();
    }

    struct InHand {
        Group group;
        std::size_t begun = 0, taken = 0;  ///< files

        bool ready() const {
            for (auto i = taken; i < group.items.size(); ++i)
                if (!group.items[i].done) return group.items[i].bytes >= most_parsed;
            return true;
        }

        Portion take() {
            Portion portion;
            for (; taken < group.items.size() && group.items[taken].done; ++taken)
                portion.items.push_back(std::move(group.items[taken]));
            portion.ends_group = taken == group.items.size();
            portion.ends_tranche = portion.ends_group && group.ends_tranche;
            portion.fraction = group.fraction;
            if (!portion.ends_group) {
                auto& open = group.items[taken];
                portion.items.emplace_back().file.path = open.file.path;
                portion.items.back().clips = std::exchange(open.clips, {});
                open.bytes = 0;
            }
            return portion;
        }
    };

    /// Thrown out of a parse whose clips nobody will take.
    struct Stopped {};

    class Sink : public ClipSink {
      public:
        Sink(Parsers& parsers, Item& item) : parsers_(parsers), item_(item) {}

        void take(ParsedClip clip) override {
            const auto* whole = std::get_if<std::unique_ptr<RawClip>>(&clip);
            const auto bytes =
                whole ? (*whole)->bytes() : sizeof(ParsedClip) + std::get<Rejection>(clip).reason.size();
            std::unique_lock lock(parsers_.mutex_);
            if (item_.bytes >= most_parsed) {
                parsers_.changed_.notify_all();
                parsers_.changed_.wait(lock,
                                       [this] { return parsers_.stopping_ || item_.bytes < most_parsed; });
            }
            if (parsers_.stopping_) throw Stopped();
            item_.clips.push_back(std::move(clip));
            item_.bytes += bytes;
        }

        unsigned threads() const override {
            const std::lock_guard lock(parsers_.mutex_);
            return std::max(1U, parsers_.count_ / std::max(1U, parsers_.parsing_));
        }

      private:
        Parsers& parsers_;
        Item& item_;
    };

    /// The earliest group with a file that nobody has begun; null where there is none. A deque keeps it in its place.
    InHand* next() {
        for (auto& group : groups_)
            if (group.begun < group.group.items.size()) return &group;
        return nullptr;
    }

    void work() {
        TextMemory text(largest_file_);
        std::unique_lock lock(mutex_);
        for (;;) {
            InHand* in_hand = nullptr;
            changed_.wait(lock, [&] { return stopping_ || (in_hand = next()); });
            if (stopping_) return;
            auto& item = in_hand->group.items[in_hand->begun++];
            ++parsing_;
            lock.unlock();
            std::exception_ptr failure;
            try {
                Sink sink(*this, item);
                parse_(item, sink, text);
            } catch (...) {
                failure = std::current_exception();
            }
            lock.lock();
            --parsing_;
            item.done = true;
            if (failure) failure_ = failure;
            if (failure || (in_hand == &groups_.front() && in_hand->ready())) changed_.notify_all();
        }
    }

    Parse parse_;
    std::uint64_t largest_file_;
    unsigned count_, parsing_ = 0;  ///< threads, and how many of them have a file
    std::mutex mutex_;
    std::condition_variable changed_;
    std::deque<InHand> groups_;
    std::exception_ptr failure_;
    bool stopping_ = false;
    std::vector<std::jthread> threads_;  // last: they use all the others
};

}  // namespace actformer::ingest
