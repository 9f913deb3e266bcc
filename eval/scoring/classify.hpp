// The actions of motions without labels.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "eval/scoring/features.hpp"

namespace actformer::eval {

/// A class that a clip may be of, and its probability: the softmax of the clip's logits.
struct Guess {
    std::uint32_t label = 0;  ///< from 0
    double probability = 0;
};

struct Classified {
    std::string clip;
    std::uint32_t windows = 0;  ///< whose logits were averaged
    Guess best;
    std::optional<Guess> runner_up;  ///< none of a recogniser of one class
};

/// Every clip of `motions` in their order; windows of a clip ("walk@0", "walk@60") count as one by the mean of their logits. Of
/// equally likely classes the first is the better. Throws Error for motions that do not fit the recogniser, and as the source
/// does; their own labels and classes do not matter.
std::vector<Classified> classify(MotionSource& motions, FeatureExtractor& extractor,
                                 const OnProgress& tell = {});

/// Names of the recogniser's classes: those in its weights, else the dataset's where there are as many, else A001, A002, ...
std::vector<std::string> class_names(const RecogniserInfo& recogniser, const MotionsInfo& motions);

}  // namespace actformer::eval
