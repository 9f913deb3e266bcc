#include "ingest/synth/smpl/smpl_pose.hpp"

#include <algorithm>
#include <cmath>

#include "ingest/synth/rotation_vector.hpp"

namespace actformer::ingest::synth {
namespace {

constexpr double standing_ankle = 0.075;  // above the sole, metres

/// Toes below the foot: they lie on the floor when the heel rises above them, and straighten as the ball of the foot leaves it.
Rotation toes_of(const Vec& along, const Vec& ball) {
    const Vec rest = normalised(smpl_offsets()[left_foot24]);
    const double heel_up = (std::asin(-along.y) - std::asin(-rest.y)) * 180 / pi;
    const double lifted = ease((ball.y - standing_ankle - smpl_offsets()[left_foot24].y) / 0.1);
    return about_x(-std::clamp(heel_up, 0.0, 50.0) * (1 - lifted));
}

/// A bone from `from` to `to` along -y, which bends about x as knees do.
void leg(SmplTurns& world, const Figure& f, bool left) {
    const Vec hip = f.at[left ? left_hip : right_hip], knee = f.at[left ? left_knee : right_knee],
              ankle = f.at[left ? left_ankle : right_ankle], toes = f.at[left ? left_foot : right_foot];
    const Vec thigh = normalised(knee - hip), shin = normalised(ankle - knee);
    const Vec hinge = normalised(cross(thigh, shin));
    const auto bone = [&](const Vec& along) {
        return Rotation{hinge, along * -1.0, cross(hinge, along * -1.0)};
    };
    world[left ? left_hip24 : right_hip24] = bone(thigh);
    world[left ? left_knee24 : right_knee24] = bone(shin);

    // The foot points as the figure's does and rolls to no side.
    const auto frame = [](const Vec& along, const Vec& across) {
        return Rotation{across, cross(along, across), along};
    };
    const Vec along = normalised(toes - ankle), across = normalised(cross({0, 1, 0}, along));
    const Vec rest = normalised(smpl_offsets()[left_foot24]);
    world[left ? left_ankle24 : right_ankle24] = frame(along, across) * inverse(frame(rest, {1, 0, 0}));
    world[left ? left_foot24 : right_foot24] =
        world[left ? left_ankle24 : right_ankle24] * toes_of(along, toes);
}

/// Arms of the rest pose lie along x. Elbows bend about y, so that hands come forward.
void arm(SmplTurns& world, const Figure& f, const Vec& collar, bool left) {
    const double side = left ? 1 : -1;
    const auto shoulder_joint = left ? left_shoulder24 : right_shoulder24;
    const Vec shoulder = f.at[left ? left_shoulder : right_shoulder],
              elbow = f.at[left ? left_elbow : right_elbow], wrist = f.at[left ? left_wrist : right_wrist],
              hand = f.at[left ? left_hand : right_hand], thumb = f.at[left ? left_thumb : right_thumb];
    const Rotation ribs = world[spine3];
    world[left ? left_collar : right_collar] =
        shortest_turn(normalised(ribs * smpl_offsets()[shoulder_joint]), normalised(shoulder - collar)) *
        ribs;

    const Vec upper = normalised(elbow - shoulder), lower = normalised(wrist - elbow);
    const Vec hinge = normalised(cross(upper, lower)) * -side;  // y of the bones
    const auto bone = [&](const Vec& along, const Vec& up) {
        const Vec x = along * side, y = normalised(reject(up, x));
        return Rotation{x, y, cross(x, y)};
    };
    world[shoulder_joint] = bone(upper, hinge);

    // The thumb of the rest pose points forward, along z. Half of the hand's turn about the forearm is the forearm's.
    const Vec fingers = normalised(hand - wrist);
    const Rotation straight = bone(lower, hinge);
    const Vec to_thumb = normalised(reject(thumb - hand, lower));
    const double roll = std::atan2(dot(cross(straight.z, to_thumb), lower), dot(straight.z, to_thumb));
    const auto rolled = [&](double part) { return turned(straight.y, lower, part * roll * 180 / pi); };
    world[left ? left_elbow24 : right_elbow24] = bone(lower, rolled(0.5));
    world[left ? left_wrist24 : right_wrist24] = bone(fingers, rolled(1));

    // Palms of the rest pose look down. SMPL's hands are without fingers: they bend by 0.4 of
    // what the figure's fingers do.
    const Vec tips = normalised(f.at[left ? left_tip : right_tip] - hand);
    const double curl = 0.4 * std::atan2(length(cross(fingers, tips)), dot(fingers, tips)) * 180 / pi;
    world[left ? left_hand24 : right_hand24] =
        world[left ? left_wrist24 : right_wrist24] * about_z(-side * curl);
}

}  // namespace

Body smpl_body() {
    const auto& o = smpl_offsets();
    Body body;
    body.height = 1.66;
    body.hip = o[left_hip24].x;
    body.hip_drop = -o[left_hip24].y;
    body.hip_ahead = o[left_hip24].z;
    body.thigh = length(o[left_knee24]);
    body.shin = length(o[left_ankle24]);
    body.foot = length(o[left_foot24]);
    body.ankle = standing_ankle;
    body.ball = -o[left_foot24].y / body.ankle;
    // The figure's chest is where the collars and shoulders of the rest pose are.
    const double spine = o[spine1].y + o[spine2].y + o[spine3].y,
                 shoulders = spine + o[left_collar].y + o[left_shoulder24].y;
    body.shoulder_drop = 0.02;
    body.lower_spine = o[spine1].y + o[spine2].y;
    body.upper_spine = shoulders + body.shoulder_drop - body.lower_spine;
    body.shoulder = o[left_collar].x + o[left_shoulder24].x;
    body.neck = spine + o[neck24].y - body.lower_spine - body.upper_spine;
    body.head = o[head24].y + 0.08;  // to the middle of the head
    body.upper_arm = o[left_elbow24].x;
    body.forearm = o[left_wrist24].x;
    body.hand = o[left_hand24].x;
    body.hanging = 0.968;
    return body;
}

SmplPose smpl_pose(const Figure& f) {
    SmplTurns world;
    world[pelvis24] = f.hips;
    world[spine1] = slerp(f.hips, f.ribs, 0.33);
    world[spine2] = slerp(f.hips, f.ribs, 0.67);
    world[spine3] = f.ribs;
    world[neck24] = slerp(f.ribs, f.skull, 0.4);
    world[head24] = f.skull;
    for (const bool left : {true, false}) {
        leg(world, f, left);
        // The figure's shoulder against its chest, from a collar that is below and inside of it.
        const Vec base = smpl_offsets()[left ? left_collar : right_collar] +
                         smpl_offsets()[left ? left_shoulder24 : right_shoulder24];
        const Vec at_rest = f.at[chest] + f.ribs * Vec{base.x, -0.02, 0};
        const Vec collar = at_rest - f.ribs * smpl_offsets()[left ? left_shoulder24 : right_shoulder24];
        arm(world, f, collar, left);
    }
    return smpl_pose(f.at[pelvis], world);
}

SmplPose mirrored(const SmplPose& pose) {
    static constexpr std::array<std::size_t, smpl_joints> twin{
        0, 2, 1, 3, 5, 4, 6, 8, 7, 9, 11, 10, 12, 14, 13, 15, 17, 16, 19, 18, 21, 20, 23, 22};
    SmplPose out;
    out.pelvis = {-pose.pelvis.x, pose.pelvis.y, pose.pelvis.z};
    for (std::size_t j = 0; j < smpl_joints; ++j) {
        const auto& r = pose.turned[j];
        out.turned[twin[j]] = {{r.x.x, -r.x.y, -r.x.z}, {-r.y.x, r.y.y, r.y.z}, {-r.z.x, r.z.y, r.z.z}};
    }
    return out;
}

const std::array<Vec, smpl_joints>& smpl_offsets() {
    static const auto all = [] {
        const auto numbers = generic_skeleton().offsets;
        std::array<Vec, smpl_joints> out;
        for (std::size_t j = 0; j < smpl_joints; ++j)
            out[j] = {numbers[3 * j], numbers[3 * j + 1], numbers[3 * j + 2]};
        return out;
    }();
    return all;
}

SmplPlaced smpl_placed(const SmplPose& pose) {
    SmplPlaced out;
    out.at[0] = pose.pelvis;
    out.world[0] = pose.turned[0];
    for (std::size_t j = 1; j < smpl_joints; ++j) {
        const auto parent = static_cast<std::size_t>(smpl24_parents[j]);
        out.at[j] = out.at[parent] + out.world[parent] * smpl_offsets()[j];
        out.world[j] = out.world[parent] * pose.turned[j];
    }
    return out;
}

SmplPose smpl_pose(const Vec& at, const SmplTurns& world) {
    SmplPose pose{at, world};
    for (std::size_t j = 1; j < smpl_joints; ++j)
        pose.turned[j] = inverse(world[static_cast<std::size_t>(smpl24_parents[j])]) * world[j];
    return pose;
}

std::array<Vec, smpl_joints> smpl_places(const SmplPose& pose) {
    return smpl_placed(pose).at;
}

}  // namespace actformer::ingest::synth
