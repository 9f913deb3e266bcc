#include "model/generators/actor/losses.hpp"

#include "base/error.hpp"
#include "model/generators/finish.hpp"
#include "model/nn/fused_joints.hpp"

namespace actformer::model {
namespace {

at::Tensor numbers_of(const std::vector<std::int64_t>& values) {
    return at::tensor(values, at::kLong);
}

/// (M, n, 6) -> (M, n, 3, 3).
at::Tensor matrices_of(const at::Tensor& rotations) {
    const auto rows = normalised(rotations, ingest::Finish::orthonormal);
    const auto first = rows.slice(-1, 0, 3), second = rows.slice(-1, 3, 6);
    return at::stack({first, second, at::cross(first, second, -1)}, -2);
}

}  // namespace

RestJoints::RestJoints(const ingest::Topology& topology, const std::vector<float>& rest,
                       const std::string& where) {
    const auto joints = topology.joints();
    if (rest.size() != 3 * joints)
        throw Error("{}: rotations without a rest skeleton; take rcxyz=none, or ingest it anew", where);
    auto numbers = rest;
    const auto offsets =
        at::from_blob(numbers.data(), {static_cast<std::int64_t>(joints), 3, 1}, at::kFloat).clone();
    std::vector<std::int64_t> level{0}, place(joints), within(joints);
    std::int64_t placed = 0;
    for (levels_.push_back({numbers_of(level), {}, {}}); !level.empty();) {
        std::vector<std::int64_t> next, parents;
        for (std::size_t i = 0; i < level.size(); ++i) {
            place[static_cast<std::size_t>(level[i])] = placed++;
            within[static_cast<std::size_t>(level[i])] = static_cast<std::int64_t>(i);
        }
        for (std::size_t j = 0; j < joints; ++j)
            if (std::find(level.begin(), level.end(), std::int64_t{topology.parents[j]}) != level.end()) {
                next.push_back(static_cast<std::int64_t>(j));
                parents.push_back(within[static_cast<std::size_t>(topology.parents[j])]);
            }
        level = std::move(next);
        if (!level.empty())
            levels_.push_back(
                {numbers_of(level), numbers_of(parents), offsets.index_select(0, numbers_of(level))});
    }
    place_ = numbers_of(place);
    skeleton_.order.resize(joints);
    for (std::size_t j = 0; j < joints; ++j) {
        skeleton_.order[static_cast<std::size_t>(place[j])] = static_cast<int>(j);
        skeleton_.parents.push_back(topology.parents[j]);
        skeleton_.offsets.push_back({rest[3 * j], rest[3 * j + 1], rest[3 * j + 2]});
    }
}

at::Tensor RestJoints::positions(const at::Tensor& rotations) const {
    const auto to = [&](const at::Tensor& x) { return x.to(rotations.device()); };
    const auto matrices = matrices_of(rotations);
    auto turned = matrices.index_select(1, to(levels_[0].joints));
    auto position = at::zeros({rotations.size(0), 1, 3}, rotations.options());
    std::vector<at::Tensor> all{position};
    for (std::size_t i = 1; i < levels_.size(); ++i) {
        const auto& level = levels_[i];
        const auto parents = to(level.parents);
        const auto above = turned.index_select(1, parents);
        position = position.index_select(1, parents) +
                   above.matmul(level.offsets.to(rotations.options())).squeeze(-1);
        turned = above.matmul(matrices.index_select(1, to(level.joints)));
        all.push_back(position);
    }
    return at::cat(all, 1).index_select(1, to(place_));
}

/// The last node is the translation.
at::Tensor RestJoints::positions_of_all(const at::Tensor& motion) const {
    const auto n = motion.size(0), t = motion.size(2), k = motion.size(3);
    const auto by_person =
        motion.reshape({n, -1, cpu::rotation_numbers, t, k}).permute({0, 3, 1, 4, 2}).flatten(0, 2);
    return positions(by_person.slice(1, 0, k - 1));
}

at::Tensor RestJoints::error(const at::Tensor& made, const at::Tensor& real) const {
    const bool here = made.is_cpu() && made.scalar_type() == real.scalar_type() &&
                      (made.scalar_type() == at::kFloat || made.scalar_type() == at::kDouble);
    if (here) return fused_joint_error(skeleton_, made, real);
    return (positions_of_all(made) - positions_of_all(real)).square().mean();
}

ActorLosses actor_losses(const at::Tensor& real, const at::Tensor& made, const ActorNet::Latent& latent,
                         double kl_factor, const RestJoints* joints) {
    ActorLosses losses;
    losses.rc = (made - real).square().mean();
    losses.kl = -0.5 * (1 + latent.log_variance - latent.mean.square() - latent.log_variance.exp()).sum();
    losses.total = losses.rc + kl_factor * losses.kl;
    if (!joints) return losses;
    losses.rcxyz = joints->error(made, real);
    losses.total = losses.total + losses.rcxyz;
    return losses;
}

}  // namespace actformer::model
