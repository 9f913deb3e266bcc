// A recogniser's weights with every batch norm folded into the convolution before it.
#pragma once

#include <vector>

#include "eval/stgcn/graph.hpp"
#include "eval/stgcn/weights.hpp"

namespace actformer::eval {

struct FoldedLayer {
    std::uint32_t in = 0, out = 0, stride = 1;
    std::array<Adjacency, 3> mixing;   ///< partition times edge importance, (K, K) each
    std::vector<double> graph_weight;  ///< (3, in, out)
    std::vector<double> graph_bias;    ///< (K, out): parts without neighbours give a joint less of the bias
    std::vector<double> temporal_weight;  ///< (in = out, out, 9)
    std::vector<double> temporal_bias;    ///< (out), with that of the residual's convolution
    std::vector<double> residual_weight;  ///< (in, out), or empty
    bool identity_residual = false;
};

struct FoldedNetwork {
    std::vector<double> scale, shift;  ///< (K, channels) on the input
    std::vector<FoldedLayer> layers;
};

FoldedNetwork fold(const StgcnWeights& weights);

}  // namespace actformer::eval
