#include "reports/sweep/results.hpp"

#include "base/checksum/checked_json.hpp"
#include "base/error.hpp"
#include "base/files/file.hpp"
#include "base/files/lock.hpp"
#include "base/text/loose_json.hpp"

namespace actformer::reports {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

JobStatus status_of(const fs::path& folder) {
    const auto is_damaged = [](const Json& json) {
        return !json.is_object() || own_checksum_of(json) == OwnChecksum::wrong;
    };
    JobStatus out;
    if (fs::exists(folder / "done.json")) {
        out.state = JobState::done;
        const auto json = loose::read(folder / "done.json");
        const auto& seconds = loose::member(json, "seconds");
        if (seconds.is_number() && !is_damaged(json)) out.seconds = seconds;
    } else if (FileLock::is_held(folder / "lock")) {  // by the process that works on the job
        out.state = JobState::running;
    } else if (fs::exists(folder / "failed.json")) {
        out.state = JobState::failed;
        const auto json = loose::read(folder / "failed.json");
        out.why = is_damaged(json) ? fmt::format("{}: damaged", (folder / "failed.json").string())
                                   : loose::text(json, "why");
        if (out.why.empty()) out.why = "?";
    }
    return out;
}

/// Paths in the sweep's folder without it.
std::string shown(std::string path) {
    const std::string out = "{out}/";
    return path.starts_with(out) ? path.substr(out.size()) : path;
}

Json run_json(const PlannedRun& run, const JobStatus& status) {
    Json out{{"seed", run.seed}, {"status", name_of(status.state)}};
    if (!status.why.empty()) out["why"] = status.why;
    for (const auto& [key, path] : {std::pair{"scores", run.scores},
                                    {"features", run.features},
                                    {"motions", run.motions},
                                    {"run", run.run},
                                    {"recogniser", run.recogniser},
                                    {"dataset", run.dataset}})
        if (!path.empty()) out[key] = shown(path);
    return out;
}

/// Where a dataset comes from.
Json data_json(const SweepDataset& data) {
    if (data.clips > 0) return {{"synthetic", data.clips}, {"seed", data.seed}};
    if (!data.raw.empty()) return {{"raw", data.raw}};
    return {{"path", data.path}};
}

/// What jobs that are done took. Of some nobody knows how much there was to do.
struct Taken {
    double seconds = 0, jobs = 0;
    double known_seconds = 0, known_work = 0;

    /// As long as they took a piece of work; each of them, where that is not known.
    std::optional<double> seconds_for(double amount) const {
        if (known_work > 0 && amount > 0) return known_seconds / known_work * amount;
        if (jobs > 0) return seconds / jobs;
        return {};
    }
};

template <typename Counts>
Taken taken_by(const Plan& plan, const std::vector<JobStatus>& status, Counts counts) {
    Taken all;
    for (std::size_t i = 0; i < plan.jobs.size(); ++i) {
        const auto& job = plan.jobs[i];
        if (!status[i].seconds || !counts(job)) continue;
        all.seconds += *status[i].seconds;
        ++all.jobs;
        if (job.amount <= 0) continue;
        all.known_seconds += *status[i].seconds;
        all.known_work += job.amount;
    }
    return all;
}

/// A training's configuration, which says the method and its size; empty for other work.
std::string configuration_of(const Job& job) {
    const auto* training = std::get_if<TrainingWork>(&job.work);
    return training ? training->config : "";
}

}  // namespace

const char* name_of(JobState state) {
    switch (state) {
        case JobState::done:
            return "done";
        case JobState::failed:
            return "failed";
        case JobState::running:
            return "running";
        default:
            return "waiting";
    }
}

fs::path folder_of(const fs::path& out, const Job& job) {
    return out / "jobs" / job.id;
}

std::vector<JobStatus> statuses(const Plan& plan, const fs::path& out) {
    std::vector<JobStatus> all;
    for (const auto& job : plan.jobs) {
        auto status = status_of(folder_of(out, job));
        if (!job.problem.empty()) status = {JobState::failed, job.problem, {}};
        for (const auto need : job.needs)
            if (status.state == JobState::waiting && all[need].state == JobState::failed)
                status = {JobState::failed, fmt::format("{}: {}", plan.jobs[need].title, all[need].why), {}};
        all.push_back(std::move(status));
    }
    return all;
}

nlohmann::ordered_json results(const Sweep& sweep, const Plan& plan, const fs::path& out) {
    const auto status = statuses(plan, out);
    Json json{{"format", 1}, {"sweep", sweep.name}, {"version", ACTFORMER_VERSION}, {"rows", Json::array()}};
    if (sweep.comparison) json["comparison"] = true;
    if (!sweep.tables.empty()) json["tables"] = sweep.tables;
    for (const auto& planned : plan.rows) {
        const auto& row = *planned.row;
        Json runs = Json::array();
        bool any_failed = false, all_done = true;
        std::string why;
        for (const auto& run : planned.runs) {
            const auto& s = status[run.score];
            all_done = all_done && s.state == JobState::done;
            if (s.state == JobState::failed && !any_failed) any_failed = true, why = s.why;
            runs.push_back(run_json(run, s));
        }
        Json one{{"name", row.name}, {"status", any_failed ? "failed" : all_done ? "done" : "waiting"}};
        if (any_failed) one["why"] = why;
        one["fills"] = row.fills;
        one["dataset"] = row.data;
        one["data"] = data_json(sweep.datasets.at(row.data));
        one["split"] = planned.split;
        one["settings"] = row.set;
        one["runs"] = runs;
        json["rows"].push_back(one);
    }
    return json;
}

void write_results(const Sweep& sweep, const Plan& plan, const fs::path& out) {
    const FileLock lock(out / "results.lock");
    const auto json = with_checksum(results(sweep, plan, out));
    write_whole(out / "results.json", json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n");
}

std::optional<double> estimate(const Plan& plan, const std::vector<JobStatus>& status, std::size_t job) {
    const auto& asked = plan.jobs[job];
    const auto alike = [&](const Job& other) {
        return other.kind == asked.kind && configuration_of(other) == configuration_of(asked);
    };
    const auto of_its_kind = [&](const Job& other) { return other.kind == asked.kind; };
    if (const auto seconds = taken_by(plan, status, alike).seconds_for(asked.amount)) return seconds;
    if (const auto seconds = taken_by(plan, status, of_its_kind).seconds_for(asked.amount)) return seconds;
    if (asked.amount > 0 && asked.pace > 0)
        return 2 + asked.amount / asked.pace;  // a program starts and ends, too
    return {};
}

}  // namespace actformer::reports
