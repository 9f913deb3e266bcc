#include "model/generators/action2motion/body.hpp"

namespace actformer::model::action2motion {
namespace {

constexpr double least_square = 1e-4;  ///< of an angle, as published
constexpr double length_epsilon = 1e-4;

/// Rodrigues' formula: axes times angles (N, 3) -> rotations (N, 3, 3).
at::Tensor rodrigues(const at::Tensor& w) {
    const auto square = w.square().sum(1).clamp_min(least_square), angle = square.sqrt();
    const auto zero = at::zeros_like(square), x = w.select(1, 0), y = w.select(1, 1), z = w.select(1, 2);
    const auto cross = at::stack({zero, -z, y, z, zero, -x, -y, x, zero}, 1).view({-1, 3, 3});
    const auto factor = [](const at::Tensor& v) { return v.view({-1, 1, 1}); };
    return at::eye(3, w.options()) + factor(angle.sin() / angle) * cross +
           factor((1 - angle.cos()) / square) * cross.matmul(cross);
}

at::Tensor joint_at(const at::Tensor& poses, std::int64_t joint) {
    return poses.slice(-1, 3 * joint, 3 * joint + 3);
}

/// The joints that `make(joint, parent's)` gives, parents first, side by side.
template <typename Make>
at::Tensor down_the_tree(const ingest::Topology& tree, const at::Tensor& root, const Make& make) {
    std::vector<at::Tensor> joints(tree.joints());
    joints[0] = root;
    for (const auto j : tree.order())
        if (j != 0) joints[j] = make(j, joints[static_cast<std::size_t>(tree.parents[j])]);
    return at::cat(joints, -1);
}

}  // namespace

at::Tensor chain_kinematics(const Chains& chains, const at::Tensor& poses, const at::Tensor& bones) {
    std::vector<at::Tensor> joints(chains.directions.size());
    joints[0] = joint_at(poses, 0);
    for (const auto& chain : chains.joints) {
        auto rotation = at::eye(3, poses.options()).expand({poses.size(0), 3, 3});
        for (std::size_t i = 1; i < chain.size(); ++i) {
            const auto joint = static_cast<std::size_t>(chain[i]);
            const auto& d = chains.directions[joint];
            rotation = rotation.matmul(rodrigues(joint_at(poses, chain[i])));
            const auto pointing = rotation.matmul(at::tensor({d[0], d[1], d[2]}, poses.options()));
            joints[joint] = joints[static_cast<std::size_t>(chain[i - 1])] +
                            bones.select(1, chain[i]).unsqueeze(1) * pointing;
        }
    }
    return at::cat(joints, 1);
}

at::Tensor bone_lengths(const Chains& chains, const at::Tensor& joints) {
    auto parents = at::empty({static_cast<std::int64_t>(chains.parents.size())}, at::kLong);
    for (std::size_t j = 0; j < chains.parents.size(); ++j)
        parents.data_ptr<std::int64_t>()[j] = std::max(0, chains.parents[j]);
    const auto at = joints.view({joints.size(0), -1, 3});
    return (at - at.index_select(1, parents.to(joints.device()))).norm(2, {2});
}

at::Tensor joints_of_limbs(const ingest::Topology& tree, const std::vector<float>& lengths,
                           const at::Tensor& poses) {
    return down_the_tree(tree, joint_at(poses, 0), [&](std::uint32_t j, const at::Tensor& parent) {
        return parent + lengths[j] * joint_at(poses, j);
    });
}

at::Tensor limbs_of_joints(const ingest::Topology& tree, const at::Tensor& joints) {
    std::vector<at::Tensor> limbs{joint_at(joints, 0)};
    for (std::size_t j = 1; j < tree.joints(); ++j) {
        const auto limb = joint_at(joints, static_cast<std::int64_t>(j)) - joint_at(joints, tree.parents[j]);
        limbs.push_back(limb / (limb.norm(2, {-1}, true) + length_epsilon));
    }
    return at::cat(limbs, -1);
}

}  // namespace actformer::model::action2motion
