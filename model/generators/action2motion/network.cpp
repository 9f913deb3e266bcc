#include "model/generators/action2motion/network.hpp"

#include <ATen/core/grad_mode.h>
#include <fmt/format.h>

#include "model/generators/action2motion/body.hpp"
#include "model/generators/action2motion/layers.hpp"
#include "model/nn/fused_gru.hpp"

namespace actformer::model::action2motion {
namespace {

constexpr double widest = 3.1415926;  ///< radians of a rotation about each axis, as published

at::Tensor drawn(const Distribution& from, const at::Tensor& noise) {
    return from.mean + noise * (0.5 * from.log_variance).exp();
}

/// (T) of distributions (T, N, latent).
at::Tensor divergence(const Distribution& posterior, const Distribution& prior) {
    const auto square = posterior.log_variance.exp() + (posterior.mean - prior.mean).square();
    const auto each =
        0.5 * (prior.log_variance - posterior.log_variance) + square / (2 * prior.log_variance.exp()) - 0.5;
    return each.sum({1, 2}) / each.size(1);
}

}  // namespace

/// A network's embedding and GRU cells on their way through the frames.
class Network::Stack {
  public:
    Stack(const Network& network, std::string name, int cells, const at::Tensor& poses)
        : network_(network),
          name_(std::move(name)),
          states_(static_cast<std::size_t>(cells),
                  at::zeros({poses.size(0), network.settings_.hidden}, poses.options())) {}

    at::Tensor step(const std::vector<at::Tensor>& inputs) {
        auto x = network_.linear(name_ + ".embed", at::cat(inputs, 1));
        for (std::size_t i = 0; i < states_.size(); ++i) {
            const auto of = [&](const char* weight) {
                return network_.weights_.at(fmt::format("{}.gru.{}.{}", name_, i, weight));
            };
            x = states_[i] =
                at::gru_cell(x, states_[i], of("weight_ih"), of("weight_hh"), of("bias_ih"), of("bias_hh"));
        }
        return x;
    }

  private:
    const Network& network_;
    std::string name_;
    std::vector<at::Tensor> states_;
};

Network::Network(Settings settings, std::uint64_t seed, at::ScalarType type)
    : settings_(std::move(settings)), weights_(*this, weights_of(settings_), seed, type) {
    if (settings_.body == Body::lie) chains_ = chains_of(settings_.topology.parents);
}

at::Tensor Network::linear(const std::string& name, const at::Tensor& x) const {
    return at::linear(x, weights_.at(name + ".weight"), weights_.at(name + ".bias"));
}

/// (N, classes and a time) in a frame.
at::Tensor Network::condition(const at::Tensor& labels, std::int64_t frame) const {
    const auto like = weights_.at("decoder.output.bias").options();
    const auto classes = at::one_hot(labels, settings_.classes).to(like);
    if (!settings_.time_counter) return classes;
    const double passed = static_cast<double>(frame) / (settings_.frames - 1);
    return at::cat({classes, at::full({labels.size(0), 1}, passed, like)}, 1);
}

/// What the decoder gives: a pose, or the root's position and rotations.
at::Tensor Network::headed(const at::Tensor& state) const {
    const auto out = linear("decoder.output", state);
    if (!chains_) return out;
    const auto angles = linear("decoder.output_lie", out.slice(-1, 3).tanh()).tanh() * widest;
    return at::cat({out.slice(-1, 0, 3), angles}, -1);
}

Distribution Network::distribution(const std::string& network, const at::Tensor& state) const {
    return {linear(network + ".mu_net", state), linear(network + ".logvar_net", state)};
}

Outcome Network::forward(const at::Tensor& real, const at::Tensor& labels, const at::Tensor& noise,
                         bool own) const {
    auto outcome = weights_.fused && real.is_cpu() ? all_at_once(real, labels, noise, own)
                                                   : frame_by_frame(real, labels, noise, own);
    outcome.reconstruction = (outcome.poses - real).square().mean({1, 2});
    outcome.divergence = divergence(outcome.posterior, outcome.prior);
    return outcome;
}

Outcome Network::frame_by_frame(const at::Tensor& real, const at::Tensor& labels, const at::Tensor& noise,
                                bool own) const {
    Stack prior(*this, "prior_net", 1, real[0]), posterior(*this, "posterior_net", 1, real[0]),
        decoder(*this, "decoder", 2, real[0]);
    std::vector<at::Tensor> outs, poses, posteriors, priors;
    auto seen = at::zeros_like(real[0]);
    const auto keep = [](std::vector<at::Tensor>& to, const Distribution& from) {
        to.push_back(at::stack({from.mean, from.log_variance}));
    };
    for (std::int64_t t = 0; t < real.size(0); ++t) {
        const auto truth = real[t], about = condition(labels, t);
        const auto found = distribution("posterior_net", posterior.step({truth, about}));
        keep(posteriors, found);
        keep(priors, distribution("prior_net", prior.step({seen, about})));
        const auto out = headed(decoder.step({seen, about, drawn(found, noise[t])}));
        // A real skeleton lends its bones, frame by frame.
        const auto pose = chains_ ? chain_kinematics(*chains_, out, bone_lengths(*chains_, truth)) : out;
        outs.push_back(out);
        poses.push_back(pose);
        seen = !own ? truth : settings_.feedback == Feedback::joints ? pose : out;
    }
    const auto joined = [](const std::vector<at::Tensor>& all) {
        const auto both = at::stack(all, 1);
        return Distribution{both[0], both[1]};
    };
    return {at::stack(outs), at::stack(poses), joined(posteriors), joined(priors), {}, {}};
}

/// A network's first cell behind its embedding, which has no activation: one linear map of all inputs to the gates.
class Network::Gates {
  public:
    Gates(const Network& network, const std::string& name) : settings_(network.settings_) {
        const auto of = [&](const char* weight) { return network.weights_.at(name + "." + weight); };
        const auto input = of("gru.0.weight_ih");
        weight_ = input.mm(of("embed.weight"));
        bias_ = input.mv(of("embed.bias")) + of("gru.0.bias_ih");
    }

    at::Tensor of_poses() const { return weight_.narrow(1, 0, settings_.numbers()); }
    at::Tensor of_latents() const { return weight_.narrow(1, settings_.inputs(), settings_.latent); }

    /// Gates of what is known of every motion and every frame, and of `products` where they are given.
    GruInputs inputs(const at::Tensor& labels, std::int64_t frames, at::Tensor products = {}) const {
        const auto classes = weight_.narrow(1, settings_.numbers(), settings_.classes).t();
        const auto of_sample = classes.index_select(0, labels) + bias_;
        auto of_frame = at::zeros({frames, bias_.size(0)}, bias_.options());
        if (settings_.time_counter) {
            const auto passed = at::arange(frames, bias_.options()) / (settings_.frames - 1.0);
            of_frame = at::outer(passed, weight_.select(1, settings_.inputs() - 1));
        }
        return {std::move(products), of_sample, of_frame};
    }

  private:
    const Settings& settings_;
    at::Tensor weight_, bias_;
};

std::vector<GruTensors> Network::cells(const std::string& network, int count) const {
    std::vector<GruTensors> all;
    for (int i = 0; i < count; ++i) {
        const auto of = [&](const char* weight) {
            return weights_.at(fmt::format("{}.gru.{}.{}", network, i, weight));
        };
        const LinearTensors hidden{of("weight_hh"), of("bias_hh")};
        all.push_back({i == 0 ? LinearTensors{} : LinearTensors{of("weight_ih"), of("bias_ih")}, hidden});
    }
    return all;
}

/// Of frames whose poses (T, N, D) are all known.
Distribution Network::distribution_of_all(const std::string& network, const at::Tensor& poses,
                                          const at::Tensor& labels) const {
    const Gates gates(*this, network);
    const auto products = at::matmul(poses, gates.of_poses().t());
    return distribution(network, fused_gru(gates.inputs(labels, poses.size(0), products), cells(network, 1)));
}

/// A Lie body's rotations; bones (T, N, joints).
ChainBodyTensors Network::chain_body(const at::Tensor& bones) const {
    if (!chains_) return {};
    return {{weights_.at("decoder.output_lie.weight"), weights_.at("decoder.output_lie.bias")},
            &*chains_,
            bones,
            settings_.feedback == Feedback::joints};
}

/// What the decoder makes of its own outputs, or of the poses before, `seen` (T, N, D).
std::pair<at::Tensor, at::Tensor> Network::decoded(const at::Tensor& real, const at::Tensor& seen,
                                                   const at::Tensor& labels, const at::Tensor& latents,
                                                   bool own) const {
    const Gates gates(*this, "decoder");
    const auto frames = latents.size(0), samples = latents.size(1);
    auto products = at::matmul(latents, gates.of_latents().t());
    if (!own) products = products + at::matmul(seen, gates.of_poses().t());
    const auto inputs = gates.inputs(labels, frames, products);
    const auto lengths = chains_ ? bone_lengths(*chains_, real.flatten(0, 1)) : at::Tensor();
    if (own) {
        const auto poses =
            fused_fed_back_poses(inputs, cells("decoder", 2), gates.of_poses(),
                                 {weights_.at("decoder.output.weight"), weights_.at("decoder.output.bias")},
                                 chain_body(chains_ ? lengths.view({frames, samples, -1}) : lengths));
        return {poses.out, chains_ ? poses.joints : poses.out};
    }
    const auto out = headed(fused_gru(inputs, cells("decoder", 2)));
    if (!chains_) return {out, out};
    return {out, fused_chain_kinematics(*chains_, out.flatten(0, 1), lengths).view_as(real)};
}

/// The posterior sees the truth alone, the prior what the decoder has seen: each goes through all frames at once.
Outcome Network::all_at_once(const at::Tensor& real, const at::Tensor& labels, const at::Tensor& noise,
                             bool own) const {
    const auto before = [](const at::Tensor& poses) {
        return at::cat({at::zeros_like(poses.narrow(0, 0, 1)), poses.narrow(0, 0, poses.size(0) - 1)});
    };
    const auto posterior = distribution_of_all("posterior_net", real, labels);
    auto seen = own ? at::Tensor() : before(real);
    const auto [out, poses] = decoded(real, seen, labels, drawn(posterior, noise), own);
    if (own) seen = before(settings_.feedback == Feedback::joints ? poses : out);
    return {out, poses, posterior, distribution_of_all("prior_net", seen, labels), {}, {}};
}

at::Tensor Network::generate(const at::Tensor& labels, const at::Tensor& noise,
                             const at::Tensor& bones) const {
    const at::NoGradGuard no_gradients;
    return weights_.fused && noise.is_cpu() ? generate_at_once(labels, noise, bones)
                                            : generate_frame_by_frame(labels, noise, bones);
}

at::Tensor Network::generate_at_once(const at::Tensor& labels, const at::Tensor& noise,
                                     const at::Tensor& bones) const {
    const Gates of_prior(*this, "prior_net"), of_decoder(*this, "decoder");
    const auto frames = noise.size(0);
    const auto both = [&](const char* what) {
        return at::cat({weights_.at(std::string("prior_net.mu_net.") + what),
                        weights_.at(std::string("prior_net.logvar_net.") + what)});
    };
    const PriorTensors prior{of_prior.inputs(labels, frames),
                             cells("prior_net", 1)[0],
                             of_prior.of_poses(),
                             {both("weight"), both("bias")},
                             of_decoder.of_latents()};
    const auto lengths =
        chains_ ? bones.unsqueeze(0).expand({frames, bones.size(0), bones.size(1)}) : at::Tensor();
    const auto made = fused_sampled_poses(
        prior, of_decoder.inputs(labels, frames), cells("decoder", 2), of_decoder.of_poses(),
        {weights_.at("decoder.output.weight"), weights_.at("decoder.output.bias")}, chain_body(lengths),
        noise);
    return chains_ ? made.joints : made.out;
}

at::Tensor Network::generate_frame_by_frame(const at::Tensor& labels, const at::Tensor& noise,
                                            const at::Tensor& bones) const {
    auto seen =
        at::zeros({labels.size(0), settings_.numbers()}, weights_.at("decoder.output.bias").options());
    Stack prior(*this, "prior_net", 1, seen), decoder(*this, "decoder", 2, seen);
    std::vector<at::Tensor> poses;
    for (std::int64_t t = 0; t < noise.size(0); ++t) {
        const auto about = condition(labels, t);
        const auto z = drawn(distribution("prior_net", prior.step({seen, about})), noise[t]);
        const auto out = headed(decoder.step({seen, about, z}));
        poses.push_back(chains_ ? chain_kinematics(*chains_, out, bones) : out);
        seen = settings_.feedback == Feedback::joints ? poses.back() : out;
    }
    return at::stack(poses);
}

}  // namespace actformer::model::action2motion
