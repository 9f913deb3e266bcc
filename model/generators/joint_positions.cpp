#include "model/generators/joint_positions.hpp"

#include "base/error.hpp"

namespace actformer::model {
namespace {

constexpr const char* without_joints = "d_joints=0";

/// A joint's position is the root's and the sum of all limbs on the way to it, times their lengths.
at::Tensor limbs_to_joints(const MotionSpec& spec) {
    const auto joints = spec.topology.joints();
    if (spec.bone_length.size() < joints)
        throw Error("{}: limbs without lengths; ingest it anew, or do without joints ({})", spec.where,
                    without_joints);
    std::vector<float> sums(joints * joints);
    for (std::size_t j = 0; j < joints; ++j) {
        auto on_the_way = j;
        for (; spec.topology.parents[on_the_way] >= 0;
             on_the_way = static_cast<std::size_t>(spec.topology.parents[on_the_way]))
            sums[on_the_way * joints + j] = spec.bone_length[on_the_way];
        sums[on_the_way * joints + j] = 1;
    }
    const auto size = static_cast<std::int64_t>(joints);
    return at::from_blob(sums.data(), {size, size}, at::kFloat).clone();
}

}  // namespace

JointPositions::JointPositions(const MotionSpec& spec) : representation_(spec.representation) {
    if (representation_ == ingest::Representation::limb) limbs_to_joints_ = Constant(limbs_to_joints(spec));
    if (representation_ == ingest::Representation::rot6d)
        rest_.emplace(spec.topology, spec.rest, spec.where, without_joints);
}

at::Tensor JointPositions::of(const at::Tensor& motion) const {
    switch (representation_) {
        case ingest::Representation::limb:
            return at::matmul(motion, limbs_to_joints_.beside(motion));
        case ingest::Representation::rot6d: {
            const auto from_root = rest_->positions_in(motion);
            const auto n = motion.size(0), t = motion.size(2), joints = from_root.size(3);
            const auto translation =
                motion.unflatten(1, {-1, cpu::rotation_numbers}).slice(2, 0, 3).slice(-1, joints);
            return from_root + translation.reshape({n, -1, t, 1});
        }
        case ingest::Representation::xyz:
            break;
    }
    return motion;
}

}  // namespace actformer::model
