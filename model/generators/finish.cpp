#include "model/generators/finish.hpp"

namespace actformer::model {
namespace {

constexpr double length_epsilon = 1e-4, shortest = 1e-12;

/// Two orthogonal unit vectors out of the six numbers along the last axis (Gram and Schmidt).
at::Tensor orthonormal(const at::Tensor& x) {
    const auto unit = [](const at::Tensor& v) { return v / v.norm(2, {-1}, true).clamp_min(shortest); };
    const auto first = unit(x.slice(-1, 0, 3));
    const auto second = x.slice(-1, 3, 6);
    return at::cat({first, unit(second - (first * second).sum(-1, true) * first)}, -1);
}

/// `normal` with the free node's position as `numbers` have it, and 0 behind it; both (..., K, D).
at::Tensor with_position(const at::Tensor& normal, const at::Tensor& numbers,
                         ingest::Representation representation) {
    const auto nodes = numbers.size(-2), behind = numbers.size(-1) - 3;
    const auto free_node = representation.free_node(static_cast<std::uint32_t>(nodes));
    if (!free_node) return normal;
    const std::int64_t free = *free_node;
    const auto position = at::constant_pad_nd(numbers.slice(-2, free, free + 1).slice(-1, 0, 3), {0, behind});
    return at::cat({normal.slice(-2, 0, free), position, normal.slice(-2, free + 1, nodes)}, -2);
}

}  // namespace

at::Tensor normalised(const at::Tensor& numbers, ingest::Finish finish) {
    switch (finish) {
        case ingest::Finish::unit:
            return numbers / (numbers.norm(2, {-1}, true) + length_epsilon);
        case ingest::Finish::orthonormal:
            return orthonormal(numbers);
        case ingest::Finish::linear:
            break;
    }
    return numbers;
}

at::Tensor finished(const at::Tensor& numbers, ingest::Representation representation) {
    return with_position(normalised(numbers, representation.finish()), numbers, representation);
}

at::Tensor bounded_finish(const at::Tensor& numbers, ingest::Representation representation) {
    if (representation.finish() == ingest::Finish::linear) return numbers;
    return with_position(normalised(numbers.tanh(), representation.finish()), numbers, representation);
}

at::Tensor motion_layout(const at::Tensor& poses) {
    return poses.permute({0, 1, 4, 2, 3}).flatten(1, 2);
}

}  // namespace actformer::model
