// Graph convolutions with weights shared by all nodes, and one over all nodes with weights for each, on any device. Includes torch headers.
#pragma once

#include <ATen/ATen.h>

#include <memory>

#include "model/cpu/node_kernels.hpp"

namespace actformer::model {

constexpr double leak = 0.2;  ///< by which LeakyReLU multiplies negative numbers

/// What lies under the taps of a convolution over frames: x (A, B, padded frames, in) -> (A, B, frames, taps * in).
at::Tensor under_taps(const at::Tensor& x, std::int64_t taps, std::int64_t stride);

/// The fixed sums of one convolution over nodes, for libtorch's operators and for kernels of our own.
struct GraphSums {
    at::Tensor matrix;  ///< (hops, out nodes, in nodes)
    std::shared_ptr<const cpu::NodeSums> groups;
};

/// x (N, in nodes, padded frames, in), weight (out, hops, taps, in), bias (out nodes, out) or undefined -> (N, out nodes,
/// frames with shape.out_padding zeros on either side, out), and its LeakyReLU; a `slope` of 1 leaves it linear. `fused` takes
/// kernels of our own, on processors; else libtorch's operators, as matrix products.
at::Tensor graph_convolution(const at::Tensor& x, const at::Tensor& weight, const at::Tensor& bias,
                             const cpu::NodeShape& shape, const GraphSums& sums, double slope, bool fused);

/// The same with one convolution over all nodes, weight (out, in nodes, taps, in), bias (out) -> (N, 1, frames, out).
at::Tensor convolution_over_nodes(const at::Tensor& x, const at::Tensor& weight, const at::Tensor& bias,
                                  const cpu::NodeShape& shape, const GraphSums& sums, double slope,
                                  bool fused);

}  // namespace actformer::model
