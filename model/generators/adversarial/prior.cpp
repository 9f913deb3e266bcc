#include "model/generators/adversarial/prior.hpp"

#include <ATen/Parallel.h>

#include "base/error.hpp"
#include "model/cpu/layer_clock.hpp"
#include "model/cpu/random_kernel.hpp"

namespace actformer::model {
namespace {

/// Added to the diagonal of covariances of rank far below their size, so that they have a factor in double.
constexpr double jitter = 1e-6;

constexpr std::uint8_t for_latents = 1;

at::Tensor exact_covariance(const PriorSettings& settings, std::int64_t channel, std::int64_t frames) {
    const double length = settings.length_scale * static_cast<double>(channel + 1) / settings.channels;
    const auto t = at::arange(frames, at::kDouble);
    return (-((t.unsqueeze(1) - t.unsqueeze(0)) / length).square()).exp();
}

at::Tensor triangular_root(const at::Tensor& covariance) {
    return at::linalg_cholesky(covariance + jitter * at::eye(covariance.size(0), at::kDouble));
}

at::Tensor symmetric_root(const at::Tensor& covariance) {
    const auto [values, vectors] = at::linalg_eigh(covariance);
    return (vectors * values.clamp_min(0).sqrt()).matmul(vectors.t());
}

}  // namespace

Prior::Prior(const PriorSettings& settings, std::uint64_t seed) : settings_(settings), seed_(seed) {}

at::Tensor Prior::covariance(const PriorSettings& settings, std::int64_t channel, std::int64_t frames) {
    return settings.kind == PriorKind::gp ? exact_covariance(settings, channel, frames)
                                          : at::ones({frames, frames}, at::kDouble);
}

at::Tensor Prior::factors(std::int64_t frames) const {
    const std::lock_guard lock(mutex_);
    auto& factors = factors_[frames];
    if (factors.defined()) return factors;
    const auto roots = at::empty({settings_.channels, frames, frames}, at::kFloat);
    for (std::int64_t c = 0; c < settings_.channels; ++c) {
        const auto covariance = exact_covariance(settings_, c, frames);
        roots[c].copy_(settings_.root == PriorRoot::symmetric ? symmetric_root(covariance)
                                                              : triangular_root(covariance));
    }
    return factors = roots.permute({1, 2, 0}).contiguous();
}

at::Tensor Prior::draw(std::uint64_t index, std::int64_t count, std::int64_t frames,
                       std::uint64_t first_sample) const {
    const LayerTimer timer("prior");
    const std::int64_t streams = settings_.streams, channels = settings_.channels;
    const bool gp = settings_.kind == PriorKind::gp;
    const auto drawn = gp ? frames : 1;
    auto normals = at::empty({count, streams, drawn, channels}, at::kFloat);
    cpu::normal_numbers({seed_, index, for_latents}, first_sample, count, streams * drawn * channels,
                        normals.data_ptr<float>(), at::get_num_threads());
    if (!gp) return normals.expand({count, streams, frames, channels}).contiguous();
    return correlated(normals);
}

at::Tensor Prior::correlated(const at::Tensor& normals) const {
    const auto frames = normals.size(2), channels = normals.size(3);
    const auto factors = this->factors(frames);
    auto latent = at::empty_like(normals);
    cpu::correlate(normals.data_ptr<float>(), factors.data_ptr<float>(), normals.size(0) * normals.size(1),
                   frames, channels, settings_.root == PriorRoot::triangular, latent.data_ptr<float>(),
                   at::get_num_threads());
    return latent;
}

}  // namespace actformer::model
