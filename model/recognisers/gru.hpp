// Action2Motion's GRU classifier (Guo et al., ACM Multimedia 2020) as training sees it. The network itself is eval/gru/weights.hpp's.
#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "eval/gru/weights.hpp"
#include "ingest/dataset/topology.hpp"
#include "model/nn/array.hpp"
#include "model/nn/network.hpp"

namespace actformer::model {

struct GruSettings {
    std::uint32_t channels = 3;  ///< numbers of a node, those of all persons together
    std::uint32_t classes = 0;
    std::vector<int> parents;  ///< of the nodes, -1 for the root
    ingest::Representation representation = {};

    std::uint32_t nodes() const { return static_cast<std::uint32_t>(parents.size()); }
    eval::GruNetwork network() const { return {channels * nodes(), 128, 30, classes}; }
};

/// Every weight, in the order of the public state_dict's layers.
std::vector<NetworkWeight> gru_weights(const GruSettings& settings);

/// Lines for `actformer model`; shapes are of one motion of `frames` frames.
std::vector<SummaryLine> gru_summary(const GruSettings& settings, std::uint32_t frames);

/// As save_stgcn_weights of stgcn_file.hpp, with the attributes kind ("gru"), representation, channels, classes, class_names and parents.
void save_gru_weights(const std::filesystem::path& path, const GruSettings& settings,
                      const std::vector<Array>& arrays, const std::map<std::string, std::string>& notes,
                      const std::vector<std::string>& class_names);

}  // namespace actformer::model
