// The ST-GCN recogniser as training sees it: its settings, how its weights start, its summary. The network itself is
// eval/stgcn/network.hpp's.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "eval/stgcn/network.hpp"
#include "ingest/dataset/representation.hpp"
#include "model/nn/network.hpp"

namespace actformer::model {

struct StgcnSettings {
    std::uint32_t channels = 3;  ///< numbers of a node, those of all persons together
    std::uint32_t classes = 0;
    eval::Graph graph;
    double width =
        1;  ///< times the public layers' 64, 128 and 256 channels, to the nearest 16: whole vectors
    double dropout = 0.5;  ///< behind every temporal convolution
    ingest::Representation representation = {};

    bool operator==(const StgcnSettings&) const = default;
};

eval::StgcnShape shape_of(const StgcnSettings& settings);

/// Every weight, in the order of the public state_dict's layers.
std::vector<NetworkWeight> stgcn_weights(const StgcnSettings& settings);

/// Lines for `actformer model`; shapes are of one motion of `frames` frames.
std::vector<SummaryLine> stgcn_summary(const StgcnSettings& settings, std::uint32_t frames);

/// Throws Error where the settings describe no network.
void check(const StgcnSettings& settings);

}  // namespace actformer::model
