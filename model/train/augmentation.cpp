#include "model/train/augmentation.hpp"

#include <ATen/CPUGeneratorImpl.h>

#include <numbers>

#include "ingest/dataset/mirror.hpp"

namespace actformer::model {
namespace {

/// `numbers` as a tensor that multiplies motions (N, P, D, T, K), one a channel.
at::Tensor by_channel(std::initializer_list<double> numbers, const at::Tensor& like) {
    return at::tensor(at::ArrayRef<double>(numbers), like.options())
        .view({1, 1, static_cast<std::int64_t>(numbers.size()), 1, 1});
}

/// Vectors (N, P, 3, ...) turned about y.
at::Tensor turned_vectors(const at::Tensor& v, const at::Tensor& sine, const at::Tensor& cosine) {
    const auto x = v.narrow(2, 0, 1), z = v.narrow(2, 2, 1);
    return at::cat({cosine * x + sine * z, v.narrow(2, 1, 1), cosine * z - sine * x}, 2);
}

/// The first two rows of Ry R, of the first two rows of R (N, P, 6, ...): a rotation's third row is the product of the others.
at::Tensor turned_rows(const at::Tensor& rows, const at::Tensor& sine, const at::Tensor& cosine) {
    const auto first = rows.narrow(2, 0, 3), second = rows.narrow(2, 3, 3);
    const auto third = at::cross(first, second, 2);
    return at::cat({cosine * first + sine * third, second}, 2);
}

}  // namespace

Augmentation::Augmentation(const AugmentationSettings& settings, ingest::Representation representation,
                           const ingest::Topology& topology, const std::string& where)
    : settings_(settings), representation_(representation) {
    if (settings.mirror == 0) return;
    for (const auto joint : ingest::other_side(topology, where)) other_.push_back(joint);
    for (auto node = static_cast<std::int64_t>(other_.size()); node < representation.nodes(topology); ++node)
        other_.push_back(node);
}

at::Tensor Augmentation::operator()(const at::Tensor& motion, std::uint64_t seed) const {
    if (settings_.mirror == 0 && settings_.turn == 0) return motion;
    const auto n = motion.size(0), d = std::int64_t{representation_.numbers()};
    auto random = at::make_generator<at::CPUGeneratorImpl>(seed);
    const auto drawn = at::rand({3, n}, random, at::TensorOptions(at::kDouble)).view({3, n, 1, 1, 1, 1});
    const auto on_device = [&](const at::Tensor& tensor) { return tensor.to(motion.options()); };
    auto bodies = motion.view({n, motion.size(1) / d, d, motion.size(2), motion.size(3)});
    if (settings_.mirror > 0) {
        const auto chosen = (drawn[0] < settings_.mirror).to(motion.device());
        bodies = at::where(chosen, mirrored(bodies), bodies);
    }
    if (settings_.turn > 0) {
        const auto angle = 2 * std::numbers::pi * drawn[2] * (drawn[1] < settings_.turn);
        bodies = turned(bodies, on_device(angle.sin()), on_device(angle.cos()));
    }
    return bodies.reshape(motion.sizes());
}

at::Tensor Augmentation::mirrored(const at::Tensor& motion) const {
    const auto nodes = at::tensor(other_, at::TensorOptions(at::kLong).device(motion.device()));
    const auto exchanged = motion.index_select(4, nodes);
    if (representation_ != ingest::Representation::rot6d) return exchanged * by_channel({-1, 1, 1}, motion);
    // M R M of a rotation, with M = diag(-1, 1, 1), and M of the translation, the last node.
    const auto joints = motion.size(4) - 1;
    return at::cat({exchanged.narrow(4, 0, joints) * by_channel({1, -1, -1, -1, 1, 1}, motion),
                    exchanged.narrow(4, joints, 1) * by_channel({-1, 1, 1, 1, 1, 1}, motion)},
                   4);
}

at::Tensor Augmentation::turned(const at::Tensor& motion, const at::Tensor& sine,
                                const at::Tensor& cosine) const {
    if (representation_ != ingest::Representation::rot6d) return turned_vectors(motion, sine, cosine);
    // The root's rotation and the translation turn; the other joints' are below the root's.
    const auto joints = motion.size(4) - 1;
    const auto translation = motion.narrow(4, joints, 1);
    return at::cat(
        {turned_rows(motion.narrow(4, 0, 1), sine, cosine), motion.narrow(4, 1, joints - 1),
         at::cat({turned_vectors(translation.narrow(2, 0, 3), sine, cosine), translation.narrow(2, 3, 3)},
                 2)},
        4);
}

}  // namespace actformer::model
