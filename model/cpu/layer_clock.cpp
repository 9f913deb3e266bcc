#include "model/cpu/layer_clock.hpp"

namespace actformer::model {
namespace {

LayerListener& listener() {
    static LayerListener current;
    return current;
}

}  // namespace

void listen_to_layers(LayerListener next) {
    listener() = std::move(next);
}

const LayerListener& layer_listener() {
    return listener();
}

}  // namespace actformer::model
