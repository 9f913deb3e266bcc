// From motions to features files: `features` (n, features), `logits` (n, classes), `names` and, where known, `labels`.
#pragma once

#include <filesystem>
#include <functional>
#include <optional>
#include <span>

#include "eval/scoring/feature_extractor.hpp"

namespace actformer::eval {

/// An extractor, and the file that its features go to.
struct FeaturesTarget {
    FeatureExtractor* extractor = nullptr;
    std::filesystem::path file;
};

struct FeaturesSummary {
    std::uint64_t sequences = 0, classes = 0, features = 0;
    bool labelled = false;
    std::optional<double>
        accuracy;  ///< share of sequences whose largest logit is their label's, where labels are known
};

using OnProgress = std::function<void(std::uint64_t done, std::uint64_t all)>;

/// Shows every motion of `motions` to every target's extractor, one after another. The files appear whole or not at all, rows
/// in the order of MotionsInfo::names. Memory does not grow with the number of motions, their names apart. The summary is the
/// first target's. Throws Error for motions that do not fit an extractor, as FeatureExtractor says, and as the source does.
FeaturesSummary write_features(MotionSource& motions, std::span<const FeaturesTarget> targets,
                               const OnProgress& tell = {});

}  // namespace actformer::eval
