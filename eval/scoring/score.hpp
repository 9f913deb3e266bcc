// Scoring motions or features files against a dataset's split or a features file.
#pragma once

#include "eval/scoring/features.hpp"
#include "eval/scoring/features_file.hpp"
#include "eval/scoring/score_report.hpp"

namespace actformer::eval {

/// Generated motions to score once. They may be there already, or be made when asked for and go away afterwards.
struct MotionSet {
    std::string name;                             ///< for messages and the provenance
    std::string key;                              ///< of what makes them what they are
    std::optional<std::uint64_t> seed;            ///< where it is known
    std::function<std::filesystem::path()> file;  ///< the motions, in the public layout
    bool temporary = false;                       ///< the file is removed once its features are taken
};

/// Motions in a file; the key is its checksum. Throws Error where it cannot be read.
MotionSet motions_in(const std::filesystem::path& file);

struct ScoreRequest {
    std::filesystem::path recogniser, single_recogniser;  ///< weights; the latter may be empty
    std::filesystem::path real;                           ///< dataset folder
    std::string split = "all";
    std::vector<MotionSet> generated;             ///< one a repeat
    std::map<std::string, std::uint32_t> labels;  ///< of generated motions, where names do not tell them
    std::uint32_t window = 60, frames = 0, batch = 64;  ///< as in FeaturesRequest

    /// Of both sides in place of all above; no recogniser and no device are needed then.
    std::filesystem::path real_features;
    std::vector<std::filesystem::path> generated_features;

    /// Features of the generated motions are put there as they are made, and taken from there where they are: a scoring that
    /// was interrupted goes on. The caller removes it.
    std::filesystem::path work;

    /// Where not empty, a folder to leave real.h5 and generated.h5 (of the first repeat) in, for pictures.
    std::filesystem::path keep;

    ScorerOptions options;
};

struct ScoreEvents {
    std::function<void(const std::string& what, std::uint64_t done, std::uint64_t all)> progress;
};

struct Scored {
    ScoreReport report;
    nlohmann::ordered_json json;  ///< to_json(report) and "provenance"
};

/// `device` is asked for only where features are to be made. Throws Error, one line, for whatever does not go together: as
/// make_features and read_features say; sides of other classes or dimensions; a one-person recogniser for one person's
/// motions; motions without labels.
Scored score(const ScoreRequest& request, const std::function<kernels::Device&()>& device,
             const ScoreEvents& events = {});

}  // namespace actformer::eval
