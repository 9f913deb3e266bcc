#include "reports/sweep/run.hpp"

#include <algorithm>
#include <chrono>
#include <condition_variable>
#include <ctime>
#include <exception>
#include <mutex>
#include <thread>

#include "base/checksum/checked_json.hpp"
#include "base/error.hpp"
#include "base/files/file.hpp"
#include "base/process/interruption.hpp"
#include "base/threads/thread.hpp"
#include "reports/sweep/kept.hpp"
#include "reports/sweep/waiting_lock.hpp"

namespace actformer::reports {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

void write_json(const fs::path& path, const Json& json) {
    write_whole(path, with_checksum(json).dump(2, ' ', false, Json::error_handler_t::replace) + "\n");
}

std::string now() {
    const std::time_t time = std::time(nullptr);
    std::tm parts{};
    gmtime_r(&time, &parts);
    char text[32];
    std::strftime(text, sizeof text, "%Y-%m-%dT%H:%M:%SZ", &parts);
    return text;
}

/// Runs a job, unless somebody else has done it; empty, or why it failed. A job that a signal stopped leaves no mark of that.
std::string work_on(const Job& job, const SweepOptions& options, const SafePoints& safe_points) {
    const auto folder = folder_of(options.out, job);
    make_folders(folder);
    const auto lock = lock_when_free(folder / "lock", safe_points);
    if (!lock) return "another process does it";
    if (fs::exists(folder / "done.json")) {
        if (fault_of_results(folder).empty()) return {};  // done by whom we waited for
        discard_results(folder);
    }
    fs::remove(folder / "failed.json");
    const auto commands = options.runner.command_lines(job);
    write_json(folder / "job.json", {{"kind", job.kind}, {"title", job.title}, {"commands", commands}});
    const auto start = std::chrono::steady_clock::now();
    const auto why = options.runner.run(job, folder / "log.txt");
    const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    if (why.empty())
        write_json(folder / "done.json",
                   {{"seconds", seconds}, {"finished", now()}, {"made", checksums_of_results(folder)}});
    else if (!safe_points.asked())
        write_json(folder / "failed.json", {{"why", why}, {"seconds", seconds}, {"finished", now()}});
    return why;
}

/// The job's status once we have worked on it. Its folder alone would not tell of a failure while others hold the lock: those who
/// try the job again, or a process just forked by another worker.
JobStatus worked_on(const Plan& plan, std::size_t i, const SweepOptions& options,
                    const SafePoints& safe_points) {
    auto why = work_on(plan.jobs[i], options, safe_points);
    if (!why.empty()) return {JobState::failed, std::move(why), {}};
    return statuses(plan, options.out)[i];
}

/// The jobs of a plan and how far they are, shared by the workers that do them.
class Schedule {
  public:
    Schedule(const Sweep& sweep, const Plan& plan, const SweepOptions& options, const SweepEvents& events,
             const SafePoints& safe_points)
        : sweep_(sweep),
          plan_(plan),
          options_(options),
          events_(events),
          safe_points_(safe_points),
          taken_(plan.jobs.size(), false) {
        status_ = checked_statuses(plan, options.out, events.again);
        for (std::size_t i = 0; i < status_.size(); ++i) {
            auto& s = status_[i];
            if (s.state != JobState::done && plan.jobs[i].problem.empty()) s = {};  // tried again
            taken_[i] = s.state != JobState::waiting;
        }
        for (std::size_t i = 0; i < status_.size(); ++i)
            if (status_[i].state == JobState::failed) fail_those_that_need(i);
    }

    /// A worker: does jobs until none is left for it, a signal comes, or what they came to cannot be written.
    void work() {
        std::unique_lock lock(mutex_);
        try {
            for (;;) {
                std::optional<std::size_t> job;
                changed_.wait(lock, [&] { return (job = next()) || none_left(); });
                if (!job) return;
                do_one(*job, lock);
                changed_.notify_all();
            }
        } catch (...) {
            if (!failure_) failure_ = std::current_exception();
            changed_.notify_all();
        }
    }

    /// How far all jobs are once the workers have ended. Throws what ended one of them.
    const std::vector<JobStatus>& status() const {
        if (failure_) std::rethrow_exception(failure_);
        return status_;
    }

  private:
    /// With the lock held but while the job runs.
    void do_one(std::size_t job, std::unique_lock<std::mutex>& lock) {
        taken_[job] = true;
        if (events_.begins) events_.begins(plan_.jobs[job], progress());
        ++running_;
        lock.unlock();
        auto status = done_by_us(job);
        lock.lock();
        --running_;
        status_[job] = std::move(status);
        const bool stopped = status_[job].state == JobState::failed && safe_points_.asked();
        if (stopped) status_[job] = {};
        if (status_[job].state == JobState::failed) fail_those_that_need(job);
        if (events_.ends && !stopped) events_.ends(plan_.jobs[job], status_[job]);
        write_results(sweep_, plan_, options_.out);
    }

    std::optional<std::size_t> next() const {
        if (safe_points_.asked() || failure_) return {};
        for (std::size_t i = 0; i < taken_.size(); ++i) {
            if (taken_[i]) continue;
            bool ready = true;
            for (const auto need : plan_.jobs[i].needs)
                ready = ready && status_[need].state == JobState::done;
            if (ready) return i;
        }
        return {};
    }
    /// Nothing can become ready any more.
    bool none_left() const { return running_ == 0 && !next(); }

    SweepProgress progress() const {
        SweepProgress now{0, plan_.jobs.size(), 0.0};
        for (std::size_t i = 0; i < plan_.jobs.size(); ++i) {
            now.begun += taken_[i];
            if (status_[i].state == JobState::done || status_[i].state == JobState::failed) continue;
            const auto seconds = estimate(plan_, status_, i);
            if (!seconds) now.seconds_left.reset();
            if (now.seconds_left) *now.seconds_left += *seconds / options_.jobs;
        }
        return now;
    }

    JobStatus done_by_us(std::size_t i) {
        try {
            return worked_on(plan_, i, options_, safe_points_);
        } catch (const std::exception& e) {
            return {JobState::failed, e.what(), {}};
        }
    }

    void fail_those_that_need(std::size_t failed) {
        for (std::size_t i = failed + 1; i < plan_.jobs.size(); ++i)
            for (const auto need : plan_.jobs[i].needs)
                if (need == failed && !taken_[i]) {
                    taken_[i] = true;
                    status_[i] = {JobState::failed,
                                  fmt::format("{}: {}", plan_.jobs[failed].title, status_[failed].why),
                                  {}};
                    fail_those_that_need(i);
                }
    }

    const Sweep& sweep_;
    const Plan& plan_;
    const SweepOptions& options_;
    const SweepEvents& events_;
    const SafePoints& safe_points_;
    std::vector<bool> taken_;
    std::vector<JobStatus> status_;
    std::size_t running_ = 0;
    std::exception_ptr failure_;  ///< the first that ended a worker
    std::mutex mutex_;
    std::condition_variable changed_;
};

std::string how_to_go_on(const std::vector<JobStatus>& status) {
    const auto done = std::count_if(status.begin(), status.end(),
                                    [](const JobStatus& s) { return s.state == JobState::done; });
    return fmt::format("{} of {} jobs are done, and the same command goes on from there", done,
                       status.size());
}

}  // namespace

std::vector<JobStatus> run_plan(const Sweep& sweep, const Plan& plan, const SweepOptions& options,
                                const SweepEvents& events) {
    const SafePoints safe_points;
    make_folders(options.out);
    write_results(sweep, plan, options.out);
    Schedule schedule(sweep, plan, options, events, safe_points);
    const auto workers = std::min<std::size_t>(options.jobs, plan.jobs.size());
    expect_threads(static_cast<unsigned>(
        workers));  // rather than to learn in the middle of a job that one cannot be had
    {
        std::vector<std::jthread> others;
        for (std::size_t i = 1; i < workers; ++i) others.push_back(new_thread([&] { schedule.work(); }));
        schedule.work();
    }
    const auto& status = schedule.status();
    write_results(sweep, plan, options.out);
    if (safe_points.asked()) safe_points.stop(how_to_go_on(status));
    return status;
}

JobStatus run_one(const Sweep& sweep, const Plan& plan, const std::string& id, const SweepOptions& options) {
    for (std::size_t i = 0; i < plan.jobs.size(); ++i) {
        if (plan.jobs[i].id != id) continue;
        make_folders(options.out);
        if (!plan.jobs[i].problem.empty()) return {JobState::failed, plan.jobs[i].problem, {}};
        const SafePoints safe_points;
        auto status = worked_on(plan, i, options, safe_points);
        write_results(sweep, plan, options.out);
        if (safe_points.asked() && status.state != JobState::done)
            safe_points.stop("the same command goes on from there");
        return status;
    }
    throw Error(
        "there is no job '{}' in this sweep; was its file, or a raw file, changed since it was submitted?",
        id);
}

}  // namespace actformer::reports
