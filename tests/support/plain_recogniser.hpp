// The recogniser's forward pass written out plainly in double.
#pragma once

#include <cmath>

#include "eval/stgcn/graph.hpp"
#include "eval/stgcn/weights.hpp"

namespace actformer::test {

/// A 21-joint tree with the root as centre, joints out of order.
inline const std::vector<int> small_tree{-1, 0, 1,  2,  3,  0, 5,  6,  7,  0, 9,
                                         12, 9, 11, 13, 14, 9, 16, 17, 20, 18};

struct PlainResult {
    std::vector<double> features, logits;
};

/// One motion (channels, frames, K) by the definition: every sum written out, batch norms where they stand.
class PlainRecogniser {
  public:
    explicit PlainRecogniser(const eval::StgcnWeights& weights)
        : w_(weights), parts_(eval::partition(weights.graph)) {}

    PlainResult operator()(const float* motion, std::size_t frames) const {
        const std::size_t joints = w_.joints(), channels = w_.channels;
        std::vector<double> x(channels * frames * joints);
        for (std::size_t c = 0; c < channels; ++c)
            for (std::size_t t = 0; t < frames; ++t)
                for (std::size_t k = 0; k < joints; ++k)
                    x[(c * frames + t) * joints + k] =
                        norm("data_bn.", k * channels + c)(motion[(c * frames + t) * joints + k]);
        for (std::size_t i = 0; i < eval::stgcn_layers; ++i) x = layer(i, x, frames);
        PlainResult out;
        const std::size_t features = w_.features(), all = x.size() / features;
        for (std::size_t c = 0; c < features; ++c) {
            double sum = 0;
            for (std::size_t j = 0; j < all; ++j) sum += x[c * all + j];
            out.features.push_back(sum / static_cast<double>(all));
        }
        for (std::size_t o = 0; o < w_.classes; ++o) {
            double sum = w_.at("fcn.bias")[o];
            for (std::size_t c = 0; c < features; ++c)
                sum += w_.at("fcn.weight")[o * features + c] * out.features[c];
            out.logits.push_back(sum);
        }
        return out;
    }

  private:
    /// A batch norm of one channel.
    struct Norm {
        double mean, deviation, weight, bias;
        double operator()(double x) const { return (x - mean) / deviation * weight + bias; }
    };
    Norm norm(const std::string& name, std::size_t c) const {
        return {w_.at(name + "running_mean")[c], std::sqrt(w_.at(name + "running_var")[c] + 1e-5),
                w_.at(name + "weight")[c], w_.at(name + "bias")[c]};
    }

    /// (in, frames, K) to (out, frames after the stride, K); changes `frames`.
    std::vector<double> layer(std::size_t i, const std::vector<double>& x, std::size_t& frames) const {
        const auto prefix = eval::layer_prefix(i);
        const std::size_t joints = w_.joints(), in = eval::stgcn_layer(w_, i).in, out = w_.widths[i];
        const std::size_t stride = i == 4 || i == 7 ? 2 : 1, after = (frames - 1) / stride + 1,
                          plane = frames * joints;
        const auto &conv = w_.at(prefix + "gcn.conv.weight"), &conv_bias = w_.at(prefix + "gcn.conv.bias");
        const auto& importance = w_.at("edge_importance." + std::to_string(i));

        std::vector<double> y(out * plane, 0.0);
        for (std::size_t part = 0; part < 3; ++part)
            for (std::size_t o = 0; o < out; ++o) {
                std::vector<double> z(plane, conv_bias[part * out + o]);
                for (std::size_t c = 0; c < in; ++c)
                    for (std::size_t j = 0; j < plane; ++j)
                        z[j] += conv[(part * out + o) * in + c] * x[c * plane + j];
                for (std::size_t v = 0; v < joints; ++v)
                    for (std::size_t w = 0; w < joints; ++w) {
                        const double a =
                            parts_[part][v * joints + w] * importance[(part * joints + v) * joints + w];
                        if (a == 0) continue;
                        for (std::size_t t = 0; t < frames; ++t)
                            y[o * plane + t * joints + w] += a * z[t * joints + v];
                    }
            }
        for (std::size_t o = 0; o < out; ++o) {
            const auto normed = norm(prefix + "tcn.0.", o);
            for (std::size_t j = 0; j < plane; ++j)
                y[o * plane + j] = std::max(0.0, normed(y[o * plane + j]));
        }

        std::vector<double> result(out * after * joints);
        for (std::size_t o = 0; o < out; ++o) {
            const auto sums = convolved(i, y, frames, o, stride), skip = residual(i, x, frames, o, stride);
            const auto normed = norm(prefix + "tcn.3.", o);
            for (std::size_t j = 0; j < after * joints; ++j)
                result[o * after * joints + j] = std::max(0.0, normed(sums[j]) + skip[j]);
        }
        frames = after;
        return result;
    }

    /// Nine frames about every `stride`-th one, for channel `o`: (frames after the stride, K).
    std::vector<double> convolved(std::size_t i, const std::vector<double>& y, std::size_t frames,
                                  std::size_t o, std::size_t stride) const {
        const auto prefix = eval::layer_prefix(i);
        const auto& weight = w_.at(prefix + "tcn.2.weight");
        const std::size_t out = w_.widths[i], joints = w_.joints(), after = (frames - 1) / stride + 1;
        std::vector<double> sums(after * joints, w_.at(prefix + "tcn.2.bias")[o]);
        for (std::size_t c = 0; c < out; ++c)
            for (std::size_t r = 0; r < 9; ++r) {
                const double w = weight[(o * out + c) * 9 + r];
                for (std::size_t t = 0; t < after; ++t) {
                    const auto at = t * stride + r;  // 4 frames before the first are zeros
                    if (at < 4 || at - 4 >= frames) continue;
                    const double* from = &y[(c * frames + at - 4) * joints];
                    for (std::size_t k = 0; k < joints; ++k) sums[t * joints + k] += w * from[k];
                }
            }
        return sums;
    }

    /// Channel `o` of the shortcut: nothing in the first layer, a convolution where the weights have one, else the input.
    std::vector<double> residual(std::size_t i, const std::vector<double>& x, std::size_t frames,
                                 std::size_t o, std::size_t stride) const {
        const auto name = eval::layer_prefix(i) + "residual.";
        const std::size_t in = eval::stgcn_layer(w_, i).in, joints = w_.joints(),
                          after = (frames - 1) / stride + 1;
        std::vector<double> out(after * joints, 0.0);
        if (i == 0) return out;
        const bool mapped = w_.tensors.contains(name + "0.weight");
        for (std::size_t c = mapped ? 0 : o; c < (mapped ? in : o + 1); ++c) {
            const double w = mapped ? w_.at(name + "0.weight")[o * in + c] : 1.0;
            for (std::size_t t = 0; t < after; ++t)
                for (std::size_t k = 0; k < joints; ++k)
                    out[t * joints + k] += w * x[(c * frames + t * stride) * joints + k];
        }
        if (!mapped) return out;
        const auto normed = norm(name + "1.", o);
        for (auto& value : out) value = normed(value + w_.at(name + "0.bias")[o]);
        return out;
    }

    const eval::StgcnWeights& w_;
    std::array<eval::Adjacency, 3> parts_;
};

}  // namespace actformer::test
