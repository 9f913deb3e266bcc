// The recogniser's weights as the file holds them (DESIGN 3 and 4.8).
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <map>
#include <string>
#include <vector>

namespace actformer::eval {

constexpr std::size_t stgcn_layers = 10;
constexpr std::size_t stgcn_taps = 9;

/// Of every layer's temporal convolution.
constexpr std::array<std::uint32_t, stgcn_layers> stgcn_strides{1, 1, 1, 1, 2, 1, 1, 2, 1, 1};

/// Tensors of any width, named as in the public ST-GCN's state_dict.
struct Weights {
    std::string source;          ///< the file, for messages
    std::uint32_t channels = 0;  ///< of the input: 3 a person
    std::uint32_t classes = 0;
    std::vector<int> parents;  ///< (K) -1 for the root
    std::uint32_t center = 0;
    std::array<std::uint32_t, stgcn_layers> widths{};  ///< channels that each layer gives
    std::map<std::string, std::vector<float>> tensors;

    std::uint32_t joints() const { return static_cast<std::uint32_t>(parents.size()); }
    std::uint32_t features() const { return widths.back(); }
    std::uint32_t width_before(std::size_t layer) const { return layer == 0 ? channels : widths[layer - 1]; }

    /// Whether the layer's residual is a convolution of its own; else it is the layer's input, and none for layer 0.
    bool has_residual_convolution(std::size_t layer) const;

    const std::vector<float>& at(const std::string& name) const { return tensors.at(name); }
};

/// "st_gcn_networks.3."
std::string layer_prefix(std::size_t layer);

/// Names and shapes of all tensors that weights of these channels, classes, joints and widths have.
std::map<std::string, std::vector<std::uint64_t>> tensor_shapes(const Weights& weights);

/// Throws Error, one line naming the file and the tensor or attribute, for what is missing, unknown, of another shape, not
/// finite, or no variance; for parents that are no tree, and a centre outside it.
Weights read_weights(const std::filesystem::path& path);

/// The weights that `recogniser` stands for: of a training's folder the best ones, or the last where none was scored; a file
/// stands for itself.
std::filesystem::path weights_of(const std::filesystem::path& recogniser);

/// Throws Error where the file cannot be written.
void write_weights(const std::filesystem::path& path, const Weights& weights);

/// Well-conditioned random weights, for benchmarks and tests: the layers have 64, 128 and 256 channels times `width`, and
/// the same seed gives the same weights.
Weights random_weights(std::uint32_t channels, std::uint32_t classes, const std::vector<int>& parents,
                       std::uint32_t center, double width, std::uint32_t seed);

/// The edges of the recogniser on NTU's 25 joints, whose hands run tip, thumb, hand, unlike the limbs. The centre is 20.
extern const std::vector<int> ntu_edges;

}  // namespace actformer::eval
