#include "ingest/synth/vibe.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace actformer::ingest::synth {
namespace {

constexpr double focal_length = 500, half_height = 270, aspect = 16.0 / 9;

/// The rotation of joint `j` on the stage.
Rotation world(const SmplPose& pose, std::size_t j) {
    Rotation out = pose.turned[j];
    for (int above = smpl24_parents[j]; above >= 0; above = smpl24_parents[static_cast<std::size_t>(above)])
        out = pose.turned[static_cast<std::size_t>(above)] * out;
    return out;
}

}  // namespace

std::vector<Vec> vibe_joints(const SmplPose& pose) {
    const auto at = smpl_places(pose);
    const Rotation skull = world(pose, 15), left_sole = world(pose, 7), right_sole = world(pose, 8);
    const auto face = [&](double x, double y, double z) { return at[15] + skull * Vec{x, y, z}; };
    const auto left = [&](double x, double y, double z) { return at[7] + left_sole * Vec{x, y, z}; };
    const auto right = [&](double x, double y, double z) { return at[8] + right_sole * Vec{x, y, z}; };
    const Vec hips = lerp(at[1], at[2], 0.5), nose = face(0, 0.06, 0.12), left_eye = face(0.03, 0.09, 0.1),
              right_eye = face(-0.03, 0.09, 0.1), left_ear = face(0.075, 0.07, 0.01),
              right_ear = face(-0.075, 0.07, 0.01);
    return {nose,
            at[12],
            at[17],
            at[19],
            at[21],
            at[16],
            at[18],
            at[20],
            hips,
            at[2],
            at[5],
            at[8],
            at[1],
            at[4],
            at[7],
            right_eye,
            left_eye,
            right_ear,
            left_ear,
            left(0.01, -0.06, 0.18),
            left(0.06, -0.06, 0.14),
            left(0, -0.06, -0.05),
            right(-0.01, -0.06, 0.18),
            right(-0.06, -0.06, 0.14),
            right(0, -0.06, -0.05),
            at[8],
            at[5],
            at[2],
            at[1],
            at[4],
            at[7],
            at[21],
            at[19],
            at[17],
            at[16],
            at[18],
            at[20],
            at[12],
            face(0, 0.2, 0),
            at[0],
            lerp(at[9], at[12], 0.5),
            at[6],
            face(0, 0, 0.09),
            face(0, 0.09, 0),
            nose,
            left_eye,
            right_eye,
            left_ear,
            right_ear};
}

VibeTrack vibe_track(const SmplMotion& motion) {
    VibeTrack out;
    out.frames = motion.size();
    for (const auto& pose : motion) {
        for (const double v : rotation_vectors(pose)) out.pose.push_back(static_cast<float>(v));
        constexpr double far = std::numeric_limits<double>::max();
        double left = far, right = -far, top = far, bottom = -far;
        for (const auto& joint : vibe_joints(pose)) {
            const Vec from = joint - pose.pelvis;
            for (const double v : {from.x, from.y, from.z}) out.joints3d.push_back(static_cast<float>(v));
            left = std::min(left, joint.x), right = std::max(right, joint.x);
            top = std::min(top, joint.y), bottom = std::max(bottom, joint.y);
        }
        // A pixel is half_height * (scale * (x + tx) + 1) there, and focal_length * x / z + half_height before a pinhole.
        const double scale = focal_length / (half_height * pose.pelvis.z), pixels = half_height * scale;
        for (const double v : {scale, scale * aspect, pose.pelvis.x, pose.pelvis.y})
            out.orig_cam.push_back(static_cast<float>(v));
        out.pred_cam.insert(out.pred_cam.end(), {0.9F, 0, 0});
        const double size = 1.1 * std::max(right - left, bottom - top) * pixels;
        out.bboxes.insert(out.bboxes.end(), {half_height * aspect + pixels * (left + right) / 2,
                                             half_height + pixels * (top + bottom) / 2, size, size});
    }
    return out;
}

}  // namespace actformer::ingest::synth
