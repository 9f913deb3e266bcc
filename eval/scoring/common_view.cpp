#include "eval/scoring/common_view.hpp"

#include "base/error.hpp"
#include "ingest/dataset/known_topologies.hpp"
#include "ingest/dataset/layout.hpp"

namespace actformer::eval {
namespace {

ingest::CommonJoints common_joints_of(const MotionsInfo& motions) {
    if (!motions.body)
        throw Error(
            "{}: its skeleton is not known, so that it cannot be seen as 15 common joints; write it again "
            "with "
            "this program",
            motions.source);
    return {*motions.body, motions.source};
}

}  // namespace

bool sees_common_joints(const std::vector<int>& recogniser, const MotionsInfo& motions) {
    if (recogniser != ingest::common15().parents || motions.parents == recogniser) return false;
    return !motions.parents.empty() ||
           motions.joints != recogniser.size();  // a bare file of 15 joints holds these
}

MotionsInfo in_common_joints(const MotionsInfo& motions) {
    common_joints_of(motions);
    auto out = motions;
    out.representation = ingest::Representation::limb;
    out.joints = static_cast<std::uint32_t>(ingest::common15().joints());
    out.parents = ingest::common15().parents;
    out.channels = 3 * motions.persons;
    return out;
}

std::vector<float> in_common_joints(const MotionBatch& batch, const MotionsInfo& motions) {
    const auto common = common_joints_of(motions);
    const auto each = batch.values.size() / batch.rows.size();
    ingest::Motion motion;
    motion.frames = batch.frames;
    motion.persons = motions.persons;
    motion.nodes = motions.joints;
    motion.numbers = motions.channels / motions.persons;
    std::vector<float> out;
    for (std::size_t i = 0; i < batch.rows.size(); ++i) {
        motion.name = motions.names[batch.rows[i]];
        ingest::take_channels_first(batch.values.subspan(i * each, each), motion);
        const auto seen = ingest::channels_first(common.of(motion));
        out.insert(out.end(), seen.begin(), seen.end());
    }
    return out;
}

}  // namespace actformer::eval
