#include "model/generators/actformer/generator.hpp"

#include <ATen/core/grad_mode.h>

#include <cmath>

#include "base/error.hpp"
#include "model/generators/finish.hpp"
#include "model/generators/graph/node_convolution.hpp"
#include "model/nn/self_attention.hpp"

namespace actformer::model {
namespace {

constexpr double norm_epsilon = 1e-6;

at::Tensor tensor_of(const HopMatrix& matrix, at::ScalarType type) {
    auto values = matrix.values;
    return at::from_blob(values.data(), {matrix.hops, matrix.outputs, matrix.inputs}, at::kFloat)
        .to(type, false, true);
}

/// (T, T + 2 * beyond): for each of T frames a Gaussian of `deviation` frames, up to four deviations away, over them and the
/// `beyond` before and behind them.
at::Tensor gaussians(std::int64_t t, std::int64_t beyond, double deviation, const at::TensorOptions& as) {
    const auto frames = at::arange(t + 2 * beyond, as.requires_grad(false)) / deviation;
    const auto apart = (frames.unsqueeze(0) - frames.slice(0, beyond, beyond + t).unsqueeze(1)).square();
    return apart.mul(-0.5).exp() * apart.le(16);
}

/// Rows whose numbers add up to 1.
at::Tensor means(const at::Tensor& weights) {
    return weights / weights.sum(1, true);
}

ActFormerGeneratorSettings checked(ActFormerGeneratorSettings settings) {
    check(settings);
    return settings;
}

}  // namespace

ActFormerGenerator::ActFormerGenerator(ActFormerGeneratorSettings settings, std::uint64_t seed,
                                       at::ScalarType type)
    : settings_(checked(std::move(settings))),
      weights_(*this, actformer_generator_weights(settings_), seed, type) {
    if (settings_.body == Body::transformer) return;
    const auto levels = skeleton_levels(settings_.parents);
    to_middle_ = register_buffer("to_middle",
                                 tensor_of(transposed(hop_matrix(levels.middle, levels.coarse_kept)), type));
    to_fine_ =
        register_buffer("to_fine", tensor_of(transposed(hop_matrix(levels.fine, levels.middle_kept)), type));
    within_fine_ =
        register_buffer("within_fine", tensor_of(hop_matrix(levels.fine, all_nodes(levels.fine)), type));
}

/// (T+1, P, W) of the table.
at::Tensor ActFormerGenerator::positions() const {
    if (settings_.positions != Positions::concat || settings_.tokens_a_frame() == 1)
        return weights_.at("positions");
    const auto &frames = weights_.at("frame_positions"), &persons = weights_.at("person_positions");
    const auto t = frames.size(0), p = persons.size(0), half = frames.size(1);
    return at::cat({frames.unsqueeze(1).expand({t, p, half}), persons.unsqueeze(0).expand({t, p, half})}, 2);
}

/// Latents as tokens take them: where all persons share a token, so do their draws, side by side.
at::Tensor ActFormerGenerator::per_token(const at::Tensor& latent) const {
    if (settings_.interaction == Interaction::iformer) return latent.contiguous();
    return latent.permute({0, 2, 1, 3}).reshape({latent.size(0), 1, latent.size(2), -1}).contiguous();
}

/// (N, P, T+1, W): the class first, then the frames, each with its position.
at::Tensor ActFormerGenerator::tokens(const at::Tensor& latent, const at::Tensor& labels) const {
    const auto n = latent.size(0), t = latent.size(2), persons = std::int64_t{settings_.tokens_a_frame()};
    const auto frames = linear(per_token(latent), "input");
    const auto classes = weights_.at("classes.weight").index_select(0, labels).view({n, 1, 1, -1});
    const auto all = at::cat({classes.expand({n, frames.size(1), 1, settings_.width}), frames}, 2);
    const auto places = positions().slice(0, 0, t + 1).permute({1, 0, 2});
    return all.expand({n, persons, t + 1, settings_.width}) + places;
}

/// x (sequences, tokens, W).
at::Tensor ActFormerGenerator::block(const at::Tensor& x, const std::string& prefix) const {
    const auto norm = [&](const at::Tensor& v, const std::string& name) {
        return at::layer_norm(v, {settings_.width}, weights_.at(prefix + name + ".weight"),
                              weights_.at(prefix + name + ".bias"), norm_epsilon);
    };
    const auto y = x + self_attention(norm(x, "norm1"), weights_.layer(prefix + "qkv", is_training()),
                                      weights_.layer(prefix + "proj", is_training()), settings_.heads);
    return y + linear(at::gelu(linear(norm(y, "norm2"), prefix + "up")), prefix + "down");
}

at::Tensor ActFormerGenerator::transformed(at::Tensor x) const {
    const auto n = x.size(0), streams = x.size(1), tokens = x.size(2);
    const auto blocks = interacting_blocks(settings_);
    for (std::size_t i = 0; i < blocks.size(); ++i) {
        const auto prefix = fmt::format("blocks.{}.", i);
        if (blocks[i])
            x = block(x.transpose(1, 2).flatten(0, 1), prefix).view({n, tokens, streams, -1}).transpose(1, 2);
        else
            x = block(x.flatten(0, 1), prefix).view({n, streams, tokens, -1});
    }
    return x;
}

at::Tensor ActFormerGenerator::fused_tokens(const at::Tensor& latent, const at::Tensor& labels) const {
    const auto z = per_token(latent);
    return fused_embedding(z, weights_.layer("input", is_training()),
                           weights_.at("classes.weight").index_select(0, labels),
                           positions().slice(0, 0, z.size(2) + 1).contiguous());
}

at::Tensor ActFormerGenerator::fused_transformed(at::Tensor x) const {
    const auto blocks = interacting_blocks(settings_);
    for (std::size_t i = 0; i < blocks.size(); ++i) {
        const auto layer = [&](const char* name) {
            return weights_.layer(fmt::format("blocks.{}.{}", i, name), is_training());
        };
        if (at::GradMode::is_enabled()) {
            x = fused_attention(x, layer("norm1"), layer("qkv"), layer("proj"), settings_.heads, blocks[i]);
            x = fused_mlp(x, layer("norm2"), layer("up"), layer("down"));
        } else {
            fused_attention_in_place(x, layer("norm1"), layer("qkv"), layer("proj"), settings_.heads,
                                     blocks[i]);
            fused_mlp_in_place(x, layer("norm2"), layer("up"), layer("down"));
        }
    }
    return x;
}

/// x (N, S, T+1, W): every frame's token becomes its neighbours' mean, weighed by a Gaussian up to four deviations away. What
/// follows takes frames one by one, and can give no smoother motion than its tokens are. The class's token, the first, has been
/// of use before.
at::Tensor ActFormerGenerator::smoothed(const at::Tensor& x) const {
    if (settings_.smooth == 0) return x;
    const auto weights = gaussians(x.size(2), 0, settings_.smooth, x.options());
    weights.select(1, 0).zero_();
    return at::matmul(means(weights), x);
}

/// x (N, S, T+1, W), S the tokens a frame.
at::Tensor ActFormerGenerator::motion(const at::Tensor& x) const {
    if (takes_fused_path(x) && settings_.body == Body::transformer &&
        settings_.tokens_a_frame() == settings_.persons)
        return fused_poses(x, weights_.layer("norm", is_training()), weights_.layer("head", is_training()),
                           settings_.representation);
    const auto normal =
        at::layer_norm(x.slice(2, 1), {settings_.width}, weights_.normalised("norm.weight", is_training()),
                       weights_.at("norm.bias"), norm_epsilon);
    return motion_layout(bounded_finish(poses(normal), settings_.representation));
}

/// `motion` (N, P*D, T, K) with each body moved to where its neighbouring frames' mean is, weighed by a Gaussian. At either end the path
/// goes on as its point reflection, so that a straight one stays as it is.
at::Tensor ActFormerGenerator::with_smooth_root(const at::Tensor& motion) const {
    const auto t = motion.size(2);
    if (settings_.smooth_root == 0 || t < 2) return motion;
    const std::int64_t persons = settings_.persons, nodes = settings_.nodes();
    const auto moving = settings_.representation.moving(settings_.nodes());
    const auto bodies = motion.view({motion.size(0), persons, settings_.numbers(), t, nodes});
    const auto path = bodies.select(-1, moving.root);  // (N, P, D, T)
    const auto beyond = std::min(t - 1, static_cast<std::int64_t>(std::ceil(4 * settings_.smooth_root)));
    const auto before = 2 * path.slice(-1, 0, 1) - path.slice(-1, 1, 1 + beyond).flip(-1);
    const auto behind = 2 * path.slice(-1, t - 1) - path.slice(-1, t - 1 - beyond, t - 1).flip(-1);
    const auto weights = means(gaussians(t, beyond, settings_.smooth_root, path.options()));
    const auto moved = at::matmul(at::cat({before, path, behind}, -1), weights.t()) - path;
    const std::int64_t first = moving.first, count = moving.count;
    const auto of_all = at::constant_pad_nd(moved.unsqueeze(-1).expand({-1, -1, -1, -1, count}),
                                            {first, nodes - first - count});
    return (bodies + of_all).view(motion.sizes());
}

/// x (N, T, nodes, in): every hop's linear map, then the fixed sums over nodes. Spectral norms and sums make numbers smaller layer
/// by layer, until biases are all that is left: each node's are brought back to deviation 1.
at::Tensor ActFormerGenerator::graph_layer(const at::Tensor& x, const std::string& name,
                                           const at::Tensor& sums) const {
    const auto n = x.size(0), t = x.size(1), nodes = x.size(2);
    const auto mapped =
        linear(x, name).view({n, t, nodes, 2, -1}).transpose(2, 3);  // (N, T, hops, nodes, out)
    const auto y = at::leaky_relu(at::matmul(sums, mapped).sum(2), leak);
    return at::layer_norm(y, {y.size(-1)}, {}, {}, norm_epsilon);
}

/// x (N, S, T, W), S the tokens a frame -> (N, P, T, K, D).
at::Tensor ActFormerGenerator::poses(const at::Tensor& x) const {
    const auto n = x.size(0), streams = x.size(1), t = x.size(2), parting = settings_.persons / streams;
    const std::int64_t nodes = settings_.nodes(), numbers = settings_.numbers();
    const auto part = [&](const at::Tensor& v, std::int64_t of_each) {  // persons out of the last axis
        return v.view({n, streams, t, parting, of_each, -1})
            .transpose(2, 3)
            .reshape({n, settings_.persons, t, of_each, -1});
    };
    if (settings_.body == Body::transformer) return part(linear(x, "head"), nodes);
    const auto coarse = part(linear(x, "to_graph"), to_middle_.size(2));
    auto y = coarse.flatten(0, 1);
    y = graph_layer(y, "up1", to_middle_);
    y = graph_layer(y, "up2", to_fine_);
    y = graph_layer(y, "graph", within_fine_);
    const auto head = weights_.layer("head", is_training());
    const auto each = head.weight.view({nodes, numbers, -1}).transpose(1, 2);  // (K, fine, D)
    const auto raw = at::matmul(y.unsqueeze(-2), each).squeeze(-2) + head.bias.view({nodes, numbers});
    return raw.view({n, settings_.persons, t, nodes, numbers});
}

/// The EMA's singular vectors are close to those of the last weights: a few power iterations from there find them.
void ActFormerGenerator::recompute_buffers(const Prior& /*prior*/, const at::Tensor& /*labels*/,
                                           std::int64_t /*frames*/) {
    for (const auto& weight : actformer_generator_weights(settings_))
        for (int i = 0; weight.spectral && i < 10; ++i) weights_.normalised(weight.name, true);
}

at::Tensor ActFormerGenerator::forward(const at::Tensor& latent, const at::Tensor& labels) {
    const auto n = latent.size(0), t = latent.size(2);
    if (latent.dim() != 4 || latent.size(1) != settings_.prior.streams ||
        latent.size(3) != settings_.prior.channels || t < 1 || labels.dim() != 1 || labels.size(0) != n)
        throw Error("the generator takes latents (N, {}, T, {}) and N labels", settings_.prior.streams,
                    settings_.prior.channels);
    if (t > settings_.frames)
        throw Error("{} frames: the generator was made for at most {}", t, settings_.frames);
    return with_smooth_root(
        motion(smoothed(takes_fused_path(latent) ? fused_transformed(fused_tokens(latent, labels))
                                                 : transformed(tokens(latent, labels)))));
}

}  // namespace actformer::model
