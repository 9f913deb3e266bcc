// A sweep's jobs as data: what goes in, what comes out, with which settings. Who runs them makes commands of it (JobRunner).
//
// Paths within a sweep's folder begin with {out}, for that folder, or {job}, for the job's own, so that the same work is the same
// in every sweep and on every machine.
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <string>
#include <variant>
#include <vector>

namespace actformer::reports {

using Settings = std::map<std::string, std::string>;  ///< key=value words for a training

/// Raw clips to a dataset.
struct IngestWork {
    std::string format;
    std::vector<std::string> raw;        ///< files and folders; empty: synthetic clips
    std::uint64_t clips = 0, seed = 1;   ///< of synthetic ones, which lie at `synthetic` then
    std::string actions;                 ///< of synthetic ones; empty: all
    std::vector<std::string> arguments;  ///< the user's own words for this format
    std::string synthetic = "{job}/raw", out = "{job}/data";
};

/// A recogniser or a generator, as `network` says; the configuration tells which.
struct TrainingWork {
    std::string network, config, data;
    Settings set;
    std::string out = "{job}/run";
};

/// A few motions of every class.
struct GenerationWork {
    std::string generator;
    std::uint64_t per_class = 4, seed = 0;
    std::string device;  ///< of libtorch; empty: the processor
    std::string out = "{job}/motions.h5";
};

/// Generated motions beside real ones: those of a generator, anew for every repeat, or those in files, a repeat each.
struct ScoringWork {
    std::string recogniser, single_recogniser, data, split, device;
    std::uint64_t window = 60;
    std::string generator;
    std::uint64_t repeats = 20, per_class = 100;
    std::string generate_on;           ///< device of libtorch; empty: the processor
    std::vector<std::string> motions;  ///< in place of a generator
    std::string out = "{job}/scores.json", features = "{job}/features";
};

/// Something that should have been there: nothing can be done. `what` is a word for it.
struct MissingWork {
    std::string what, path;
};

using Work = std::variant<IngestWork, TrainingWork, GenerationWork, ScoringWork, MissingWork>;

struct Job {
    std::string kind;   ///< ingest, recogniser, generator, generate, score
    std::string title;  ///< for people
    std::string
        id;  ///< kind-FINGERPRINT: the same work has the same id, in every sweep that sees the same files
    Work work;
    std::vector<std::size_t> needs;  ///< jobs that must be done before, each earlier in the list
    std::string problem;             ///< not empty: it cannot be done, and why
    double amount = 0;  ///< what its time grows with: clips, clips times epochs, motions; 0: not known
    double pace = 0;    ///< of that, about, in a second of two cores; 0: not known
};

/// Does jobs.
class JobRunner {
  public:
    virtual ~JobRunner() = default;

    /// What makes work the work it is: what its fingerprint is taken of. The same on every machine.
    virtual std::vector<std::string> identity(const Work& work) const = 0;

    /// The commands that do it, for people.
    virtual std::vector<std::string> command_lines(const Job& job) const = 0;

    /// Does it, writing what is said to `log`. Empty, or why it failed. May be called by several threads at once.
    virtual std::string run(const Job& job, const std::filesystem::path& log) const = 0;
};

}  // namespace actformer::reports
