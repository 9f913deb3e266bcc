#include "ingest/formats/skeletal/rearrange.hpp"

#include <algorithm>
#include <unordered_map>
#include <utility>

namespace actformer::ingest {
namespace {

std::ptrdiff_t difference(std::size_t n) {
    return static_cast<std::ptrdiff_t>(n);
}

/// The order of joints in which kept ones come as `place` says, and those that no dataset keeps last among their siblings.
std::vector<std::size_t> depth_first(const Recording& recording, const std::vector<std::size_t>& place) {
    std::vector<std::vector<std::size_t>> children(recording.joints.size());
    for (std::size_t j = 1; j < recording.joints.size(); ++j)
        children[recording.joints[j].parent].push_back(j);
    std::vector<std::size_t> order, open{0};
    while (!open.empty()) {
        const std::size_t joint = open.back();
        open.pop_back();
        order.push_back(joint);
        auto& below = children[joint];
        // The last of them goes onto the stack first.
        std::stable_sort(below.begin(), below.end(),
                         [&](std::size_t a, std::size_t b) { return place[a] < place[b]; });
        open.insert(open.end(), below.rbegin(), below.rend());
    }
    return order;
}

/// For every joint, the first place in `wanted` that it or a joint below it has.
std::vector<std::size_t> places(const Recording& recording, const Skeleton& skeleton,
                                const Topology& wanted) {
    std::unordered_map<std::string, std::size_t> by_name;
    for (std::size_t j = 0; j < wanted.joints(); ++j) by_name.emplace(wanted.names[j], j);
    std::vector<std::size_t> place(recording.joints.size(), wanted.joints());
    std::size_t kept = 0;
    for (std::size_t j = 0; j < place.size(); ++j)
        if (skeleton.kept[j]) place[j] = by_name.at(skeleton.topology.names[kept++]);
    for (std::size_t j = place.size(); j-- > 1;) {
        auto& above = place[recording.joints[j].parent];
        above = std::min(above, place[j]);
    }
    return place;
}

}  // namespace

Recording cut(const Recording& recording, std::uint32_t first, std::uint32_t last) {
    Recording out{recording.joints, recording.channels, last - first, recording.frame_time, {},
                  recording.origin};
    out.values.reserve(std::size_t{out.channels} * out.frames);
    for (std::uint32_t c = 0; c < recording.channels; ++c) {
        const auto values = recording.channel(c);
        out.values.insert(out.values.end(), values.begin() + first, values.begin() + last);
    }
    return out;
}

void shift(Recording& recording, const std::array<double, 3>& way) {
    auto& root = recording.joints[0];
    std::array<bool, 3> moved{};
    for (std::size_t c = 0; c < root.channels.size(); ++c) {
        if (!is_position(root.channels[c])) continue;
        const std::size_t axis = axis_of(root.channels[c]);
        moved[axis] = true;
        const auto values =
            recording.values.begin() + difference((root.first_channel + c) * recording.frames);
        for (auto v = values; v != values + recording.frames; ++v)
            *v = static_cast<float>(static_cast<double>(*v) + way[axis]);
    }
    for (std::size_t axis = 0; axis < 3; ++axis)
        if (!moved[axis]) root.offset[axis] += way[axis];
}

void turn_up(Recording& recording, Skeleton& skeleton, Up up) {
    if (up == Up::y) return;
    const auto turn = turn_of(up);
    RecordedJoint world;
    world.pivot = true;
    world.channels = {turn.axis == 0 ? kernels::Channel::x_rotation : kernels::Channel::z_rotation};
    for (auto& joint : recording.joints) {
        ++joint.parent;
        ++joint.first_channel;
    }
    recording.joints.insert(recording.joints.begin(), std::move(world));
    recording.values.insert(recording.values.begin(), recording.frames, turn.degrees);
    ++recording.channels;
    skeleton.kept.insert(skeleton.kept.begin(), false);
    ++skeleton.root;
}

void put_in_order(Recording& recording, Skeleton& skeleton, const Topology& wanted) {
    if (skeleton.topology.names == wanted.names) return;
    const auto order = depth_first(recording, places(recording, skeleton, wanted));
    std::vector<RecordedJoint> joints;
    std::vector<float> values;
    std::vector<bool> kept;
    values.reserve(recording.values.size());
    std::vector<int> index(order.size(), -1);
    std::uint32_t channels = 0;
    for (const std::size_t j : order) {
        auto joint = std::move(recording.joints[j]);
        index[j] = static_cast<int>(joints.size());
        if (joint.parent >= 0) joint.parent = index[joint.parent];
        for (std::uint32_t c = 0; c < joint.channels.size(); ++c) {
            const auto channel = recording.channel(joint.first_channel + c);
            values.insert(values.end(), channel.begin(), channel.end());
        }
        joint.first_channel =
            std::exchange(channels, channels + static_cast<std::uint32_t>(joint.channels.size()));
        joints.push_back(std::move(joint));
        kept.push_back(skeleton.kept[j]);
    }
    recording.joints = std::move(joints);
    recording.values = std::move(values);
    skeleton = {wanted, std::move(kept), static_cast<std::size_t>(index[skeleton.root])};
}

}  // namespace actformer::ingest
