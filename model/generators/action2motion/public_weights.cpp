#include "model/generators/action2motion/public_weights.hpp"

#include <algorithm>

#include "base/error.hpp"
#include "model/nn/torch_arrays.hpp"

namespace actformer::model::action2motion {

std::optional<PublicWeights> public_weights(std::vector<Array> arrays, const MotionSpec& spec) {
    const auto [hidden, inputs] = matrix_shape(arrays, "prior_net.embed.weight");
    const auto numbers = matrix_shape(arrays, "decoder.output.weight").first;
    if (inputs == 0 || numbers == 0) return std::nullopt;
    check_frame(numbers, spec);
    const std::int64_t classes = spec.classes;
    const auto beyond = inputs - numbers - classes;  // the time counter
    if (beyond != 0 && beyond != 1)
        throw Error(
            "{}: weights for {} classes, or one less with a time counter, and the dataset has {}; give one "
            "with the "
            "classes it was trained on",
            spec.where, inputs - numbers, classes);
    std::erase_if(arrays, [](const Array& array) {  // what else a checkpoint holds, as optimisers
        return !array.name.starts_with("prior_net.") && !array.name.starts_with("posterior_net.") &&
               !array.name.starts_with("decoder.");
    });
    const bool lie = matrix_shape(arrays, "decoder.output_lie.weight").first > 0;
    return PublicWeights{
        {fmt::format("hidden={}", hidden),
         fmt::format("latent={}", matrix_shape(arrays, "prior_net.mu_net.weight").first),
         fmt::format("time_counter={}", beyond == 1), fmt::format("body={}", lie ? "lie" : "plain")},
        std::move(arrays)};
}

}  // namespace actformer::model::action2motion
