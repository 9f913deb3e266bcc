// What a recogniser's configuration may say.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "ingest/dataset/topology.hpp"
#include "model/recognisers/stgcn.hpp"
#include "model/train/config.hpp"

namespace actformer::model {

/// Every key with the public tools' values (DESIGN 4.7).
Config recogniser_config();

struct RecogniserSettings {
    std::string data, train_split, test_split;  ///< test_split may be empty: nothing is scored then
    std::uint32_t persons = 0, classes = 0;     ///< 0: as the dataset has them
    double width = 1, dropout = 0.5;
    std::uint32_t frames = 60, batch = 64, epochs = 80;
    double rate = 0.1, rate_factor = 0.1;
    std::vector<std::int64_t>
        rate_drops;  ///< epochs, from 0, at whose start the rate is multiplied by rate_factor
    double momentum = 0.9, weight_decay = 1e-4;
    bool nesterov = true;
    std::uint64_t seed = 0;
    std::string precision = "float32";  ///< or "float64", of weights and of all that training computes
    std::string device,
        opencl;       ///< of libtorch, as in "cpu" or "cuda:0"; of the sampler, as --device elsewhere
    int threads = 0;  ///< 0: as many as the process may use

    double rate_at(std::uint64_t epoch) const;
};

RecogniserSettings recogniser_settings(const Config& config);

/// Keys that may change when a training goes on: where it runs, and how long.
const std::vector<std::string>& keys_free_to_change();

/// The network for a dataset of `persons` persons and `classes` classes. Throws Error where the configuration asks
/// for other numbers, naming `dataset`.
StgcnSettings network_for(const RecogniserSettings& settings, const ingest::Topology& topology,
                          std::uint32_t persons, std::size_t classes, const std::string& dataset);

}  // namespace actformer::model
