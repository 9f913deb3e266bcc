// Running a plan's jobs: here, or one of them, or through Slurm.
#pragma once

#include <functional>
#include <set>

#include "reports/sweep/results.hpp"

namespace actformer::reports {

struct SweepOptions {
    std::filesystem::path out;
    const JobRunner& runner;
    unsigned jobs = 1;  ///< at once
};

/// How far a sweep is when a job begins.
struct SweepProgress {
    std::size_t begun = 0, jobs = 0;  ///< done before, or begun, this one included; of all
    std::optional<double>
        seconds_left;  ///< for what is not done, by what was; empty where a job's length is not known
};

struct SweepEvents {
    std::function<void(const Job& job, const SweepProgress& progress)> begins;
    std::function<void(const Job& job, const JobStatus& status)> ends;
    std::function<void(const Job& job, const std::string& why)> again{};  ///< what it made is not as it was
};

/// Runs what is not done, or no longer as it was made; a job whose needs are done begins as soon as one of `jobs` workers is free. A failed job stops those that
/// need it and no others, and is tried again by the next call. Several processes may work in one folder: each job is done by
/// one of them, and the others wait for it. results.json is written before the first job and after each. A signal goes to the jobs
/// that run, which keep what they have; none is begun after it. Returns the statuses. Throws Error where the folder cannot be
/// written, Interrupted after a signal.
std::vector<JobStatus> run_plan(const Sweep& sweep, const Plan& plan, const SweepOptions& options,
                                const SweepEvents& events = {});

/// Runs one job, whose needs must be done. For Slurm's jobs. Throws Error for an id that the plan has not.
JobStatus run_one(const Sweep& sweep, const Plan& plan, const std::string& id, const SweepOptions& options);

/// Submits what is not done through sbatch, each job after those it needs; `command` gives the words that do a job where it lands.
/// Keeps Slurm's numbers in OUT/slurm.json, and leaves alone what is queued there already: by its number or, where a kill came before
/// that was kept, by its comment. Processes that submit from one folder take turns. Returns how many were submitted. Throws Error
/// where sbatch or squeue cannot be run or refuses, Interrupted after a signal.
std::size_t submit_plan(const Sweep& sweep, const Plan& plan, const SweepOptions& options,
                        const std::function<std::vector<std::string>(const Job&)>& command,
                        const std::vector<std::string>& sbatch_words,
                        const std::function<void(const Job& job, const std::string& why)>& again = {});

/// Ids of the jobs submitted from OUT that wait or run in Slurm; none where nothing was submitted or squeue does not answer. Writes nothing
/// there.
std::optional<std::set<std::string>> jobs_in_slurm(const std::filesystem::path& out);

}  // namespace actformer::reports
