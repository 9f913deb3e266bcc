#include "model/nn/conditional_norm.hpp"

#include <ATen/Parallel.h>
#include <ATen/core/grad_mode.h>
#include <torch/csrc/autograd/custom_function.h>

#include "model/cpu/conditional_norm.hpp"
#include "model/cpu/layer_clock.hpp"
#include "model/nn/batch_norm.hpp"
#include "model/nn/tensor_numbers.hpp"

namespace actformer::model {
namespace {

using torch::autograd::AutogradContext;
using torch::autograd::Function;
using torch::autograd::variable_list;

constexpr const char* layer = "conditional normalisation";

void move_running(const ConditionalNormTensors& norm, const at::Tensor& mean, const at::Tensor& variance,
                  std::int64_t numbers) {
    const at::NoGradGuard no_gradients;
    const auto n = static_cast<double>(numbers);
    norm.mean.lerp_(mean, norm.momentum);
    norm.variance.lerp_(variance * (n / (n - 1)), norm.momentum);
}

cpu::ConditionalNormShape shape_of(const at::Tensor& x, std::int64_t padding, std::int64_t out_padding) {
    return {x.size(0), x.size(1), x.size(2) - 2 * padding, x.size(3), padding, out_padding};
}

at::Tensor normalised_here(const at::Tensor& x, const cpu::ConditionalNormShape& shape,
                           const at::Tensor& mean, const at::Tensor& inverse, const at::Tensor& gain,
                           const at::Tensor& shift, double leak) {
    auto y = at::empty({shape.samples, shape.nodes, shape.frames + 2 * shape.out_padding, shape.channels},
                       x.options());
    const LayerTimer timer(layer);
    by_type(x, [&](auto number) {
        using T = decltype(number);
        cpu::conditional_norm_forward<T>(
            shape, in<T>(x), {in<T>(mean), in<T>(inverse), in<T>(gain), in<T>(shift), static_cast<T>(leak)},
            in<T>(y), at::get_num_threads());
    });
    return y;
}

/// By statistics that the gradient flows through: `mean` and `inverse` are the batch's.
struct ConditionalNorm : Function<ConditionalNorm> {
    static at::Tensor forward(AutogradContext* context, const at::Tensor& x, const at::Tensor& mean,
                              const at::Tensor& inverse, const at::Tensor& gain, const at::Tensor& shift,
                              double leak, std::int64_t padding, std::int64_t out_padding) {
        context->save_for_backward({x, mean, inverse, gain, shift});
        context->saved_data["leak"] = leak;
        context->saved_data["padding"] = padding;
        context->saved_data["out_padding"] = out_padding;
        return normalised_here(x, shape_of(x, padding, out_padding), mean, inverse, gain, shift, leak);
    }

    static variable_list backward(AutogradContext* context, variable_list grads) {
        const auto saved = context->get_saved_variables();
        const auto &x = saved[0], &mean = saved[1], &inverse = saved[2], &gain = saved[3], &shift = saved[4];
        const auto grad = grads[0].contiguous();
        const auto shape =
            shape_of(x, context->saved_data["padding"].toInt(), context->saved_data["out_padding"].toInt());
        const auto leak = context->saved_data["leak"].toDouble();
        auto to_x = at::empty_like(x), to_gain = at::empty_like(gain), to_shift = at::empty_like(shift);
        const LayerTimer timer(layer, true);
        by_type(x, [&](auto number) {
            using T = decltype(number);
            cpu::conditional_norm_backward<T>(
                shape, in<T>(x),
                {in<T>(mean), in<T>(inverse), in<T>(gain), in<T>(shift), static_cast<T>(leak)}, in<T>(grad),
                {in<T>(to_x), in<T>(to_gain), in<T>(to_shift)}, at::get_num_threads());
        });
        return {to_x, {}, {}, to_gain, to_shift, {}, {}, {}};
    }
};

at::Tensor fused_norm(const at::Tensor& x, const ConditionalNormTensors& norm, bool training) {
    const auto shape = shape_of(x, norm.padding, norm.out_padding);
    const auto gain = norm.gain.contiguous(), shift = norm.shift.contiguous();
    if (!training)
        return normalised_here(x, shape, norm.mean, inverse_deviation(norm.variance), gain, shift, norm.leak);
    auto mean = at::empty({shape.channels}, x.options()), variance = at::empty_like(mean);
    {
        const LayerTimer timer(layer);
        by_type(x, [&](auto number) {
            using T = decltype(number);
            cpu::conditional_statistics<T>(shape, in<T>(x), in<T>(mean), in<T>(variance),
                                           at::get_num_threads());
        });
    }
    move_running(norm, mean, variance, shape.numbers_a_channel());
    return ConditionalNorm::apply(x, mean, inverse_deviation(variance), gain, shift, norm.leak, norm.padding,
                                  norm.out_padding);
}

at::Tensor plain_norm(const at::Tensor& x, const ConditionalNormTensors& norm, bool training) {
    const auto inner = x.slice(2, norm.padding, x.size(2) - norm.padding);
    const auto by_sample = [](const at::Tensor& table) { return table.unsqueeze(1).unsqueeze(1); };
    auto mean = norm.mean, variance = norm.variance;
    if (training) {
        mean = inner.mean({0, 1, 2});
        variance = inner.var({0, 1, 2}, /*unbiased=*/false);
        move_running(norm, mean.detach(), variance.detach(), inner.numel() / inner.size(3));
    }
    const auto normal = (inner - mean) * inverse_deviation(variance);
    const auto y = at::leaky_relu(normal * by_sample(norm.gain) + by_sample(norm.shift), norm.leak);
    return at::constant_pad_nd(y, {0, 0, norm.out_padding, norm.out_padding});
}

}  // namespace

at::Tensor conditional_norm(const at::Tensor& x, const ConditionalNormTensors& norm, bool training,
                            bool fused) {
    return fused ? fused_norm(x.contiguous(), norm, training) : plain_norm(x, norm, training);
}

}  // namespace actformer::model
