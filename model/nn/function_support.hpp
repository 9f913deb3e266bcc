// What differentiable functions over kernels of our own share. Includes torch headers.
#pragma once

#include <ATen/ATen.h>
#include <ATen/Parallel.h>

#include "model/cpu/layer_clock.hpp"
#include "model/cpu/transformer_kernels.hpp"
#include "model/nn/tensor_numbers.hpp"

namespace actformer::model {

/// by_type() under a layer's name.
template <typename Run>
void timed(const char* layer, bool backward, const at::Tensor& x, const Run& run) {
    const LayerTimer timer(layer, backward);
    by_type(x, run);
}

template <typename T>
cpu::LinearWeight<T> linear_of(const at::Tensor& weight, const at::Tensor& bias) {
    return {in<T>(weight), in<T>(bias)};
}

template <typename T>
cpu::NormWeight<T> norm_of(const at::Tensor& weight, const at::Tensor& bias) {
    return {in<T>(weight), in<T>(bias)};
}

/// Room for a weight's and a bias's gradients.
struct Gradients {
    at::Tensor weight, bias;

    Gradients(const at::Tensor& of_weight, const at::Tensor& of_bias)
        : weight(at::empty_like(of_weight)), bias(at::empty_like(of_bias)) {}
    template <typename T>
    cpu::ParameterGradient<T> to() const {
        return {in<T>(weight), in<T>(bias)};
    }
};

/// Whether gradients are recorded; else nothing is kept for the backward pass.
inline bool grad_enabled() {
    return at::GradMode::is_enabled();
}

inline int threads() {
    return at::get_num_threads();
}

}  // namespace actformer::model
