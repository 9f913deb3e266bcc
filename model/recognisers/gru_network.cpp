#include <ATen/core/grad_mode.h>
#include <fmt/format.h>

#include "model/nn/adam.hpp"
#include "model/nn/fused_gru.hpp"
#include "model/nn/module_arrays.hpp"
#include "model/nn/tensor_array.hpp"
#include "model/nn/weight_store.hpp"
#include "model/recognisers/network.hpp"

namespace actformer::model {
namespace {

/// The layers in libtorch.
struct GruModule : torch::nn::Module {
    WeightStore weights;

    GruModule(const GruSettings& settings, std::uint64_t seed)
        : weights(*this, gru_weights(settings), seed, at::kFloat) {}

    at::Tensor of(const char* name, std::size_t layer) const {
        return weights.at(fmt::format("recurrent.{}_l{}", name, layer));
    }
    at::Tensor linear(const std::string& name, const at::Tensor& x) const {
        return at::linear(x, weights.at(name + ".weight"), weights.at(name + ".bias"));
    }
};

class GruNetwork : public RecogniserNetwork {
  public:
    GruNetwork(const RecogniserSettings& settings, const GruSettings& network, const at::Device& device)
        : settings_(network),
          decay_(settings.weight_decay),
          module_(network, settings.seed),
          parameters_((module_.to(device), module_.parameters())),
          adam_(parameters_, {1, 0.9, 0.999}) {}

    at::Tensor train_logits(const at::Tensor& x, std::uint64_t /*seed*/) override {
        parameters_.zero_gradients();
        return forward(x);
    }
    at::Tensor logits(const at::Tensor& x) override {
        const at::NoGradGuard no_gradients;
        return forward(x);
    }
    void optimiser_step(double rate) override {
        if (decay_ > 0) parameters_.gradients().add_(parameters_.values(), decay_);
        adam_.step(rate);
    }
    bool finite() override { return at::isfinite(parameters_.values()).all().item<bool>(); }

    std::vector<Array> state() override {
        auto arrays = weights();
        arrays.push_back(array_of("adam.squares", adam_.squares()));
        arrays.push_back(array_of("adam.means", adam_.means()));
        return arrays;
    }
    void load(const std::vector<Array>& state, std::uint64_t steps, const std::string& where) override {
        load_arrays(module_, "", state, where);
        copy_into(adam_.squares(), array_named(state, "adam.squares", where), where);
        copy_into(adam_.means(), array_named(state, "adam.means", where), where);
        adam_.steps = steps;
    }
    std::vector<Array> weights() override { return arrays_of(module_, ""); }

  private:
    at::Tensor poses(const at::Tensor& motions) const;
    at::Tensor states(const at::Tensor& poses) const;
    at::Tensor forward(const at::Tensor& motions) const {
        const auto last = states(poses(motions));
        return module_.linear("linear2", module_.linear("linear1", last).tanh());
    }

    GruSettings settings_;
    double decay_;
    GruModule module_;
    FlatParameters parameters_;
    Adam adam_;
};

/// Motions (N, C, T, K) -> poses (T, N, K*C) without what the root's first frame says, the mean over the persons.
at::Tensor GruNetwork::poses(const at::Tensor& motions) const {
    const std::int64_t numbers = settings_.representation.numbers(), nodes = settings_.nodes();
    const auto n = motions.size(0), t = motions.size(2);
    const auto moving = settings_.representation.moving(settings_.nodes());
    auto by_person = motions.view({n, -1, numbers, t, nodes}).clone();
    const auto root = by_person.slice(2, 0, 3).select(4, moving.root).select(3, 0).mean(1);  // (N, 3)
    by_person.slice(2, 0, 3).narrow(4, moving.first, moving.count).sub_(root.view({n, 1, 3, 1, 1}));
    return by_person.view({n, -1, t, nodes}).permute({2, 0, 3, 1}).reshape({t, n, -1});
}

/// The last frame's, (N, hidden).
at::Tensor GruNetwork::states(const at::Tensor& poses) const {
    const auto n = poses.size(1), hidden = module_.of("weight_hh", 0).size(1);
    if (!poses.is_cpu()) {
        std::vector<at::Tensor> all;
        for (std::size_t l = 0; l < eval::gru_layers; ++l)
            for (const char* name : {"weight_ih", "weight_hh", "bias_ih", "bias_hh"})
                all.push_back(module_.of(name, l));
        const auto start =
            at::zeros({static_cast<std::int64_t>(eval::gru_layers), n, hidden}, poses.options());
        return std::get<0>(at::gru(poses, start, all, true, eval::gru_layers, 0, false, false, false))[-1];
    }
    const GruInputs inputs{at::matmul(poses, module_.of("weight_ih", 0).t()),
                           module_.of("bias_ih", 0).expand({n, 3 * hidden}),
                           at::zeros({poses.size(0), 3 * hidden}, poses.options())};
    std::vector<GruTensors> cells{{{}, {module_.of("weight_hh", 0), module_.of("bias_hh", 0)}}};
    cells.push_back({{module_.of("weight_ih", 1), module_.of("bias_ih", 1)},
                     {module_.of("weight_hh", 1), module_.of("bias_hh", 1)}});
    return fused_gru(inputs, cells)[-1];
}

}  // namespace

std::unique_ptr<RecogniserNetwork> gru_network(const RecogniserSettings& settings, const GruSettings& network,
                                               const at::Device& device) {
    return std::make_unique<GruNetwork>(settings, network, device);
}

}  // namespace actformer::model
