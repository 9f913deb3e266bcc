// Recognisers with random weights, and their forward pass written out plainly in double.
#pragma once

#include <cmath>
#include <random>

#include "eval/partition.hpp"
#include "eval/weights.hpp"
#include "ingest/hdf5.hpp"

namespace actformer::test {

/// The edges that the recogniser uses on NTU's 25 joints; the centre is 20.
inline const std::vector<int> ntu_edges{-1, 0,  20, 2, 20, 4,  5,  6, 20, 8, 9,  10, 0,
                                        12, 13, 14, 0, 16, 17, 18, 1, 22, 7, 24, 11};

/// A 21-joint tree with the root as centre, joints out of order.
inline const std::vector<int> small_tree{-1, 0, 1,  2,  3,  0, 5,  6,  7,  0, 9,
                                         11, 9, 11, 13, 14, 9, 16, 17, 20, 18};

/// `width` scales the 64, 128 and 256 channels of the layers.
inline eval::Weights made_recogniser(std::uint32_t channels, std::uint32_t classes,
                                     const std::vector<int>& parents, std::uint32_t center, double width,
                                     unsigned seed) {
    eval::Weights w;
    w.source = "made";
    w.channels = channels;
    w.classes = classes;
    w.parents = parents;
    w.center = center;
    for (std::size_t i = 0; i < eval::stgcn_layers; ++i)
        w.widths[i] = static_cast<std::uint32_t>(std::lround(width * (i < 4 ? 64 : i < 7 ? 128 : 256)));
    std::mt19937 random(seed);
    std::normal_distribution<float> normal;
    std::uniform_real_distribution<float> uniform;
    for (const auto& [name, shape] : eval::tensor_shapes(w)) {
        std::size_t count = 1, fan_in = 1;
        for (std::size_t d = 0; d < shape.size(); ++d) count *= shape[d], fan_in *= d > 0 ? shape[d] : 1;
        std::vector<float> values(count);
        for (auto& v : values) {
            if (name.ends_with("running_var"))
                v = uniform(random) + 0.5F;
            else if (name.starts_with("edge_importance") || (name.ends_with(".weight") && shape.size() == 1))
                v = 1 + 0.1F * normal(random);
            else if (shape.size() == 1)
                v = 0.1F * normal(random);
            else
                v = normal(random) * std::sqrt(2.0F / static_cast<float>(fan_in));
        }
        w.tensors[name] = values;
    }
    return w;
}

inline void write_recogniser(const std::filesystem::path& path, const eval::Weights& w) {
    ingest::hdf5::Writer file(path);
    for (const auto& [name, shape] : eval::tensor_shapes(w))
        if (const auto at = w.tensors.find(name); at != w.tensors.end())
            file.write<float>(name, ingest::hdf5::Shape(shape.begin(), shape.end()), at->second);
    file.attribute("channels", static_cast<std::int64_t>(w.channels));
    file.attribute("classes", static_cast<std::int64_t>(w.classes));
    file.attribute("parents", std::vector<std::int64_t>(w.parents.begin(), w.parents.end()));
    file.attribute("center", static_cast<std::int64_t>(w.center));
    file.finish();
}

struct PlainResult {
    std::vector<double> features, logits;
};

/// One motion (channels, frames, K) by the definition: every sum written out, batch norms where they stand.
class PlainRecogniser {
  public:
    explicit PlainRecogniser(const eval::Weights& weights)
        : w_(weights), parts_(eval::partition(weights.parents, weights.center)) {}

    PlainResult operator()(const float* motion, std::size_t frames) const {
        const std::size_t joints = w_.joints(), channels = w_.channels;
        std::vector<double> x(channels * frames * joints);
        for (std::size_t c = 0; c < channels; ++c)
            for (std::size_t t = 0; t < frames; ++t)
                for (std::size_t k = 0; k < joints; ++k)
                    x[(c * frames + t) * joints + k] =
                        norm("data_bn.", k * channels + c, motion[(c * frames + t) * joints + k]);
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
    double norm(const std::string& name, std::size_t c, double x) const {
        return (x - w_.at(name + "running_mean")[c]) / std::sqrt(w_.at(name + "running_var")[c] + 1e-5) *
                   w_.at(name + "weight")[c] +
               w_.at(name + "bias")[c];
    }

    /// (in, frames, K) to (out, frames after the stride, K); changes `frames`.
    std::vector<double> layer(std::size_t i, const std::vector<double>& x, std::size_t& frames) const {
        const auto prefix = eval::layer_prefix(i);
        const std::size_t joints = w_.joints(), in = w_.width_before(i), out = w_.widths[i];
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
        for (std::size_t o = 0; o < out; ++o)
            for (std::size_t j = 0; j < plane; ++j)
                y[o * plane + j] = std::max(0.0, norm(prefix + "tcn.0.", o, y[o * plane + j]));

        std::vector<double> result(out * after * joints);
        for (std::size_t o = 0; o < out; ++o)
            for (std::size_t t = 0; t < after; ++t)
                for (std::size_t k = 0; k < joints; ++k) {
                    const double value =
                        norm(prefix + "tcn.3.", o, convolved(i, y, frames, o, t * stride, k));
                    result[(o * after + t) * joints + k] =
                        std::max(0.0, value + residual(i, x, frames, o, t * stride, k));
                }
        frames = after;
        return result;
    }

    double convolved(std::size_t i, const std::vector<double>& y, std::size_t frames, std::size_t o,
                     std::size_t t, std::size_t k) const {
        const auto prefix = eval::layer_prefix(i);
        const auto& weight = w_.at(prefix + "tcn.2.weight");
        const std::size_t out = w_.widths[i], joints = w_.joints();
        double sum = w_.at(prefix + "tcn.2.bias")[o];
        for (std::size_t r = 0; r < 9; ++r) {
            if (t + r < 4 || t + r - 4 >= frames) continue;
            for (std::size_t c = 0; c < out; ++c)
                sum += weight[(o * out + c) * 9 + r] * y[(c * frames + t + r - 4) * joints + k];
        }
        return sum;
    }

    double residual(std::size_t i, const std::vector<double>& x, std::size_t frames, std::size_t o,
                    std::size_t t, std::size_t k) const {
        const std::size_t in = w_.width_before(i), joints = w_.joints();
        if (i == 0) return 0;
        if (!w_.tensors.contains(eval::layer_prefix(i) + "residual.0.weight"))
            return x[(o * frames + t) * joints + k];
        const auto& weight = w_.at(eval::layer_prefix(i) + "residual.0.weight");
        double sum = w_.at(eval::layer_prefix(i) + "residual.0.bias")[o];
        for (std::size_t c = 0; c < in; ++c) sum += weight[o * in + c] * x[(c * frames + t) * joints + k];
        return norm(eval::layer_prefix(i) + "residual.1.", o, sum);
    }

    const eval::Weights& w_;
    std::array<eval::Adjacency, 3> parts_;
};

}  // namespace actformer::test
