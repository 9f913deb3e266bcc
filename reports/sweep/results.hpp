// What a sweep leaves behind, and how far it is.
//
//   OUT/results.json            written anew whenever a job ends, whole or not at all; what a report is made of:
//     {"format": 1, "sweep": name, "version": .., "comparison": true of one, "tables": of its own, YAML as in the sweep's file, "rows": [
//        {"name", "status": "done" | "failed" (a run did; others may go on) | "waiting", "why": of a failure,
//         "fills": ["table3/full/NTU-1P", ..], "dataset": the sweep's name of it, "data": {"synthetic":
//         clips, "seed"} or {"raw": [files]} or {"path"}, "split", "settings": {key: value},
//         "runs": [{"seed", "status", "why", "scores", "features": folder of real.h5 and generated.h5, "motions", "run":
//                   folder of the training (config.yaml, log.jsonl), "recogniser": run folder or weights,
//                   "dataset": folder}]}]}
//     Paths begin with OUT's own folder left out where they lie in it ("jobs/score-0123456789ab/scores.json"), else they are
//     whole; what is not there yet is not there yet. Only runs whose status is "done" have scores that count. A cell's value
//     is the mean over the done runs of the one row that fills it, each its repeats' mean; a cell that no row fills, or whose row has
//     no done run, is "not run". Names are text from a user's file.
//   OUT/jobs/KIND-FINGERPRINT/  job.json (title, commands), log.txt, what the commands made, then done.json (seconds, finished, made: the
//                               checksums of what they made) or failed.json (why)
//
// Every .json ends in a member `checksum`, of all others.
#pragma once

#include <nlohmann/json.hpp>

#include "reports/sweep/plan.hpp"

namespace actformer::reports {

enum class JobState { waiting, running, done, failed };
const char* name_of(JobState state);

struct JobStatus {
    JobState state = JobState::waiting;
    std::string why;                ///< of a failure
    std::optional<double> seconds;  ///< of what is done
};

std::filesystem::path folder_of(const std::filesystem::path& out, const Job& job);

/// As the job's folder tells; of jobs whose needs failed, failed too, naming the first of them.
std::vector<JobStatus> statuses(const Plan& plan, const std::filesystem::path& out);

/// The contents of results.json.
nlohmann::ordered_json results(const Sweep& sweep, const Plan& plan, const std::filesystem::path& out);

/// Writes OUT/results.json.
void write_results(const Sweep& sweep, const Plan& plan, const std::filesystem::path& out);

/// Seconds that a job may take: those of done trainings of its configuration, or jobs of its kind, by their work, else a rough rate of
/// two cores; none where nothing is known.
std::optional<double> estimate(const Plan& plan, const std::vector<JobStatus>& statuses, std::size_t job);

}  // namespace actformer::reports
