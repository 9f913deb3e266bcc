#include "model/generators/action2motion/method.hpp"

#include "model/generators/action2motion/layers.hpp"
#include "model/generators/action2motion/learner.hpp"
#include "model/generators/action2motion/maker.hpp"
#include "model/generators/action2motion/public_weights.hpp"
#include "model/generators/weights_fit.hpp"

namespace actformer::model::action2motion {
namespace {

std::vector<NetworkSummary> networks(const Config& config, const MotionSpec& spec) {
    return summary(settings_of(config, spec));
}

std::unique_ptr<Learner> learner(const Config& config, const MotionSpec& spec, const LearnerSetup& setup) {
    return std::make_unique<MotionLearner>(config, settings_of(config, spec), spec.where, setup);
}

std::unique_ptr<Maker> maker(const Config& config, const MotionSpec& spec, const std::vector<Array>& weights,
                             const std::string& device) {
    const auto settings = settings_of(config, spec);
    check_weights_fit(weights_of(settings), weights, spec.where);
    return std::make_unique<MotionMaker>(settings, weights, device, spec.where);
}

}  // namespace

Method method() {
    return {
        "action2motion", "Action2Motion (Guo et al., ACM Multimedia 2020)", keys, networks, learner, maker,
        public_weights};
}

}  // namespace actformer::model::action2motion
