#include "model/generators/actformer/discriminator.hpp"

#include "base/error.hpp"
#include "model/generators/graph/motion_input.hpp"
#include "model/generators/graph/node_convolution.hpp"
#include "model/nn/self_attention.hpp"

namespace actformer::model {
namespace {

constexpr std::int64_t person_heads = 8, last_padding = 1;

ActFormerDiscriminatorSettings checked(ActFormerDiscriminatorSettings settings) {
    check(settings);
    return settings;
}

}  // namespace

ActFormerDiscriminator::ActFormerDiscriminator(ActFormerDiscriminatorSettings settings, std::uint64_t seed,
                                               at::ScalarType type)
    : settings_(checked(std::move(settings))),
      weights_(*this, actformer_discriminator_weights(settings_), seed, type),
      convolutions_(node_convolutions(settings_)) {
    if (settings_.joint_gain > 0) joints_.emplace(settings_.motions);
    for (const auto& conv : convolutions_) {
        auto values = conv.sums.values;
        const auto sums =
            at::from_blob(values.data(), {conv.sums.hops, conv.sums.outputs, conv.sums.inputs}, at::kFloat);
        sums_.push_back(register_buffer(fmt::format("sums{}", sums_.size()), sums.to(type, false, true)));
        node_sums_.push_back(std::make_shared<cpu::NodeSums>(conv.sums.hops, conv.sums.outputs,
                                                             conv.sums.inputs, conv.sums.values));
    }
    const auto coarse = convolutions_.back().sums.outputs;
    node_sums_.push_back(std::make_shared<cpu::NodeSums>(1, 1, coarse, std::vector<float>(coarse, 1)));
}

/// x (K, N, T, C) -> (output nodes, N, T', out): the nodes' own convolutions as matrix products, one a node, then the sums into output
/// nodes. (cuDNN launches a kernel a group for each of a grouped convolution's passes.)
at::Tensor ActFormerDiscriminator::convolved(const at::Tensor& x, std::size_t i) const {
    const auto& conv = convolutions_[i];
    const auto name = fmt::format("convs.{}.", i);
    const auto windows =
        under_taps(at::constant_pad_nd(x, {0, 0, conv.padding, conv.padding}), conv.taps, conv.stride);
    const std::int64_t nodes = x.size(0), n = x.size(1), t = windows.size(2), hops = conv.sums.hops,
                       outputs = conv.sums.outputs;
    const auto rows = windows.flatten(1, 2);  // (K, N * T', taps * C)
    const auto weight = weights_.normalised(name + "weight", is_training())
                            .view({nodes, hops * conv.out, rows.size(2)})
                            .transpose(1, 2);
    const auto y =
        conv.bias ? at::baddbmm(weights_.at(name + "bias").view({nodes, 1, hops * conv.out}), rows, weight)
                  : at::bmm(rows, weight);
    const auto by_hop =
        y.view({nodes, n * t, hops, conv.out}).permute({2, 0, 1, 3}).reshape({hops * nodes, -1});
    const auto sums = sums_[i].transpose(0, 1).reshape({outputs, hops * nodes});
    return at::leaky_relu(at::mm(sums, by_hop).view({outputs, n, t, conv.out}), leak);
}

/// Motions (N, C, T, K) with their differences over frames behind their channels, and behind those their joints' velocities, 0 in the
/// first frame and at nodes of no joint; each times its gain.
at::Tensor ActFormerDiscriminator::seen(const at::Tensor& motion) const {
    std::vector<at::Tensor> all{settings_.pose_gain == 1 ? motion : motion * settings_.pose_gain};
    auto moved = motion;
    for (std::int64_t i = 1; i <= settings_.differences; ++i)
        all.push_back(moved = difference(moved, settings_.difference_gain, i));
    if (joints_) {
        const auto velocities = difference(joints_->of(motion), settings_.joint_gain);
        all.push_back(at::constant_pad_nd(velocities, {0, motion.size(3) - velocities.size(3)}));
    }
    return at::cat(all, 1);
}

/// (N, features) of motions (N, C, T, K).
at::Tensor ActFormerDiscriminator::features(const at::Tensor& motion) const {
    if (takes_fused_path(motion)) return fused_features(motion);
    auto x = seen(motion).permute({3, 0, 2, 1});
    for (std::size_t i = 0; i < convolutions_.size(); ++i) x = convolved(x, i);
    const auto last = weights_.normalised("last.weight", is_training()).permute({0, 3, 1, 2});
    x = at::conv2d(x.permute({1, 3, 0, 2}), last, weights_.at("last.bias"), at::IntArrayRef{1, 2},
                   at::IntArrayRef{0, last_padding});
    return at::leaky_relu(x, leak).sum({2, 3});
}

/// What the biases of the groups add up to at each output node, (outputs, out); undefined without biases.
at::Tensor ActFormerDiscriminator::node_bias(std::size_t i) const {
    const auto& conv = convolutions_[i];
    if (!conv.bias) return {};
    const std::int64_t outputs = conv.sums.outputs, groups = std::int64_t{conv.sums.inputs} * conv.sums.hops;
    return sums_[i]
        .permute({1, 2, 0})
        .reshape({outputs, groups})
        .matmul(weights_.at(fmt::format("convs.{}.bias", i)).view({groups, conv.out}));
}

at::Tensor ActFormerDiscriminator::fused_features(const at::Tensor& motion) const {
    const bool as_published = settings_.differences == 1 && settings_.pose_gain == 1 &&
                              settings_.difference_gain == 1 && settings_.joint_gain == 0;
    auto x = as_published ? fused_motion_input(motion.contiguous(), convolutions_[0].padding)
                          : node_input(seen(motion), convolutions_[0].padding);
    std::int64_t frames = motion.size(2);
    for (std::size_t i = 0; i < convolutions_.size(); ++i) {
        const auto& conv = convolutions_[i];
        const bool last = i + 1 == convolutions_.size();
        const auto shape = cpu::NodeShape{.samples = x.size(0),
                                          .frames = frames,
                                          .in_nodes = conv.sums.inputs,
                                          .out_nodes = conv.sums.outputs,
                                          .in = conv.in,
                                          .out = conv.out,
                                          .taps = conv.taps,
                                          .stride = conv.stride,
                                          .padding = conv.padding,
                                          .out_padding = last ? last_padding : convolutions_[i + 1].padding}
                               .with_weights_by_node(conv.sums.hops);
        x = fused_node_convolution(x, weights_.normalised(fmt::format("convs.{}.weight", i), is_training()),
                                   node_bias(i), shape, node_sums_[i], leak);
        frames = shape.out_frames();
    }
    const std::int64_t features = settings_.features();
    const auto shape = cpu::NodeShape{.samples = x.size(0),
                                      .frames = frames,
                                      .in_nodes = convolutions_.back().sums.outputs,
                                      .out_nodes = 1,
                                      .in = features / 2,
                                      .out = features,
                                      .taps = last_taps,
                                      .stride = 2,
                                      .padding = last_padding}
                           .with_weights_by_output();
    x = fused_node_convolution(x, weights_.normalised("last.weight", is_training()),
                               weights_.at("last.bias").view({1, features}), shape, node_sums_.back(), leak);
    return x.sum({1, 2});
}

/// (N, P, features) -> (N, features)
at::Tensor ActFormerDiscriminator::pooled(const at::Tensor& features) const {
    if (settings_.persons_in == PersonsInD::avgpool) return features.mean(1);
    if (settings_.persons_in == PersonsInD::maxpool) return features.amax({1});
    const auto interaction = self_attention(features, weights_.layer("persons.qkv", is_training()),
                                            weights_.layer("persons.proj", is_training()), person_heads);
    return (features + interaction).mean(1);
}

at::Tensor ActFormerDiscriminator::forward(const at::Tensor& motion, const at::Tensor& labels) {
    const std::int64_t persons = settings_.persons, numbers = settings_.numbers, nodes = settings_.nodes();
    if (motion.dim() != 4 || motion.size(1) != persons * numbers || motion.size(3) != nodes ||
        labels.dim() != 1 || labels.size(0) != motion.size(0))
        throw Error("the discriminator takes motions (N, {}, T, {}) and N labels", persons * numbers, nodes);
    const auto n = motion.size(0), t = motion.size(2);
    if (t < fewest_frames)
        throw Error("{} frames: the discriminator halves them four times and needs at least {}", t,
                    fewest_frames);
    const auto found =
        settings_.persons_in == PersonsInD::concat
            ? features(motion)
            : pooled(features(motion.reshape({n * persons, numbers, t, nodes})).view({n, persons, -1}));
    const auto classes = weights_.normalised("classes.weight", is_training()).index_select(0, labels);
    return weights_.linear(found, "score", is_training()).squeeze(1) + (classes * found).sum(1);
}

}  // namespace actformer::model
