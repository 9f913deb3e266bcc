#include "kernels/forward_kinematics.hpp"

#include <algorithm>

#include "kernels/cleaning.hpp"

namespace actformer::kernels {
namespace {

constexpr std::int32_t kept_in_registers = -1, no_parent = -2, none = -1;

/// As in forward_kinematics.cl.
struct DeviceJoint {
    float offset[3];
    std::uint32_t channels, channel_count, first_channel;
    std::int32_t load, save, limb;
};
static_assert(sizeof(DeviceJoint) == 36);

/// Clips laid end to end, as the kernel wants them.
struct Layout {
    std::vector<DeviceJoint> joints;
    std::vector<std::uint32_t> joint_first{0}, frame_first{0};
    std::vector<std::uint64_t> value_first;
    std::uint64_t values = 0;
    std::uint32_t limbs = 0, slots = 0;
};

[[noreturn]] void refuse(std::size_t joint, const char* why) {
    throw Error("forward kinematics: joint {} {}", joint, why);
}

std::uint32_t pack(std::size_t joint, const std::vector<Channel>& channels) {
    if (channels.size() > 6) refuse(joint, "has more than 6 channels");
    std::uint32_t packed = 0;
    for (std::size_t i = 0; i < channels.size(); ++i)
        packed |= static_cast<std::uint32_t>(channels[i]) << (3 * i);
    return packed;
}

/// How many children each joint has; checks that the joints run depth first.
std::vector<std::uint32_t> count_children(std::span<const KinematicJoint> joints) {
    std::vector<std::uint32_t> children(joints.size(), 0);
    for (std::size_t j = 0; j < joints.size(); ++j) {
        const auto parent = joints[j].parent;
        if ((j == 0) != (parent == -1) || parent >= static_cast<std::int32_t>(j) || parent < -1)
            refuse(j, "does not come after its parent, below one root");
        // Depth first: the parent is the joint before or one of its ancestors.
        for (auto open = static_cast<std::int32_t>(j) - 1; open != parent; open = joints[open].parent)
            if (open < parent) refuse(j, "is not in depth-first order");
        if (parent >= 0) ++children[parent];
    }
    return children;
}

/// Appends the joints of `clip`. A joint with several children keeps its transform in the slot after those of
/// its ancestors, which is free again once its last child is done.
void append_joints(const KinematicClip& clip, Layout& out) {
    const auto children = count_children(clip.joints);
    std::vector<std::uint32_t> used(clip.joints.size());  // slots used by a joint and its ancestors
    std::vector<bool> below_kept(clip.joints.size());     // it or an ancestor is kept
    std::uint32_t channels = 0;
    std::int32_t limbs = 0;
    for (std::size_t j = 0; j < clip.joints.size(); ++j) {
        const KinematicJoint& joint = clip.joints[j];
        DeviceJoint d{};
        std::copy(joint.offset.begin(), joint.offset.end(), d.offset);
        d.channels = pack(j, joint.channels);
        d.channel_count = static_cast<std::uint32_t>(joint.channels.size());
        d.first_channel = channels;
        channels += d.channel_count;

        const std::uint32_t above = joint.parent < 0 ? 0 : used[joint.parent];
        const bool branches = children[j] > 1;
        used[j] = above + branches;
        d.save = branches ? static_cast<std::int32_t>(above) : none;
        d.load = joint.parent < 0                                   ? no_parent
                 : joint.parent == static_cast<std::int32_t>(j) - 1 ? kept_in_registers
                                                                    : static_cast<std::int32_t>(above) - 1;
        out.slots = std::max(out.slots, used[j]);
        below_kept[j] = joint.kept || (joint.parent >= 0 && below_kept[joint.parent]);
        if (joint.kept && limbs > 0 && !below_kept[joint.parent]) refuse(j, "hangs below no kept joint");
        d.limb = joint.kept ? limbs++ : none;
        out.joints.push_back(d);
    }
    const bool first = out.value_first.empty();
    if (!first && out.limbs != static_cast<std::uint32_t>(limbs))
        throw Error("forward kinematics: {} joints kept in one clip and {} in another", out.limbs, limbs);
    out.limbs = static_cast<std::uint32_t>(limbs);
    if (clip.frames == 0 || clip.values.size() != std::size_t{channels} * clip.frames)
        throw Error("forward kinematics: {} values for {} frames of {} channels", clip.values.size(),
                    clip.frames, channels);
}

Layout lay_out(std::span<const KinematicClip> clips) {
    Layout out;
    for (const auto& clip : clips) {
        append_joints(clip, out);
        out.joint_first.push_back(static_cast<std::uint32_t>(out.joints.size()));
        const std::uint64_t frames = std::uint64_t{out.frame_first.back()} + clip.frames;
        if (frames > 0xFFFF'FFFFU)
            throw Error("forward kinematics: {} frames are too many for one batch", frames);
        out.frame_first.push_back(static_cast<std::uint32_t>(frames));
        out.value_first.push_back(out.values);
        out.values += clip.values.size();
    }
    return out;
}

/// The clips' values end to end, each clip copied from where it lies.
Buffer<float> upload_values(Device& device, std::span<const KinematicClip> clips, const Layout& layout) {
    Buffer<float> values(device, layout.values);
    try {
        for (std::size_t c = 0; c < clips.size(); ++c)
            if (!clips[c].values.empty())
                device.queue().enqueueWriteBuffer(values.memory(), CL_FALSE,
                                                  layout.value_first[c] * sizeof(float),
                                                  clips[c].values.size_bytes(), clips[c].values.data());
        device.queue().finish();
    } catch (const cl::Error& e) {
        raise(device.info(), "copying to the device", e);
    }
    return values;
}

}  // namespace

Buffer<float> forward_kinematics(Device& device, std::span<const KinematicClip> clips,
                                 float metres_per_unit) {
    const Layout layout = lay_out(clips);
    const std::size_t total = layout.frame_first.back();
    const auto values = upload_values(device, clips, layout);
    const Buffer<DeviceJoint> joints(device, layout.joints);
    const Buffer<std::uint32_t> joint_first(device, layout.joint_first),
        frame_first(device, layout.frame_first);
    const Buffer<std::uint64_t> value_first(device, layout.value_first);
    const Buffer<float> transforms(device, std::size_t{layout.slots} * 12 * total);
    auto limbs = limb_buffer(device, total, layout.limbs);
    launch(device, device.kernel("forward_kinematics", "forward_kinematics"), {total, 1}, values, joints,
           joint_first, frame_first, value_first, static_cast<std::uint32_t>(clips.size()),
           static_cast<std::uint32_t>(total), layout.limbs, metres_per_unit, transforms, limbs);
    return limbs;
}

}  // namespace actformer::kernels
