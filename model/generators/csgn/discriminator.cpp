#include "model/generators/csgn/discriminator.hpp"

#include "base/error.hpp"
#include "model/generators/csgn/sums.hpp"
#include "model/generators/graph/motion_input.hpp"

namespace actformer::model {

CsgnDiscriminator::CsgnDiscriminator(CsgnSettings settings, std::uint64_t seed, at::ScalarType type)
    : settings_(checked(std::move(settings))),
      layers_(discriminator_layers(settings_)),
      weights_(*this, csgn_discriminator_weights(settings_), seed, type) {
    for (const auto& level : layers_.levels) sums_.push_back(registered_sums(*this, level, type));
    sums_.push_back(registered_sums(*this, layers_.last, type));
}

/// (N, features) of motions (N, C, T, K).
at::Tensor CsgnDiscriminator::features(const at::Tensor& motion) const {
    const bool fused = weights_.fused && motion.is_cpu();
    const auto weight = [&](const GraphConvolution& layer) {
        return weights_.normalised(layer.name + ".weight", is_training());
    };
    const auto n = motion.size(0);
    auto frames = motion.size(2);
    const std::int64_t padding = layers_.levels.front().padding;
    auto x = fused ? fused_motion_input(motion.contiguous(), padding)
                   : node_input(at::cat({motion, difference(motion)}, 1), padding);
    for (std::size_t i = 0; i < layers_.levels.size(); ++i) {
        const auto& level = layers_.levels[i];
        const auto& next = i + 1 < layers_.levels.size() ? layers_.levels[i + 1] : layers_.last;
        const auto shape = level.shape(n, frames, next.padding);
        const auto bias =
            i == 0 ? sums_[i].matrix.sum(2).t().matmul(weights_.at(level.name + ".bias")) : at::Tensor();
        x = graph_convolution(x, weight(level), bias, shape, sums_[i], leak, fused);
        frames = shape.out_frames();
    }
    return convolution_over_nodes(x, weight(layers_.last), weights_.at(layers_.last.name + ".bias"),
                                  layers_.last.shape(n, frames, 0), sums_.back(), leak, fused)
        .sum({1, 2});
}

at::Tensor CsgnDiscriminator::forward(const at::Tensor& motion, const at::Tensor& labels) {
    if (motion.dim() != 4 || motion.size(1) != settings_.channels() || motion.size(3) != settings_.nodes() ||
        labels.dim() != 1 || labels.size(0) != motion.size(0))
        throw Error("the discriminator takes motions (N, {}, T, {}) and N labels", settings_.channels(),
                    settings_.nodes());
    if (motion.size(2) < csgn_fewest_frames)
        throw Error("{} frames: the discriminator halves them four times and needs at least {}",
                    motion.size(2), csgn_fewest_frames);
    const auto found = features(motion);
    const auto classes = weights_.normalised("classes.weight", is_training()).index_select(0, labels);
    return weights_.linear(found, "score", is_training()).squeeze(1) + (classes * found).sum(1);
}

}  // namespace actformer::model
