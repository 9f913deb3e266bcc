// A thread that does one job after the other while the next ones are prepared.
#pragma once

#include <condition_variable>
#include <deque>
#include <exception>
#include <future>
#include <mutex>
#include <thread>
#include <utility>

#include "base/threads/thread.hpp"

namespace actformer {

class Worker {
  public:
    /// At most `most` jobs wait, so that what they hold in memory stays bounded. Throws Error where no thread can be had.
    explicit Worker(std::size_t most) : most_(most), thread_(new_thread([this] { work(); })) {}

    /// Drops the jobs that wait and lets the one in hand end.
    ~Worker() {
        {
            const std::lock_guard lock(mutex_);
            waiting_.clear();
            stopping_ = true;
        }
        changed_.notify_all();
        thread_.join();
    }
    Worker(const Worker&) = delete;
    Worker& operator=(const Worker&) = delete;

    /// Takes a job as soon as few enough wait. Throws what a job before threw; none is begun after that.
    template <typename Job>
    void add(Job job) {
        std::unique_lock lock(mutex_);
        changed_.wait(lock, [this] { return waiting_.size() < most_ || failure_; });
        if (failure_) std::rethrow_exception(failure_);
        waiting_.emplace_back(std::move(job));
        changed_.notify_all();
    }

    /// Waits until all is done; throws what a job threw.
    void finish() {
        end_what_waits();
        if (failure_) std::rethrow_exception(failure_);
    }

    /// As `finish`, after another failure, which is the one to tell: what a job threw is not thrown again.
    void end_what_waits() {
        std::unique_lock lock(mutex_);
        changed_.wait(lock, [this] { return (waiting_.empty() && !busy_) || failure_; });
    }

  private:
    void work() {
        std::unique_lock lock(mutex_);
        for (;;) {
            changed_.wait(lock, [this] { return !waiting_.empty() || stopping_; });
            if (stopping_) return;
            auto job = std::move(waiting_.front());
            waiting_.pop_front();
            busy_ = true;
            lock.unlock();
            changed_.notify_all();
            job();
            std::exception_ptr failure;
            try {
                job.get_future().get();
            } catch (...) {
                failure = std::current_exception();
            }
            job = {};  // what it held goes before the next begins
            lock.lock();
            busy_ = false;
            if (failure) {
                failure_ = failure;
                waiting_.clear();
                stopping_ = true;
            }
            changed_.notify_all();
        }
    }

    const std::size_t most_;
    std::mutex mutex_;
    std::condition_variable changed_;
    std::deque<std::packaged_task<void()>> waiting_;
    std::exception_ptr failure_;
    bool busy_ = false, stopping_ = false;
    std::jthread thread_;  // last: it uses all the others
};

}  // namespace actformer
