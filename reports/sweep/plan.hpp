// A sweep resolved to jobs: command lines with what they need, shared work once.
#pragma once

#include <optional>

#include "reports/sweep/sweep_file.hpp"

namespace actformer::reports {

/// In a job's words {program} stands for actformer, {out} for the sweep's folder, {job} for the job's own.
struct Job {
    std::string kind;   ///< ingest, recogniser, generator, generate, score
    std::string title;  ///< for people
    std::string id;  ///< kind-FINGERPRINT: the same work has the same id, in every sweep and on every machine
    std::vector<std::vector<std::string>> commands;  ///< one after another
    std::vector<std::size_t> needs;  ///< jobs that must be done before, each earlier in the list
    std::string problem;             ///< not empty: it cannot be done, and why
    double work = 0;  ///< what its time grows with: clips, clips times epochs, motions; 0: not known
    double pace = 0;  ///< of that, about, in a second of two cores; 0: not known
};

/// One seed of a row. Paths are within the sweep's folder, but for data and weights that were there before.
struct PlannedRun {
    std::uint64_t seed = 0;
    std::size_t score = 0;                           ///< job
    std::optional<std::size_t> generator, generate;  ///< jobs; none where the motions are another tool's
    std::string scores, features, motions, run, recogniser, dataset;
};

struct PlannedRow {
    const SweepRow* row = nullptr;
    std::vector<PlannedRun> runs;
};

struct Plan {
    std::vector<Job> jobs;  ///< each after what it needs
    std::vector<PlannedRow> rows;
};

/// `sweep` must outlive the plan. Reads the configurations, whose contents are part of the fingerprints, as are the program's
/// version and all words. Relative paths are those of the current folder, else of `beside`. What is missing becomes the
/// problem of the jobs that need it.
Plan make_plan(const Sweep& sweep, const std::filesystem::path& beside);

/// {program}, {out} and {job} put in.
std::vector<std::string> filled_in(const std::vector<std::string>& words, const std::string& program,
                                   const std::filesystem::path& out, const Job& job);

}  // namespace actformer::reports
