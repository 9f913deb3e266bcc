// The ST-GCN's weights as a file holds them: HDF5, float32 datasets named as in the public state_dict, and attributes
// `channels`, `classes`, `parents`, `center`, and where they are known `kind` ("stgcn"),
// `representation` and `class_names`.
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "eval/stgcn/network.hpp"
#include "ingest/dataset/representation.hpp"

namespace actformer::eval {

/// A network of any width with its tensors.
struct StgcnWeights : StgcnShape {
    std::string source;                     ///< the file, for messages
    ingest::Representation representation;  ///< of the motions; limbs where the file has no such attribute
    std::vector<std::string> class_names;   ///< (classes), or empty where the file does not tell
    std::map<std::string, std::vector<float>> tensors;

    const std::vector<float>& at(const std::string& name) const { return tensors.at(name); }
};

/// Throws Error, one line naming the file and the tensor or attribute, for what is missing, unknown, of another shape, not
/// finite, or no variance; for parents that are no tree, and a centre outside it.
StgcnWeights read_stgcn_weights(const std::filesystem::path& path);

/// Throws Error where the file cannot be written.
void write_stgcn_weights(const std::filesystem::path& path, const StgcnWeights& weights);

/// Well-conditioned random weights, for benchmarks and tests: `width` times the public network's channels, and the same seed
/// gives the same weights.
StgcnWeights random_stgcn_weights(std::uint32_t channels, std::uint32_t classes, const Graph& graph,
                                  double width, std::uint32_t seed);

}  // namespace actformer::eval
