// Action2Motion's GRU classifier (Guo et al., ACM Multimedia 2020) as a file holds it: HDF5, float32 datasets named as in the public
// state_dict (recurrent.weight_ih_l0, ..., linear1.weight, linear2.bias), and attributes `kind` ("gru"), `channels`, `classes`, `parents`,
// and where they are known `representation` and `class_names`.
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "eval/weights_reader.hpp"

namespace actformer::eval {

/// Two layers of GRU cells over the frames; the last frame's state through a dense layer and tanh gives the features, through another
/// the logits.
struct GruNetwork {
    std::uint32_t inputs = 0;  ///< numbers of a pose, node by node, a node's channels side by side
    std::uint32_t hidden = 128, features = 30, classes = 0;
};

constexpr std::size_t gru_layers = 2;

/// What decides the range that a weight starts in: one over the root of `fan_in`.
struct GruTensor {
    std::string name;
    TensorShape shape;
    std::uint64_t fan_in = 0;

    std::uint64_t count() const;
};

/// Every tensor in the order of the public state_dict. Gates lie in the order r, z, n.
std::vector<GruTensor> gru_tensors(const GruNetwork& network);

struct GruFile : RecogniserAttributes {
    std::string source;  ///< the file, for messages
    GruNetwork network;
    std::map<std::string, std::vector<float>> tensors;

    const std::vector<float>& at(const std::string& name) const { return tensors.at(name); }
};

/// Throws Error, one line naming the file and the tensor or attribute, for what is missing, unknown, of another shape, or not finite.
GruFile read_gru_weights(const std::filesystem::path& path);

}  // namespace actformer::eval
