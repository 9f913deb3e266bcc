#include "ingest/synth/smpl/smpl_motion.hpp"

#include <algorithm>
#include <cmath>

#include "ingest/synth/rotation_vector.hpp"

namespace actformer::ingest::synth {
namespace {

SmplPose pose_between(const SmplPose& a, const SmplPose& b, double u) {
    SmplPose out;
    out.pelvis = lerp(a.pelvis, b.pelvis, u);
    for (std::size_t j = 0; j < smpl_joints; ++j) out.turned[j] = slerp(a.turned[j], b.turned[j], u);
    return out;
}

}  // namespace

SmplPlay smpl_play(const Programme& programme, const std::vector<std::uint64_t>& key,
                   const std::vector<std::uint64_t>& performers, const Life& life) {
    Casting casting{key, {}};
    for (int p = 0; p < programme.persons; ++p)
        casting.cast.push_back({smpl_body(), performers.at(static_cast<std::size_t>(p))});
    const auto played = play(programme, casting);
    SmplPlay out{std::vector<SmplMotion>(static_cast<std::size_t>(played.persons)), played.contact};
    for (std::size_t p = 0; p < out.persons.size(); ++p) {
        auto& motion = out.persons[p];
        for (const auto& figures : played.frames) motion.push_back(smpl_pose(figures[p]));
        enliven(motion, life, casting.stream(2 + p));
        if (played.mirrored)
            for (auto& pose : motion) pose = mirrored(pose);
    }
    return out;
}

SmplMotion smpl_solo(const Programme& programme, const std::vector<std::uint64_t>& key,
                     std::uint64_t performer, const Life& life) {
    return std::move(smpl_play(programme, key, {performer}, life).persons[0]);
}

void place(SmplMotion& motion, double heading, const Vec& way) {
    const auto turn = about_y(heading);
    for (auto& pose : motion) {
        pose.pelvis = turn * pose.pelvis + way;
        pose.turned[0] = turn * pose.turned[0];
    }
}

void place_before_camera(SmplMotion& motion, double heading, double aside, double distance) {
    place(motion, heading, {});
    Vec mean;
    double nearest = -1e9;
    for (const auto& pose : motion) {
        mean += pose.pelvis * (1.0 / static_cast<double>(motion.size()));
        nearest = std::max(nearest, pose.pelvis.z);
    }
    place(motion, 0, {aside - mean.x, -1, -distance - nearest});
}

double heading_of(const SmplPose& pose) {
    // Of the body's left, which stays level when it bends.
    const Vec left = pose.turned[0].x;
    return std::atan2(-left.z, left.x) * 180 / pi;
}

void go_on(SmplMotion& motion, SmplMotion next, std::size_t steps) {
    if (!motion.empty() && !next.empty()) {
        const auto last = motion.back();
        const double turn = heading_of(last) - heading_of(next.front());
        const Vec there = about_y(turn) * next.front().pelvis;
        place(next, turn, {last.pelvis.x - there.x, 0, last.pelvis.z - there.z});
        for (std::size_t i = 1; i <= steps; ++i)
            motion.push_back(pose_between(last, next.front(),
                                          ease(static_cast<double>(i) / static_cast<double>(steps + 1))));
    }
    motion.insert(motion.end(), next.begin(), next.end());
}

SmplMotion resampled(const SmplMotion& motion, double fps) {
    SmplMotion out;
    if (motion.empty()) return out;
    const auto last = static_cast<double>(motion.size() - 1);
    for (std::size_t i = 0; static_cast<double>(i) * play_fps <= last * fps + 1e-6; ++i) {
        const double at = std::min(static_cast<double>(i) * play_fps / fps, last);
        const auto before = static_cast<std::size_t>(at);
        out.push_back(pose_between(motion[before], motion[std::min(before + 1, motion.size() - 1)],
                                   at - static_cast<double>(before)));
    }
    return out;
}

SmplMotion in_axes(const SmplMotion& motion, const Rotation& axes) {
    auto out = motion;
    for (auto& pose : out) {
        pose.pelvis = axes * pose.pelvis;
        pose.turned[0] = axes * pose.turned[0];
    }
    return out;
}

std::vector<double> rotation_vectors(const SmplPose& pose) {
    std::vector<double> out;
    for (const auto& turned : pose.turned) {
        const auto v = rotation_vector(turned);
        out.insert(out.end(), {v.x, v.y, v.z});
    }
    return out;
}

}  // namespace actformer::ingest::synth
