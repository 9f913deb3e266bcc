#include "model/nn/self_attention.hpp"

#include <cmath>

namespace actformer::model {

at::Tensor self_attention(const at::Tensor& x, const LinearTensors& qkv, const LinearTensors& proj,
                          std::int64_t heads) {
    const auto n = x.size(0), tokens = x.size(1), width = x.size(2), each = width / heads;
    const auto all =
        at::linear(x, qkv.weight, qkv.bias).view({n, tokens, 3, heads, each}).permute({2, 0, 3, 1, 4});
    const auto scores = all[0].matmul(all[1].transpose(2, 3)) * std::pow(static_cast<double>(each), -0.5);
    const auto seen = scores.softmax(-1).matmul(all[2]).transpose(1, 2).reshape({n, tokens, width});
    return at::linear(seen, proj.weight, proj.bias);
}

}  // namespace actformer::model
