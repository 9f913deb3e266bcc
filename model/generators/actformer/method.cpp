#include "model/generators/actformer/method.hpp"

#include "model/generators/actformer/discriminator.hpp"
#include "model/generators/actformer/generator.hpp"
#include "model/generators/actformer/layers.hpp"
#include "model/generators/adversarial/learner.hpp"
#include "model/generators/adversarial/maker.hpp"
#include "model/generators/weights_fit.hpp"

namespace actformer::model {
namespace {

std::vector<Key> keys() {
    auto all = actformer_keys();
    for (auto& key : gan_keys()) all.push_back(std::move(key));
    return all;
}

std::vector<NetworkSummary> networks(const Config& config, const MotionSpec& spec) {
    const auto frames = static_cast<std::uint32_t>(config.get<std::int64_t>("frames"));
    return {{"generator", actformer_generator_summary(actformer_generator_settings(config, spec), frames)},
            {"discriminator",
             actformer_discriminator_summary(actformer_discriminator_settings(config, spec), frames)}};
}

std::unique_ptr<Learner> learner(const Config& config, const MotionSpec& spec, const LearnerSetup& setup) {
    auto networks = gan_networks<ActFormerGenerator, ActFormerDiscriminator>(
        gan_settings(config), actformer_generator_settings(config, spec),
        actformer_discriminator_settings(config, spec), setup.device);
    return std::make_unique<GanLearner>(config, spec, std::move(networks), setup);
}

std::unique_ptr<Maker> maker(const Config& config, const MotionSpec& spec, const std::vector<Array>& weights,
                             const std::string& device) {
    const auto settings = actformer_generator_settings(config, spec);
    check_weights_fit(actformer_generator_weights(settings), weights, spec.where);
    return gan_maker(std::make_shared<ActFormerGenerator>(settings, 0), settings.frames, weights, spec.where,
                     device);
}

}  // namespace

Method actformer_method() {
    return {"actformer", "ActFormer (Xu, Song et al., ICCV 2023)", keys, networks, learner, maker};
}

}  // namespace actformer::model
