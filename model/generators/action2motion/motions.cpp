#include "model/generators/action2motion/motions.hpp"

#include "base/error.hpp"
#include "model/generators/action2motion/body.hpp"
#include "model/generators/finish.hpp"

namespace actformer::model::action2motion {

MotionNumbers::MotionNumbers(const Settings& settings, const std::string& where) : settings_(settings) {
    if (is_lie() && settings.bone_length.size() != settings.topology.joints())
        throw Error("{}: does not say how long its bones are; body: lie needs that, body: plain does not",
                    where);
}

at::Tensor MotionNumbers::poses(const at::Tensor& motions) const {
    const auto poses = motions.permute({2, 0, 3, 1}).reshape({motions.size(2), motions.size(0), -1});
    return is_lie() && settings_.representation == ingest::Representation::limb
               ? joints_of_limbs(settings_.topology, settings_.bone_length, poses)
               : poses;
}

at::Tensor MotionNumbers::motions(const at::Tensor& poses) const {
    const auto t = poses.size(0), n = poses.size(1), nodes = settings_.nodes();
    const std::int64_t persons = settings_.persons, numbers = settings_.representation.numbers();
    const bool limbs_of_lie = is_lie() && settings_.representation == ingest::Representation::limb;
    const auto of_nodes = (limbs_of_lie ? limbs_of_joints(settings_.topology, poses) : poses)
                              .view({t, n, nodes, persons, numbers});
    const auto by_person = of_nodes.permute({1, 3, 0, 2, 4});  // (N, P, T, K, D)
    return motion_layout(limbs_of_lie ? by_person : finished(by_person, settings_.representation));
}

at::Tensor MotionNumbers::bones(std::int64_t motions) const {
    if (!is_lie()) return {};
    auto lengths = settings_.bone_length;
    const auto count = static_cast<std::int64_t>(lengths.size());
    return at::from_blob(lengths.data(), {1, count}, at::kFloat).expand({motions, count}).contiguous();
}

}  // namespace actformer::model::action2motion
