#include "model/generators/actor/method.hpp"

#include <ATen/Parallel.h>
#include <ATen/core/grad_mode.h>

#include "model/generators/actor/layers.hpp"
#include "model/generators/actor/learner.hpp"
#include "model/generators/actor/public_weights.hpp"
#include "model/generators/finish.hpp"
#include "model/generators/weights_fit.hpp"
#include "model/nn/module_arrays.hpp"
#include "model/train/torch_device.hpp"

namespace actformer::model {
namespace {

constexpr std::uint8_t for_latents = 3;  // of cpu::RandomPlace

std::vector<NetworkSummary> networks(const Config& config, const MotionSpec& spec) {
    return actor_summary(actor_settings(config, spec),
                         static_cast<std::uint32_t>(config.get<std::int64_t>("frames")));
}

std::unique_ptr<Learner> learner(const Config& config, const MotionSpec& spec, const LearnerSetup& setup) {
    return std::make_unique<ActorLearner>(actor_settings(config, spec), actor_training(config, spec), spec,
                                          setup);
}

/// Latent vectors are standard normal numbers.
class ActorMaker : public Maker {
  public:
    ActorMaker(const Config& config, const MotionSpec& spec, const std::vector<Array>& weights,
               const std::string& device)
        : settings_(actor_settings(config, spec)), device_(torch_device(device)), net_(settings_, 0) {
        load_arrays(net_, "", weights, spec.where);
        net_.to(device_);
    }

    std::uint32_t most_frames() const override { return most_actor_frames; }
    std::uint32_t batch() const override { return 25; }

    std::vector<float> make(std::uint64_t seed, std::uint32_t label, std::uint32_t index,
                            std::uint32_t frames) override {
        const at::NoGradGuard no_gradients;
        auto latent = at::empty({batch(), settings_.width}, at::kFloat);
        cpu::normal_numbers({seed, std::uint64_t{label} << 32U | index, for_latents}, 0, batch(),
                            settings_.width, latent.data_ptr<float>(), at::get_num_threads());
        const auto labels = at::full({batch()}, static_cast<std::int64_t>(label), at::kLong);
        const auto numbers = net_.decode(latent.to(device_), labels.to(device_), frames);
        const std::int64_t t = frames, persons = settings_.persons, nodes = settings_.nodes;
        const auto motion =
            motion_layout(finished(numbers.reshape({batch(), persons, -1, t, nodes}).permute({0, 1, 3, 4, 2}),
                                   settings_.representation))
                .to(at::kCPU)
                .contiguous();
        const auto* first = motion.data_ptr<float>();
        return {first, first + motion.numel()};
    }

  private:
    ActorSettings settings_;
    at::Device device_;
    ActorNet net_;
};

std::unique_ptr<Maker> maker(const Config& config, const MotionSpec& spec, const std::vector<Array>& weights,
                             const std::string& device) {
    check_weights_fit(actor_weights(actor_settings(config, spec)), weights, spec.where);
    return std::make_unique<ActorMaker>(config, spec, weights, device);
}

}  // namespace

Method actor_method() {
    return {"actor",
            "ACTOR (Petrovich et al., ICCV 2021)",
            actor_keys,
            networks,
            learner,
            maker,
            actor_public_weights};
}

}  // namespace actformer::model
