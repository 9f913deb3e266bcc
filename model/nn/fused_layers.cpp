#include "model/nn/fused_layers.hpp"

#include <ATen/Parallel.h>
#include <ATen/core/grad_mode.h>
#include <torch/csrc/autograd/custom_function.h>

#include "base/error.hpp"
#include "model/nn/batch_norm.hpp"
#include "model/nn/tensor_numbers.hpp"

namespace actformer::model {
namespace {

using torch::autograd::AutogradContext;
using torch::autograd::Function;
using torch::autograd::variable_list;

constexpr double momentum = 0.1;

cpu::MotionShape shape_of(const at::Tensor& x) {
    return {x.size(0), x.size(1), x.size(2)};
}

std::span<const cpu::Edge> edges_of(const at::Tensor& edges) {
    static_assert(sizeof(cpu::Edge) == 3 * sizeof(std::int32_t));
    return {reinterpret_cast<const cpu::Edge*>(edges.data_ptr<std::int32_t>()),
            static_cast<std::size_t>(edges.size(0))};
}

struct GraphConvolution : Function<GraphConvolution> {
    static at::Tensor forward(AutogradContext* context, const at::Tensor& x, const at::Tensor& strength,
                              const at::Tensor& weight, const at::Tensor& bias, const at::Tensor& edges) {
        const auto out = weight.size(1);
        auto y = at::empty({x.size(0), x.size(1), x.size(2), out}, x.options());
        by_type(x, [&](auto number) {
            using T = decltype(number);
            cpu::graph_forward<T>(shape_of(x), edges_of(edges), in<T>(strength), in<T>(x), x.size(3),
                                  in<T>(weight), in<T>(bias), out, in<T>(y), at::get_num_threads());
        });
        context->save_for_backward({x, strength, weight, edges});
        return y;
    }

    static variable_list backward(AutogradContext* context, variable_list grads) {
        const auto saved = context->get_saved_variables();
        const auto &x = saved[0], &strength = saved[1], &weight = saved[2], &edges = saved[3];
        const auto grad = grads[0].contiguous();
        const auto out = weight.size(1);
        auto to_x = at::empty_like(x), to_strength = at::empty_like(strength),
             to_weight = at::empty_like(weight);
        auto to_bias = at::empty({x.size(2), out}, x.options());
        by_type(x, [&](auto number) {
            using T = decltype(number);
            cpu::graph_backward<T>(shape_of(x), edges_of(edges), in<T>(strength), in<T>(x), x.size(3),
                                   in<T>(weight), out, in<T>(grad),
                                   {in<T>(to_x), in<T>(to_strength), in<T>(to_weight), in<T>(to_bias)},
                                   at::get_num_threads());
        });
        return {to_x, to_strength, to_weight, to_bias, {}};
    }
};

cpu::TemporalShape temporal_shape(const at::Tensor& x, const at::Tensor& weight, std::int64_t stride) {
    return {shape_of(x), weight.size(1), weight.size(2), weight.size(0), stride};
}

struct TemporalConvolution : Function<TemporalConvolution> {
    static at::Tensor forward(AutogradContext* context, const at::Tensor& x, const at::Tensor& weight,
                              const at::Tensor& bias, std::int64_t stride) {
        const auto shape = temporal_shape(x, weight, stride);
        auto y = at::empty({x.size(0), shape.out_frames(), x.size(2), shape.out}, x.options());
        by_type(x, [&](auto number) {
            using T = decltype(number);
            cpu::temporal_forward<T>(shape, in<T>(x), in<T>(weight), in<T>(bias), in<T>(y),
                                     at::get_num_threads());
        });
        context->save_for_backward({x, weight});
        context->saved_data["stride"] = stride;
        return y;
    }

    static variable_list backward(AutogradContext* context, variable_list grads) {
        const auto saved = context->get_saved_variables();
        const auto &x = saved[0], &weight = saved[1];
        const auto grad = grads[0].contiguous();
        const auto shape = temporal_shape(x, weight, context->saved_data["stride"].toInt());
        auto to_x = at::empty_like(x), to_weight = at::empty_like(weight),
             to_bias = at::empty({shape.out}, x.options());
        by_type(x, [&](auto number) {
            using T = decltype(number);
            cpu::temporal_backward<T>(shape, in<T>(x), in<T>(weight), in<T>(grad), in<T>(to_x),
                                      in<T>(to_weight), in<T>(to_bias), at::get_num_threads());
        });
        return {to_x, to_weight, to_bias, {}};
    }
};

template <typename T>
cpu::Norm<T> batch_norm_of(const at::Tensor& mean, const at::Tensor& inverse, const at::Tensor& weight,
                           const at::Tensor& bias) {
    return {in<T>(mean), in<T>(inverse), in<T>(weight), bias.defined() ? in<T>(bias) : nullptr};
}

/// Writes relu(dropout(normalised x) + shortcut) for given statistics.
at::Tensor normalised(const at::Tensor& x, const at::Tensor& mean, const at::Tensor& inverse,
                      const at::Tensor& weight, const at::Tensor& bias, const cpu::NormOptions& options,
                      const at::Tensor& shortcut) {
    auto y = at::empty_like(x);
    by_type(x, [&](auto number) {
        using T = decltype(number);
        cpu::norm_forward<T>(in<T>(x), shape_of(x).rows(), x.size(3),
                             batch_norm_of<T>(mean, inverse, weight, bias), options,
                             shortcut.defined() ? in<T>(shortcut) : nullptr, in<T>(y), at::get_num_threads());
    });
    return y;
}

/// Functions take no undefined tensors: an empty `shortcut` stands for none.
struct BatchNorm : Function<BatchNorm> {
    static at::Tensor forward(AutogradContext* context, const at::Tensor& x, const at::Tensor& weight,
                              const at::Tensor& bias, const at::Tensor& shortcut, const at::Tensor& mean,
                              const at::Tensor& inverse, const cpu::NormOptions& options) {
        const bool has_shortcut = shortcut.numel() > 0;
        auto y = normalised(x, mean, inverse, weight, bias, options, has_shortcut ? shortcut : at::Tensor());
        context->save_for_backward({x, weight, mean, inverse, y});
        context->saved_data["relu"] = options.relu;
        context->saved_data["drop"] = options.drop;
        context->saved_data["seed"] = static_cast<std::int64_t>(options.seed);
        context->saved_data["shortcut"] = has_shortcut;
        return y;
    }

    static variable_list backward(AutogradContext* context, variable_list grads) {
        const auto saved = context->get_saved_variables();
        const auto &x = saved[0], &weight = saved[1], &mean = saved[2], &inverse = saved[3], &y = saved[4];
        const auto grad = grads[0].contiguous();
        const cpu::NormOptions options{context->saved_data["relu"].toBool(),
                                       context->saved_data["drop"].toDouble(),
                                       static_cast<std::uint64_t>(context->saved_data["seed"].toInt())};
        auto to_x = at::empty_like(x), to_weight = at::empty_like(weight), to_bias = at::empty_like(weight);
        at::Tensor to_shortcut;
        if (context->saved_data["shortcut"].toBool()) to_shortcut = at::empty_like(x);
        by_type(x, [&](auto number) {
            using T = decltype(number);
            cpu::norm_backward<T>(in<T>(x), shape_of(x).rows(), x.size(3),
                                  batch_norm_of<T>(mean, inverse, weight, {}), options, in<T>(y), in<T>(grad),
                                  in<T>(to_x), to_shortcut.defined() ? in<T>(to_shortcut) : nullptr,
                                  in<T>(to_weight), in<T>(to_bias), at::get_num_threads());
        });
        return {to_x, to_weight, to_bias, to_shortcut, {}, {}, {}};
    }
};

}  // namespace

at::Tensor fused_graph_convolution(const at::Tensor& x, const at::Tensor& strength, const at::Tensor& weight,
                                   const at::Tensor& bias, const at::Tensor& edges) {
    return GraphConvolution::apply(x, strength, weight, bias, edges);
}

at::Tensor fused_temporal_convolution(const at::Tensor& x, const at::Tensor& weight, const at::Tensor& bias,
                                      std::int64_t stride) {
    return TemporalConvolution::apply(x, weight, bias, stride);
}

at::Tensor fused_norm(const at::Tensor& x, const NormWeights& weights, const cpu::NormOptions& options,
                      const at::Tensor& shortcut, bool training) {
    if (!training)
        return normalised(x, weights.running_mean, inverse_deviation(weights.running_variance),
                          weights.weight, weights.bias, options, shortcut);
    auto mean = at::empty_like(weights.running_mean), variance = at::empty_like(mean);
    const auto rows = shape_of(x).rows();
    {
        const at::NoGradGuard no_gradients;
        by_type(x, [&](auto number) {
            using T = decltype(number);
            cpu::statistics<T>(in<T>(x), rows, x.size(3), in<T>(mean), in<T>(variance),
                               at::get_num_threads());
        });
        const double unbiased = rows > 1 ? static_cast<double>(rows) / static_cast<double>(rows - 1) : 1.0;
        auto running_mean = weights.running_mean, running_variance = weights.running_variance;
        running_mean.mul_(1 - momentum).add_(mean, momentum);
        running_variance.mul_(1 - momentum).add_(variance, momentum * unbiased);
    }
    return BatchNorm::apply(x, weights.weight, weights.bias,
                            shortcut.defined() ? shortcut : at::empty({0}, x.options()), mean,
                            inverse_deviation(variance), options);
}

}  // namespace actformer::model
