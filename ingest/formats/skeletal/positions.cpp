#include "ingest/formats/skeletal/positions.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace actformer::ingest {
namespace {

constexpr std::array<std::string_view, 4> names{"told", "replace", "add", "ignore"};

constexpr double noise =
    0.1;  // of an OFFSET's length: real limbs stretch less, and lose less than all the rest
constexpr double shortest = 0.001;  // of the longest OFFSET: what is shorter is a placeholder

std::string described(const Recording& recording, const RecordedJoint& joint) {
    return joint.end_site ? "the End Site of " + recording.joints[joint.parent].name : joint.name;
}

/// The positions of `joint` stay near 0 where its OFFSET does not.
bool vanishes(const Recording& recording, const RecordedJoint& joint, double longest) {
    double lost = 0;
    std::vector<double> squares;
    for (std::uint32_t c = 0; c < joint.channels.size(); ++c) {
        if (!is_position(joint.channels[c])) continue;
        const double offset = joint.offset[axis_of(joint.channels[c])];
        lost += offset * offset;
        const auto values = recording.channel(joint.first_channel + c);
        squares.resize(values.size(), 0);
        for (std::size_t f = 0; f < values.size(); ++f) squares[f] += double{values[f]} * double{values[f]};
    }
    if (!(std::sqrt(lost) > shortest * longest)) return false;
    return *std::max_element(squares.begin(), squares.end()) <= noise * noise * lost;
}

double longest_offset(const Recording& recording) {
    double longest = 0;
    for (const auto& joint : recording.joints)
        for (const double o : joint.offset) longest = std::max(longest, std::abs(o));
    return longest;
}

}  // namespace

std::optional<Positions> positions_named(std::string_view name) {
    for (std::size_t i = 0; i < names.size(); ++i)
        if (names[i] == name) return static_cast<Positions>(i);
    return {};
}

std::string_view name_of(Positions positions) {
    return names[static_cast<std::size_t>(positions)];
}

std::vector<std::string> joints_that_vanish(const Recording& recording, const Skeleton& skeleton) {
    const double longest = longest_offset(recording);
    std::vector<std::string> out;
    for (std::size_t j = skeleton.root + 1; j < recording.joints.size(); ++j)
        if (skeleton.kept[j] && vanishes(recording, recording.joints[j], longest))
            out.push_back(described(recording, recording.joints[j]));
    return out;
}

void settle_positions(Recording& recording, const Skeleton& skeleton, Positions positions) {
    if (positions == Positions::told || positions == Positions::replace) return;
    for (std::size_t j = skeleton.root + 1; j < recording.joints.size(); ++j) {
        const auto& joint = recording.joints[j];
        for (std::uint32_t c = 0; c < joint.channels.size(); ++c) {
            if (!is_position(joint.channels[c])) continue;
            const double offset = joint.offset[axis_of(joint.channels[c])];
            float* value = &recording.values[std::size_t{joint.first_channel + c} * recording.frames];
            for (std::uint32_t f = 0; f < recording.frames; ++f)
                value[f] = static_cast<float>(positions == Positions::add ? value[f] + offset : offset);
        }
    }
}

}  // namespace actformer::ingest
