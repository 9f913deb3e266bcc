#include "model/train/training_events.hpp"

#include <algorithm>

#include "base/error.hpp"

namespace actformer::model {

double value_of(const Measures& measures, const std::string& key) {
    const auto found = std::ranges::find(measures, key, &Measure::key);
    if (found == measures.end()) throw Error("training measures no {}", key);
    return found->value;
}

}  // namespace actformer::model
