#include "model/generators/csgn/method.hpp"

#include "model/generators/adversarial/learner.hpp"
#include "model/generators/adversarial/maker.hpp"
#include "model/generators/csgn/discriminator.hpp"
#include "model/generators/csgn/generator.hpp"
#include "model/generators/csgn/layers.hpp"
#include "model/generators/weights_fit.hpp"

namespace actformer::model {
namespace {

std::vector<Key> keys() {
    auto all = csgn_keys();
    for (auto& key : gan_keys()) all.push_back(std::move(key));
    return all;
}

std::vector<NetworkSummary> networks(const Config& config, const MotionSpec& spec) {
    const auto settings = csgn_settings(config, spec);
    return {{"generator", csgn_generator_summary(settings)},
            {"discriminator", csgn_discriminator_summary(settings)}};
}

std::unique_ptr<Learner> learner(const Config& config, const MotionSpec& spec, const LearnerSetup& setup) {
    const auto settings = csgn_settings(config, spec);
    auto networks = gan_networks<CsgnGenerator, CsgnDiscriminator>(gan_settings(config), settings, settings,
                                                                   setup.device);
    return std::make_unique<GanLearner>(config, spec, std::move(networks), setup);
}

std::unique_ptr<Maker> maker(const Config& config, const MotionSpec& spec, const std::vector<Array>& weights,
                             const std::string& device) {
    const auto settings = csgn_settings(config, spec);
    check_weights_fit(csgn_generator_weights(settings), weights, spec.where);
    return gan_maker(std::make_shared<CsgnGenerator>(settings, 0), settings.frames, weights, spec.where,
                     device);
}

}  // namespace

Method csgn_method() {
    return {"csgn", "CSGN (Yan et al., ICCV 2019), conditional", keys, networks, learner, maker};
}

}  // namespace actformer::model
