// How a graph convolution parts the neighbourhood of a joint: the spatial configuration of ST-GCN.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

namespace actformer::eval {

/// Dense (K, K), row the source v, column the joint w that gathers.
using Adjacency = std::vector<double>;

/// Three parts: the joint itself; neighbours as far from the centre as it or farther; neighbours closer. Columns are
/// normalised by degree. Distances from the centre are known up to one hop only and all beyond count as equal, as in the
/// public ST-GCN. `parents` must be a tree.
std::array<Adjacency, 3> partition(const std::vector<int>& parents, std::uint32_t center);

}  // namespace actformer::eval
