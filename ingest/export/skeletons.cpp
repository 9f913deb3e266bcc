#include "ingest/export/skeletons.hpp"

#include <Eigen/Geometry>
#include <cmath>

#include "base/error.hpp"
#include "ingest/export/rest_pose.hpp"
#include "ingest/export/rotations.hpp"

namespace actformer::ingest {
namespace {

std::vector<Point> joints_of_limbs(const ExportClip& clip) {
    const auto& motion = clip.motion;
    const auto& parents = clip.body.topology.parents;
    const auto order = clip.body.topology.order();
    const auto joints = clip.body.topology.joints(), known = clip.body.bone_length.size() / joints;
    std::vector<Point> out(std::size_t{motion.frames} * motion.persons * joints);
    for (std::size_t body = 0; body < out.size() / joints; ++body) {
        const auto person = body % motion.persons;
        const float* lengths = &clip.body.bone_length[person < known ? person * joints : 0];
        Point* at = &out[body * joints];
        for (const auto j : order) {
            const float* limb = motion.at(body / motion.persons, person, j);
            const double length = std::hypot(double{limb[0]}, double{limb[1]}, double{limb[2]});
            const double scale = parents[j] < 0 ? 1 : length > 0 ? lengths[j] / length : 0;
            for (std::size_t d = 0; d < 3; ++d)
                at[j][d] = limb[d] * scale + (parents[j] < 0 ? 0 : at[parents[j]][d]);
        }
    }
    return out;
}

Quaternion quaternion_of(const Rotation& rows, const Quaternion* before, const std::string& where) {
    const Eigen::Matrix3d matrix =
        Eigen::Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>>(rows.data());
    constexpr double rounding = 1e-6;
    if (std::abs(matrix.determinant() - 1) > rounding)
        throw Error("{} has no direction in its two rows; leave the clip out, or make it anew", where);
    const Eigen::Quaterniond q = Eigen::Quaterniond(matrix).normalized();
    const Quaternion out{q.w(), q.x(), q.y(), q.z()};
    const bool other_half =
        before && q.w() * before->w + q.x() * before->x + q.y() * before->y + q.z() * before->z < 0;
    return other_half ? Quaternion{-out.w, -out.x, -out.y, -out.z} : out;
}

/// As in SMPL, the root turns about its own joint: its place in the rest pose only moves the body.
SkeletonMotion skeleton_of_rotations(const ExportClip& clip, std::size_t person) {
    const auto& motion = clip.motion;
    const auto joints = clip.body.topology.joints();
    SkeletonMotion out;
    out.topology = clip.body.topology;
    out.frames = motion.frames;
    out.slides.assign(joints, false);
    out.slides[0] = true;
    for (std::size_t j = 0; j < joints; ++j) {
        const float* offset = &clip.body.rest[j * 3];
        out.rest.push_back(j == 0 ? Point{} : Point{offset[0], offset[1], offset[2]});
    }
    for (std::size_t t = 0; t < motion.frames; ++t) {
        const float* moved = motion.at(t, person, joints);
        for (std::size_t j = 0; j < joints; ++j) {
            const auto* before = t > 0 ? &out.rotation[(t - 1) * joints + j] : nullptr;
            out.rotation.push_back(quaternion_of(
                rotation_of(motion.at(t, person, j)), before,
                fmt::format("{}: the rotation of {} in frame {}", clip.name, out.topology.names[j], t + 1)));
            out.position.push_back(out.rest[j]);
        }
        for (std::size_t d = 0; d < 3; ++d)
            out.position[t * joints][d] = double{moved[d]} + clip.body.rest[d];
    }
    return out;
}

}  // namespace

std::vector<Point> clip_joints(const ExportClip& clip) {
    if (clip.body.representation == Representation::limb) return joints_of_limbs(clip);
    const auto joints = joint_positions(clip.motion, clip.body);
    std::vector<Point> out;
    out.reserve(joints.size() / 3);
    for (std::size_t i = 0; i < joints.size(); i += 3)
        out.push_back({joints[i], joints[i + 1], joints[i + 2]});
    return out;
}

std::vector<Point> rest_pose(const ExportClip& first) {
    const auto& topology = first.body.topology;
    auto pose = t_pose(topology);
    if (!pose.empty()) return pose;
    const auto joints = clip_joints(first);
    pose.assign(topology.joints(), Point{});
    for (std::size_t j = 1; j < pose.size(); ++j)
        for (std::size_t d = 0; d < 3; ++d)
            pose[j][d] = joints[j][d] - joints[static_cast<std::size_t>(topology.parents[j])][d];
    return pose;
}

std::vector<SkeletonMotion> skeletons_of(const ExportClip& clip, const std::vector<Point>& pose) {
    const std::size_t persons = clip.motion.persons, joints = clip.body.topology.joints();
    std::vector<SkeletonMotion> out;
    if (clip.body.representation == Representation::rot6d) {
        for (std::size_t p = 0; p < persons; ++p) out.push_back(skeleton_of_rotations(clip, p));
        return out;
    }
    const auto all = clip_joints(clip);
    std::vector<Point> own(clip.motion.frames * joints);
    for (std::size_t p = 0; p < persons; ++p) {
        for (std::size_t t = 0; t < clip.motion.frames; ++t)
            for (std::size_t j = 0; j < joints; ++j)
                own[t * joints + j] = all[(t * persons + p) * joints + j];
        out.push_back(minimal_twist(clip.body.topology, own, pose));
    }
    return out;
}

}  // namespace actformer::ingest
