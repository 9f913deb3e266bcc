#include "model/generators/csgn/generator.hpp"

#include <ATen/core/grad_mode.h>

#include "base/error.hpp"
#include "model/generators/csgn/sums.hpp"
#include "model/generators/finish.hpp"
#include "model/nn/conditional_norm.hpp"

namespace actformer::model {
namespace {

constexpr double linear = 1;  ///< as LeakyReLU's slope

/// Motions of a batch by which the EMA's running statistics are found, and the first draw of their latents: a training's never come
/// to it.
constexpr std::int64_t motions_a_batch = 64;
constexpr std::uint64_t first_draw = std::uint64_t{1} << 55U;

}  // namespace

CsgnGenerator::CsgnGenerator(CsgnSettings settings, std::uint64_t seed, at::ScalarType type)
    : settings_(checked(std::move(settings))),
      prior_(settings_.prior()),
      layers_(generator_layers(settings_)),
      weights_(*this, csgn_generator_weights(settings_), seed, type) {
    for (const auto& level : layers_.levels) sums_.push_back(registered_sums(*this, level, type));
    sums_.push_back(registered_sums(*this, layers_.last, type));
}

std::int64_t CsgnGenerator::latent_frames(std::int64_t frames) const {
    return model::latent_frames(static_cast<std::uint32_t>(frames));
}

/// x (N, nodes, 1 + F + 1, in) -> (N, finer nodes, 2F with zeros on either side as the next layer pads, out).
at::Tensor CsgnGenerator::level(const at::Tensor& x, const at::Tensor& labels, std::size_t i,
                                bool fused) const {
    const auto& layer = layers_.levels[i];
    const bool last = i + 1 == layers_.levels.size();
    const auto frames = x.size(2) - 2;
    const auto pairs = graph_convolution(x, weights_.at(layer.name + ".weight"), {},
                                         layer.shape(x.size(0), frames, 0), sums_[i], linear, fused);
    const auto doubled = pairs.reshape({x.size(0), pairs.size(1), 2 * (frames + 1), layer.out / 2});
    const auto norm = fmt::format("norm{}.", i);
    return conditional_norm(doubled,
                            {.gain = weights_.at(norm + "gain").index_select(0, labels),
                             .shift = weights_.at(norm + "shift").index_select(0, labels),
                             .mean = weights_.at(norm + "mean"),
                             .variance = weights_.at(norm + "variance"),
                             .momentum = momentum_,
                             .leak = leak,
                             .padding = 1,
                             .out_padding = last ? layers_.last.padding : layers_.levels[i + 1].padding},
                            is_training(), fused);
}

/// x (N, nodes, 2 + F + 2, in) -> (N, P*D, frames, K) out of the middle of F frames.
at::Tensor CsgnGenerator::motions(const at::Tensor& x, std::int64_t frames, bool fused) const {
    const auto& layer = layers_.last;
    const std::int64_t n = x.size(0), made = x.size(2) - 2 * layer.padding, persons = settings_.persons,
                       numbers = settings_.representation.numbers(), nodes = settings_.nodes();
    const auto bias = sums_.back().matrix.sum(2).t().matmul(weights_.at(layer.name + ".bias"));
    const auto raw = graph_convolution(x, weights_.at(layer.name + ".weight"), bias, layer.shape(n, made, 0),
                                       sums_.back(), linear, fused)
                         .slice(2, (made - frames) / 2, (made - frames) / 2 + frames)
                         .view({n, nodes, frames, persons, numbers})
                         .permute({0, 3, 2, 1, 4});  // (N, P, T, K, D)
    return motion_layout(bounded_finish(raw, settings_.representation));
}

at::Tensor CsgnGenerator::generate(const at::Tensor& latent, const at::Tensor& labels, std::int64_t frames) {
    const auto n = latent.size(0);
    if (frames < 1 || latent.dim() != 4 || latent.size(1) != 1 || latent.size(2) != latent_frames(frames) ||
        latent.size(3) != settings_.latent || labels.dim() != 1 || labels.size(0) != n)
        throw Error("the generator takes latents (N, 1, {}, {}) for {} frames, and N labels",
                    latent_frames(frames), settings_.latent, frames);
    const bool fused = takes_fused_path(latent);
    auto x = at::constant_pad_nd(latent, {0, 0, 1, 1});
    for (std::size_t i = 0; i < layers_.levels.size(); ++i) x = level(x, labels, i, fused);
    return motions(x, frames, fused);
}

void CsgnGenerator::recompute_buffers(const Prior& prior, const at::Tensor& labels, std::int64_t frames) {
    const at::NoGradGuard no_gradients;
    const bool training = is_training();
    const double momentum = momentum_;
    const auto device = parameters().front().device();
    train();
    std::uint64_t batches = 0;
    for (const auto& batch : labels.split(motions_a_batch)) {
        const auto latent = prior.draw(first_draw + batches, batch.size(0), latent_frames(frames));
        momentum_ = 1 / static_cast<double>(++batches);  // of equal weight all
        generate(latent.to(device), batch.to(device), frames);
    }
    momentum_ = momentum;
    train(training);
}

}  // namespace actformer::model
