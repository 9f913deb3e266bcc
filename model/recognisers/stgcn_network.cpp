#include <fmt/format.h>

#include "model/nn/module_arrays.hpp"
#include "model/nn/sgd.hpp"
#include "model/nn/tensor_array.hpp"
#include "model/recognisers/network.hpp"
#include "model/recognisers/stgcn_net.hpp"
#include "model/train/torch_device.hpp"

namespace actformer::model {
namespace {

class StgcnNetwork : public RecogniserNetwork {
  public:
    StgcnNetwork(const RecogniserSettings& settings, const StgcnSettings& network, const at::Device& device)
        : net_(network, settings.seed, device, torch_type(settings.precision)),
          sgd_(net_.trained(), {settings.momentum, settings.weight_decay, settings.nesterov}) {}

    at::Tensor train_logits(const at::Tensor& x, std::uint64_t seed) override {
        return net_.train_forward(x, seed).logits;
    }
    at::Tensor logits(const at::Tensor& x) override { return net_.eval_forward(x).logits; }
    void optimiser_step(double rate) override { sgd_.step(rate); }

    bool finite() override {
        for (const auto& info : net_.declared())
            if (!at::isfinite(net_.weight(info.name)).all().item<bool>()) return false;
        return true;
    }

    std::vector<Array> state() override {
        auto arrays = net_.arrays();
        std::size_t i = 0;
        for (const auto& tensor : sgd_.momenta())
            arrays.push_back(array_of(fmt::format("momentum.{}", i++), tensor));
        return arrays;
    }

    void load(const std::vector<Array>& state, std::uint64_t /*steps*/, const std::string& where) override {
        net_.load(state, where);
        std::size_t i = 0;
        for (const auto& tensor : sgd_.momenta())
            copy_into(tensor, array_named(state, fmt::format("momentum.{}", i++), where), where);
    }

    std::vector<Array> weights() override { return net_.arrays(); }

  private:
    StgcnNet net_;
    Sgd sgd_;
};

}  // namespace

std::unique_ptr<RecogniserNetwork> stgcn_network(const RecogniserSettings& settings,
                                                 const StgcnSettings& network, const at::Device& device) {
    return std::make_unique<StgcnNetwork>(settings, network, device);
}

}  // namespace actformer::model
