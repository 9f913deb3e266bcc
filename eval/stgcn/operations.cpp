#include "eval/stgcn/operations.hpp"

#include "kernels/stgcn.hpp"

namespace actformer::eval {

double direct_operations(const StgcnShape& shape, std::uint32_t frames) {
    double sum = 2.0 * shape.features() * shape.classes;
    for (std::size_t i = 0; i < stgcn_layers; ++i) {
        const auto layer = stgcn_layer(shape, i);
        const double in = layer.in, out = layer.out, joints = shape.joints();
        const auto after = kernels::strided(frames, layer.stride);
        sum += 2 * joints * frames * 3 * in * out + 2 * joints * after * stgcn_taps * out * out;
        if (layer.residual == StgcnLayer::Residual::convolution) sum += 2 * joints * after * in * out;
        frames = after;
    }
    return sum;
}

double multiplied_operations(const StgcnShape& shape, std::uint32_t frames) {
    double panels = 0;
    for (const auto& part : partition(shape.graph))
        for (std::size_t w = 0; w < shape.joints(); ++w) {
            bool any = false;
            for (std::size_t v = 0; v < shape.joints(); ++v) any = any || part[v * shape.joints() + w] != 0;
            panels += any;
        }
    double sum = 2.0 * shape.features() * shape.classes;
    for (std::size_t i = 0; i < stgcn_layers; ++i) {
        const auto layer = stgcn_layer(shape, i);
        const double in = layer.in, out = layer.out, joints = shape.joints();
        const auto after = kernels::strided(frames, layer.stride);
        const auto filter = kernels::filtering(layer.stride);
        const auto tiles_a_joint = (after + filter.tile - 1) / filter.tile;
        sum += 2 * panels * frames * in * out + 2 * joints * tiles_a_joint * filter.points_in * out * out;
        if (layer.residual == StgcnLayer::Residual::convolution) sum += 2 * joints * after * in * out;
        frames = after;
    }
    return sum;
}

}  // namespace actformer::eval
