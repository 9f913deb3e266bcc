#include "model/train/learner.hpp"

namespace actformer::model {

std::string Learner::trouble(const Measures& /*losses*/) const {
    return {};
}

std::vector<Array> Learner::ema_weights() {
    return {};
}

}  // namespace actformer::model
