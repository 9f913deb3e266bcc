// From motions or a split of a dataset to a file of features (DESIGN 3): `features` (n, 256), `logits` (n, classes), `names`
// and, where known, `labels`.
#pragma once

#include <filesystem>
#include <functional>
#include <map>
#include <optional>
#include <string>

#include "eval/recogniser.hpp"
#include "eval/stgcn/weights.hpp"
#include "ingest/dataset/dataset.hpp"

namespace actformer::eval {

struct FeaturesRequest {
    std::filesystem::path recogniser, input, out;
    std::uint32_t frames = 0;   ///< motions: how many of the first frames to take; 0 takes all
    std::uint32_t batch = 64;   ///< sequences handed to the device together
    std::uint32_t window = 60;  ///< datasets: frames of a window
    std::string split = "all";  ///< datasets

    /// A one-person recogniser on groups: it sees every person alone, and a group's features are the largest of its persons'
    /// in every channel. Its classes are others than the motions', so there are no logits.
    bool persons_apart = false;

    /// Motions: labels by name, before what names tell. Where it is not empty every motion must be in it.
    std::map<std::string, std::uint32_t> labels;
};

struct FeaturesSummary {
    std::uint64_t sequences = 0, classes = 0, features = 0;
    bool labelled = false;
    std::optional<double>
        accuracy;  ///< share of sequences whose largest logit is their label's, where labels are known
};

using Tell = std::function<void(std::uint64_t done, std::uint64_t all)>;

/// Reads a motions file (every motion whole, or its first frames) or a dataset (cut into consecutive windows) and writes
/// the features file, which appears whole or not at all. Memory does not grow with the number of sequences, names and a
/// dataset's frames apart.
///
/// Labels of a motions file are known where every name ends in its action (A001_0, S001C002P003R001A001).
///
/// Throws Error naming the file, the motion and the remedy for: weights as read_weights says; motions or datasets of other
/// persons or joints than the recogniser's, or another skeleton; a dataset of other classes; motions shorter than `frames`,
/// without frames, or not finite; names of actions that the recogniser does not know; an empty split.
FeaturesSummary make_features(const FeaturesRequest& request, kernels::Device& device, const Tell& tell = {});

/// Throws Error for a motions file that make_features would refuse, short of reading its motions. True where labels are known.
bool check_motions(const FeaturesRequest& request, const Weights& weights);

/// Throws Error unless the recogniser's weights fit the dataset: persons, joints, classes, and the tree of the skeleton (for
/// NTU's 25 joints, whose hands the recogniser links otherwise, either tree). A recogniser that sees `persons_apart` must
/// take one person, and its classes do not matter.
void check_fits(const Weights& weights, const ingest::Dataset& dataset, bool persons_apart = false);

/// The label that a motion's name tells: 0 for A001_7.
std::optional<std::uint32_t> label_in(const std::string& name);

}  // namespace actformer::eval
