// What a recogniser's configuration may say.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>

#include "eval/recogniser_kind.hpp"
#include "ingest/dataset/common_joints.hpp"
#include "model/recognisers/gru.hpp"
#include "model/recognisers/stgcn.hpp"
#include "model/train/augmentation_settings.hpp"
#include "model/train/trainer_settings.hpp"

namespace actformer::model {

using eval::RecogniserKind;

/// Of the public ST-GCN and its training. The GRU classifier, whose width is fixed, moves by Adam and has no use for width, dropout,
/// momentum and nesterov.
struct RecogniserSettings : TrainerSettings, AugmentationSettings {
    RecogniserSettings() {
        epochs = 80;
        rate_drops = {10, 50};
        rate_factor = 0.1;
    }
    RecogniserKind kind = RecogniserKind::stgcn;
    std::string test_split;                  ///< may be empty: nothing is scored then
    std::uint32_t persons = 0, classes = 0;  ///< 0: as the dataset has them
    std::string joints = "own";  ///< or "common15", those that skeletons of several datasets share
    double width = 1, dropout = 0.5;
    double noise = 0;  ///< standard deviation of Gaussian noise added to the training input; 0 for none
    std::uint32_t frames = 60;
    double rate = 0.1, momentum = 0.9, weight_decay = 1e-4;
    bool nesterov = true;
    std::string precision = "float32";  ///< or "float64", of weights and of all that training computes

    ingest::Joints joints_seen() const {
        return joints == "common15" ? ingest::Joints::common15 : ingest::Joints::own;
    }
};

/// Every key at its preset, of an ST-GCN (`model: recogniser`) or a GRU classifier (`model: gru`).
Config recogniser_config(RecogniserKind kind = RecogniserKind::stgcn);

/// A configuration file's kind, by its line `model:`; stgcn where there is no such line or file, of which Config::load complains. Throws
/// Error for a line that names no recogniser.
RecogniserKind recogniser_kind_in(const std::filesystem::path& file);

RecogniserSettings recogniser_settings(const Config& config);

/// The network for a dataset of `persons` persons and `classes` classes. Throws Error where the configuration asks
/// for other numbers, naming `dataset`.
StgcnSettings stgcn_for(const RecogniserSettings& settings, ingest::Representation representation,
                        const ingest::Topology& topology, std::uint32_t persons, std::size_t classes,
                        const std::string& dataset);
GruSettings gru_for(const RecogniserSettings& settings, ingest::Representation representation,
                    const ingest::Topology& topology, std::uint32_t persons, std::size_t classes,
                    const std::string& dataset);

}  // namespace actformer::model
