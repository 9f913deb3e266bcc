#include "model/generators/rest_joints.hpp"

#include <algorithm>

#include "base/error.hpp"
#include "model/generators/finish.hpp"
#include "model/nn/fused_joints.hpp"

namespace actformer::model {
namespace {

Constant numbers_of(const std::vector<std::int64_t>& values) {
    return Constant(at::tensor(values, at::kLong));
}

/// (M, n, 6) -> (M, n, 3, 3).
at::Tensor matrices_of(const at::Tensor& rotations) {
    const auto rows = normalised(rotations, ingest::Finish::orthonormal);
    const auto first = rows.slice(-1, 0, 3), second = rows.slice(-1, 3, 6);
    return at::stack({first, second, at::cross(first, second, -1)}, -2);
}

bool has_kernel(const at::Tensor& motion) {
    return motion.is_cpu() && (motion.scalar_type() == at::kFloat || motion.scalar_type() == at::kDouble);
}

}  // namespace

RestJoints::RestJoints(const ingest::Topology& topology, const std::vector<float>& rest,
                       const std::string& where, const std::string& without) {
    const auto joints = topology.joints();
    if (rest.size() != 3 * joints)
        throw Error("{}: rotations without a rest skeleton; ingest it anew, or do without joints ({})", where,
                    without);
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
            levels_.push_back({numbers_of(level), numbers_of(parents),
                               Constant(offsets.index_select(0, at::tensor(level, at::kLong)))});
    }
    place_ = numbers_of(place);
    cpu::RestSkeleton skeleton;
    skeleton.order.resize(joints);
    for (std::size_t j = 0; j < joints; ++j) {
        skeleton.order[static_cast<std::size_t>(place[j])] = static_cast<int>(j);
        skeleton.parents.push_back(topology.parents[j]);
        skeleton.offsets.push_back({rest[3 * j], rest[3 * j + 1], rest[3 * j + 2]});
    }
    skeleton_ = std::make_shared<const cpu::RestSkeleton>(std::move(skeleton));
}

at::Tensor RestJoints::positions(const at::Tensor& rotations) const {
    const auto matrices = matrices_of(rotations);
    auto turned = matrices.index_select(1, levels_[0].joints.beside(rotations));
    auto position = at::zeros({rotations.size(0), 1, 3}, rotations.options());
    std::vector<at::Tensor> all{position};
    for (std::size_t i = 1; i < levels_.size(); ++i) {
        const auto& level = levels_[i];
        const auto parents = level.parents.beside(rotations);
        const auto above = turned.index_select(1, parents);
        position =
            position.index_select(1, parents) + above.matmul(level.offsets.beside(rotations)).squeeze(-1);
        turned = above.matmul(matrices.index_select(1, level.joints.beside(rotations)));
        all.push_back(position);
    }
    return at::cat(all, 1).index_select(1, place_.beside(rotations));
}

/// The last node is the translation.
at::Tensor RestJoints::positions_in(const at::Tensor& motion) const {
    if (has_kernel(motion)) return fused_joint_positions(skeleton_, motion);
    const auto n = motion.size(0), t = motion.size(2), joints = motion.size(3) - 1;
    const auto by_person =
        motion.reshape({n, -1, cpu::rotation_numbers, t, joints + 1}).permute({0, 1, 3, 4, 2});
    const auto persons = by_person.size(1);
    return motion_layout(
        positions(by_person.flatten(0, 2).slice(1, 0, joints)).view({n, persons, t, joints, 3}));
}

at::Tensor RestJoints::error(const at::Tensor& made, const at::Tensor& real) const {
    if (has_kernel(made) && made.scalar_type() == real.scalar_type())
        return fused_joint_error(*skeleton_, made, real);
    return (positions_in(made) - positions_in(real)).square().mean();
}

}  // namespace actformer::model
