#include "model/train/learner.hpp"

namespace actformer::model {

std::string Learner::trouble(const Measures& /*losses*/) const {
    return {};
}

std::vector<Array> Learner::ema_weights() {
    return {};
}

std::vector<Phase> Learner::phases() {
    return {};
}

}  // namespace actformer::model
