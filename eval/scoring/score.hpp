// Scoring motions or features files against a dataset's split or a features file.
#pragma once

#include "eval/scoring/features_file.hpp"
#include "eval/scoring/motion_source.hpp"
#include "eval/scoring/score_report.hpp"
#include "eval/scoring/windows_source.hpp"

namespace actformer::eval {

/// Generated motions beside a dataset's split.
struct ScoreMotions {
    /// Folder of a training, or weights; empty, with a single_recogniser: FIDa alone is measured.
    std::filesystem::path recogniser;

    /// One-person recogniser for FIDa of several persons; may be empty. One of the 15 common joints sees those of any skeleton
    /// that has them.
    std::filesystem::path single_recogniser;
    std::optional<std::uint64_t> initial_noise;  ///< of the recogniser: see open_recogniser
    WindowsOptions real;
    std::vector<MotionSet> generated;  ///< one a repeat

    /// Features of the generated motions are put there as they are made, and taken from there where they are: a scoring that
    /// was interrupted goes on. The caller removes it.
    std::filesystem::path work;

    /// Where not empty, a folder to leave real.h5 and generated.h5 (of the first repeat) in, for pictures.
    std::filesystem::path keep;

    ScorerOptions options;
};

/// Features files of both sides, without a recogniser.
struct ScoreFeatures {
    std::filesystem::path real;
    std::vector<std::filesystem::path> generated;  ///< one a repeat
    ScorerOptions options;
};

struct Scored {
    ScoreReport report;
    nlohmann::ordered_json json;  ///< to_json(report) and "provenance"
    std::vector<std::string>
        notes{};  ///< of kept features that were damaged and have been made anew, a line each
};

/// Sequences that the recognisers are done with, of the real side and of all sets together.
using ScoreProgress = std::function<void(std::uint64_t done, std::uint64_t all)>;

/// Opens each recogniser once and shows it every set. Throws Error, one line, for whatever does not go together: as
/// FeatureExtractor and the sources say; sides of other classes or dimensions; a one-person recogniser for one person's
/// motions; motions without labels.
Scored score_motions(const ScoreMotions& request, kernels::Device& device,
                     const ScoreProgress& progress = {});

/// Whether scoring puts a file of this path into the folder ScoreMotions::work.
bool is_kept_by_score(const std::filesystem::path& below);

/// Throws Error as read_features does, and for sides of other classes or dimensions.
Scored score_features(const ScoreFeatures& request);

}  // namespace actformer::eval
