#include "ingest/formats/skeletal/pose.hpp"

namespace actformer::ingest {

std::vector<Vector3> places_of(const Recording& recording, std::uint32_t frame) {
    std::vector<Vector3> places(recording.joints.size());
    std::vector<Matrix3> turns(recording.joints.size(), identity3);
    for (std::size_t j = 0; j < places.size(); ++j) {
        const auto& joint = recording.joints[j];
        Vector3 place = joint.offset;
        Matrix3 own = identity3;
        for (std::uint32_t c = 0; c < joint.channels.size(); ++c) {
            const double value = recording.channel(joint.first_channel + c)[frame];
            if (is_position(joint.channels[c]))
                place[axis_of(joint.channels[c])] = value;
            else
                own = own * rotation_about(axis_of(joint.channels[c]), value);
        }
        if (joint.parent < 0) {
            places[j] = place;
            turns[j] = own;
            continue;
        }
        places[j] = turns[joint.parent] * place;
        for (std::size_t d = 0; d < 3; ++d) places[j][d] += places[joint.parent][d];
        turns[j] = turns[joint.parent] * own;
    }
    return places;
}

}  // namespace actformer::ingest
