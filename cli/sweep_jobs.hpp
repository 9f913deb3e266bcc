// A sweep's jobs as commands of actformer.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "reports/sweep/run.hpp"

namespace actformer::cli {

class SweepJobs : public reports::JobRunner {
  public:
    /// `program` is the actformer that works, `out` the sweep's folder.
    SweepJobs(std::string program, std::filesystem::path out)
        : program_(std::move(program)), out_(std::move(out)) {}

    std::vector<std::string> identity(const reports::Work& work) const override;
    std::vector<std::string> command_lines(const reports::Job& job) const override;
    std::string run(const reports::Job& job, const std::filesystem::path& log) const override;

    /// A training whose configuration has no such key, or takes no such value, gets that for its problem. Nothing is looked at where this
    /// program was built without training.
    static void check_trainings(std::vector<reports::Job>& jobs);

    /// Synthetic clips that `actformer synth` cannot make become their job's problem.
    static void check_stand_ins(std::vector<reports::Job>& jobs);

    /// A dataset whose `arguments` or `actions` its commands would refuse gets that for its problem.
    static void check_ingests(std::vector<reports::Job>& jobs);

  private:
    /// The commands one after another, with all paths put in.
    std::vector<std::vector<std::string>> commands(const reports::Job& job) const;

    std::string program_;
    std::filesystem::path out_;
};

/// Tells on standard error which job begins and how each ends. `out` is the sweep's folder.
reports::SweepEvents told_events(const std::filesystem::path& out);

}  // namespace actformer::cli
