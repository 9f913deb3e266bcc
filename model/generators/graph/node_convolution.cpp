#include "model/generators/graph/node_convolution.hpp"

#include "model/nn/fused.hpp"

namespace actformer::model {
namespace {

at::Tensor finished_frames(const at::Tensor& y, const at::Tensor& bias, const cpu::NodeShape& shape,
                           double slope) {
    const auto shifted = bias.defined() ? y + bias.unsqueeze(1) : y;
    return at::constant_pad_nd(at::leaky_relu(shifted, slope), {0, 0, shape.out_padding, shape.out_padding});
}

}  // namespace

at::Tensor under_taps(const at::Tensor& x, std::int64_t taps, std::int64_t stride) {
    return x.unfold(2, taps, stride).transpose(3, 4).flatten(3, 4);
}

at::Tensor graph_convolution(const at::Tensor& x, const at::Tensor& weight, const at::Tensor& bias,
                             const cpu::NodeShape& shape, const GraphSums& sums, double slope, bool fused) {
    const auto hops = weight.size(1);
    if (fused)
        return fused_node_convolution(x.contiguous(), weight, bias, shape.with_weights_by_hop(hops),
                                      sums.groups, slope);
    const auto n = x.size(0), frames = shape.out_frames();
    const auto matrix = weight.flatten(2, 3).transpose(0, 1).flatten(0, 1);  // (hops * out, taps * in)
    const auto mapped = at::matmul(under_taps(x, shape.taps, shape.stride), matrix.t())
                            .view({n, shape.in_nodes, frames, hops, shape.out})
                            .permute({0, 2, 3, 1, 4});  // (N, frames, hops, in nodes, out)
    const auto y = at::matmul(sums.matrix, mapped).sum(2).transpose(1, 2);
    return finished_frames(y, bias, shape, slope);
}

at::Tensor convolution_over_nodes(const at::Tensor& x, const at::Tensor& weight, const at::Tensor& bias,
                                  const cpu::NodeShape& shape, const GraphSums& sums, double slope,
                                  bool fused) {
    const auto row = bias.unsqueeze(0);
    if (fused)
        return fused_node_convolution(x.contiguous(), weight, row, shape.with_weights_by_output(),
                                      sums.groups, slope);
    const auto seen = under_taps(x, shape.taps, shape.stride)
                          .transpose(1, 2)
                          .flatten(2, 3);  // (N, frames, nodes * taps * in)
    return finished_frames(at::matmul(seen, weight.flatten(1, 3).t()).unsqueeze(1), row, shape, slope);
}

}  // namespace actformer::model
