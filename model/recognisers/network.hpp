// A recogniser's network and what moves it, as training sees any kind of it. Includes torch headers.
#pragma once

#include <ATen/ATen.h>

#include <memory>
#include <vector>

#include "model/nn/array.hpp"
#include "model/recognisers/gru.hpp"
#include "model/recognisers/recogniser_settings.hpp"

namespace actformer::model {

class RecogniserNetwork {
  public:
    virtual ~RecogniserNetwork() = default;

    /// x (N, channels, T, nodes) -> logits (N, classes), with gradients. What is random is a function of `seed`.
    virtual at::Tensor train_logits(const at::Tensor& x, std::uint64_t seed) = 0;

    /// The same without gradients or anything random.
    virtual at::Tensor logits(const at::Tensor& x) = 0;

    /// A step of the optimiser along the gradients, at a learning rate.
    virtual void optimiser_step(double rate) = 0;

    /// Whether every weight is finite.
    virtual bool finite() = 0;

    /// Weights and what the optimiser keeps; taken back behind `steps` steps.
    virtual std::vector<Array> state() = 0;
    virtual void load(const std::vector<Array>& state, std::uint64_t steps, const std::string& where) = 0;

    virtual std::vector<Array> weights() = 0;
};

/// Weights start at random from the settings' seed.
std::unique_ptr<RecogniserNetwork> stgcn_network(const RecogniserSettings& settings,
                                                 const StgcnSettings& network, const at::Device& device);
std::unique_ptr<RecogniserNetwork> gru_network(const RecogniserSettings& settings, const GruSettings& network,
                                               const at::Device& device);

}  // namespace actformer::model
