#include "kernels/gru.hpp"

#include "kernels/sources.hpp"

namespace actformer::kernels {
namespace {

/// Units of the state that a work-item keeps: a vector of a CPU's, one of a GPU's.
std::uint32_t units_an_item(const Device& device) {
    return device.info().type == "CPU" ? 16 : 1;
}

cl::Kernel kernel_of(Device& device, const char* name, std::uint32_t hidden) {
    return device.vector_kernel("gru", name, units_an_item(device), fmt::format(" -DHIDDEN={}", hidden));
}

}  // namespace

Gru::Gru(Device& device, std::uint32_t hidden)
    : device_(&device),
      items_(hidden / units_an_item(device)),
      poses_(kernel_of(device, "poses", hidden)),
      layer_(kernel_of(device, "layer", hidden)),
      dense_(kernel_of(device, "dense", hidden)) {}

void Gru::poses(const cl::Buffer& motion, const MotionLayout& layout, const Centring& moved,
                std::uint32_t begin, std::uint32_t count, const Buffer<float>& to) {
    const auto rows = count * layout.frames;
    launch(*device_, poses_, {layout.inputs(), rows}, motion, to, rows, begin, layout.channels, layout.frames,
           layout.nodes, layout.numbers, moved.root, moved.first, moved.count);
}

void Gru::layer(const Buffer<float>& x, const Buffer<float>& initial, const GruWeights& weights,
                std::uint32_t count, std::uint32_t frames, std::uint32_t inputs,
                const Buffer<float>& states) {
    if (count == 0) return;
    try {
        cl_uint i = 0;
        for (const auto* buffer : {&x, &initial, &weights.input, &weights.state, &weights.bias, &states})
            layer_.setArg(i++, buffer->memory());
        layer_.setArg(i++, frames);
        layer_.setArg(i++, inputs);
        device_->queue().enqueueNDRangeKernel(layer_, cl::NullRange, cl::NDRange(std::size_t{count} * items_),
                                              cl::NDRange(items_));  // a group a sequence
    } catch (const cl::Error& e) {
        raise(device_->info(), "running kernel layer", e);
    }
}

void Gru::dense(const Buffer<float>& x, const Rows& rows, const Buffer<float>& weight,
                const Buffer<float>& bias, bool squash, const Buffer<float>& to) {
    const auto outputs = static_cast<std::uint32_t>(bias.size());
    launch(*device_, dense_, {outputs, rows.count}, x, weight, bias, to, rows.count, rows.inputs, outputs,
           rows.start, rows.pitch, rows.first, static_cast<std::uint32_t>(squash));
}

}  // namespace actformer::kernels
