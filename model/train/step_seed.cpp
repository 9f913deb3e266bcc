#include "model/train/step_seed.hpp"

#include "base/random/splitmix.hpp"

namespace actformer::model {

std::uint64_t step_seed(std::uint64_t seed, std::uint64_t step) {
    return mixed(seed * golden_step + step + 1);
}

}  // namespace actformer::model
