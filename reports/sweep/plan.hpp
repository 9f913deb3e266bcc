// A sweep resolved to jobs with what they need, shared work once.
#pragma once

#include <optional>

#include "reports/sweep/sweep_file.hpp"

namespace actformer::reports {

/// One seed of a row. Paths are within the sweep's folder, but for data and weights that were there before.
struct PlannedRun {
    std::uint64_t seed = 0;
    std::size_t score = 0;  ///< job
    std::optional<std::size_t> generator,
        generate;  ///< jobs; none where the weights were there, or the motions are another tool's
    std::string scores, features, motions, run, recogniser, dataset;
};

struct PlannedRow {
    const SweepRow* row = nullptr;
    std::string split;  ///< of the real motions that it is scored against
    std::vector<PlannedRun> runs;
};

struct Plan {
    std::vector<Job> jobs;  ///< each after what it needs
    std::vector<PlannedRow> rows;
};

/// `sweep` must outlive the plan. Reads the configurations: their contents are part of the fingerprints, as are those of other files that
/// the work names, which raw files there are (see listing_of), the program's version and the work's identity. Relative paths are those of the
/// current folder, else of `beside`. `out` is the sweep's folder, which may lie among raw files. What is missing becomes the problem of the
/// jobs that need it.
Plan make_plan(const Sweep& sweep, const std::filesystem::path& beside, const std::filesystem::path& out,
               const JobRunner& runner);

/// `path` with {out} and {job} put in.
std::string filled_in(std::string path, const std::filesystem::path& out, const Job& job);

}  // namespace actformer::reports
