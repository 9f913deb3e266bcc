#include "model/generators/actformer/method.hpp"

#include "model/generators/actformer/discriminator.hpp"
#include "model/generators/actformer/generator.hpp"
#include "model/generators/actformer/layers.hpp"
#include "model/generators/adversarial/learner.hpp"
#include "model/generators/adversarial/maker.hpp"

namespace actformer::model {
namespace {

std::vector<Key> keys() {
    auto all = network_keys();
    for (auto& key : gan_keys()) all.push_back(std::move(key));
    return all;
}

std::vector<NetworkSummary> networks(const Config& config, const MotionSpec& spec) {
    const auto frames = static_cast<std::uint32_t>(config.get<std::int64_t>("frames"));
    return {{"generator", generator_summary(generator_settings(config, spec), frames)},
            {"discriminator", discriminator_summary(discriminator_settings(config, spec), frames)}};
}

std::unique_ptr<Learner> learner(const Config& config, const MotionSpec& spec, const LearnerSetup& setup) {
    auto networks =
        gan_networks<Generator, Discriminator>(gan_settings(config), generator_settings(config, spec),
                                               discriminator_settings(config, spec), setup.device);
    return std::make_unique<GanLearner>(config, spec, std::move(networks), setup);
}

std::unique_ptr<Maker> maker(const Config& config, const MotionSpec& spec, const std::vector<Array>& weights,
                             const std::string& device) {
    const auto settings = generator_settings(config, spec);
    return gan_maker(std::make_shared<Generator>(settings, 0), settings.frames, weights, spec.where, device);
}

}  // namespace

Method actformer_method() {
    return {"actformer", "ActFormer (Xu, Song et al., ICCV 2023)", keys, networks, learner, maker};
}

}  // namespace actformer::model
