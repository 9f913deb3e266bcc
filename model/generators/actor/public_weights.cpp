#include "model/generators/actor/public_weights.hpp"

#include <algorithm>
#include <set>

#include "base/error.hpp"
#include "base/text/printable.hpp"
#include "model/generators/actor/layers.hpp"
#include "model/nn/torch_arrays.hpp"

namespace actformer::model {
namespace {

/// Sinusoids, which are made anew.
bool is_computed(const Array& array) {
    return array.name.ends_with(".pe");
}

/// Sizes that the arrays tell; their exact shapes are checked with all others later.
ActorSettings sizes_of(const std::vector<Array>& arrays, const MotionSpec& spec) {
    ActorSettings settings;
    settings.representation = spec.representation;
    settings.nodes = spec.nodes();
    settings.persons = spec.persons;
    settings.classes = spec.classes;
    settings.width = static_cast<std::uint32_t>(matrix_shape(arrays, "encoder.muQuery").second);
    settings.hidden =
        static_cast<std::uint32_t>(matrix_shape(arrays, encoder_layer(0) + "linear1.weight").first);
    settings.layers = 0;
    while (matrix_shape(arrays, encoder_layer(settings.layers) + "linear1.weight").first > 0)
        ++settings.layers;
    return settings;
}

void check_motions(const std::vector<Array>& arrays, const MotionSpec& spec) {
    if (const auto classes = matrix_shape(arrays, "encoder.muQuery").first; classes != spec.classes)
        throw Error(
            "{}: weights for {} classes, and the dataset has {}; give one with the classes it was trained on",
            spec.where, classes, spec.classes);
    check_frame(matrix_shape(arrays, "encoder.skelEmbedding.weight").second, spec);
}

/// Throws Error for arrays that the network has not: those of a variant with other layers.
void check_names(const std::vector<Array>& arrays, const ActorSettings& settings, const std::string& where) {
    std::set<std::string> names;
    for (const auto& weight : actor_weights(settings)) names.insert(weight.name);
    for (const auto& array : arrays)
        if (!names.contains(array.name))
            throw Error("{}: holds {}, which ACTOR has not: weights of one of its variants cannot be taken",
                        where, in_quotes(array.name));
}

}  // namespace

std::optional<PublicWeights> actor_public_weights(std::vector<Array> arrays, const MotionSpec& spec) {
    if (matrix_shape(arrays, "encoder.muQuery").first == 0) return std::nullopt;
    std::erase_if(arrays, is_computed);
    const auto settings = sizes_of(arrays, spec);
    check_motions(arrays, spec);
    check_names(arrays, settings, spec.where);
    return PublicWeights{{fmt::format("width={}", settings.width), fmt::format("hidden={}", settings.hidden),
                          fmt::format("layers={}", settings.layers)},
                         std::move(arrays)};
}

}  // namespace actformer::model
