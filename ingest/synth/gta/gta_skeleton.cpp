#include "ingest/synth/gta/gta_skeleton.hpp"

#include <cmath>

#include "ingest/synth/rotation_vector.hpp"

namespace actformer::ingest::synth {
namespace {

enum GtaJoint : std::size_t {
    hips22,
    head_centre,
    neck22,
    right_collar22,
    right_shoulder22,
    right_elbow22,
    right_wrist22,
    left_collar22,
    left_shoulder22,
    left_elbow22,
    left_wrist22,
    spine0,
    spine1_22,
    spine2_22,
    spine3_22,
    head_top,
    right_hip22,
    right_knee22,
    right_ankle22,
    left_hip22,
    left_knee22,
    left_ankle22
};

constexpr double hip_drop = 0.076, collar_drop = 0.8;  // the latter of the collar's length

}  // namespace

Body gta_body() {
    Body body;
    body.height = 1.76;
    body.hip_drop = hip_drop;
    body.hip = std::sqrt(gta_lengths[left_hip22] * gta_lengths[left_hip22] - hip_drop * hip_drop);
    body.thigh = gta_lengths[left_knee22];
    body.shin = gta_lengths[left_ankle22];
    body.upper_arm = gta_lengths[left_elbow22];
    body.forearm = gta_lengths[left_wrist22];
    body.hanging = 0.965;
    const double spine = gta_lengths[spine3_22] + gta_lengths[spine2_22] + gta_lengths[spine1_22] +
                         gta_lengths[spine0] + gta_lengths[neck22];
    const double shoulders = spine - collar_drop * gta_lengths[left_collar22];
    body.lower_spine = 0.25;
    body.upper_spine = shoulders + body.shoulder_drop - body.lower_spine;
    body.shoulder = 0.6 * gta_lengths[left_collar22] + gta_lengths[left_shoulder22];
    body.neck = spine - body.lower_spine - body.upper_spine;
    body.head = 0.15;
    return body;
}

GtaPlaces gta_places(const Figure& f) {
    GtaPlaces at;
    const auto limb = [&](std::size_t joint, const Vec& towards) {
        at[joint] =
            at[static_cast<std::size_t>(gta22_parents[joint])] + normalised(towards) * gta_lengths[joint];
    };
    at[hips22] = f.at[pelvis];
    double part = 0.15;  // of the way from the hips' frame to that of the ribs
    for (const auto joint : {spine3_22, spine2_22, spine1_22, spine0}) {
        limb(joint, slerp(f.hips, f.ribs, part).y);
        part += 0.25;
    }
    limb(neck22, f.ribs.y);
    limb(head_centre, f.skull * Vec{0, 1, 0.15});
    limb(head_top, f.skull.y);
    for (const bool left : {true, false}) {
        const double side = left ? 1 : -1;
        const auto collar = left ? left_collar22 : right_collar22,
                   shoulder = left ? left_shoulder22 : right_shoulder22,
                   elbow = left ? left_elbow22 : right_elbow22, wrist = left ? left_wrist22 : right_wrist22,
                   hip = left ? left_hip22 : right_hip22, knee = left ? left_knee22 : right_knee22,
                   ankle = left ? left_ankle22 : right_ankle22;
        limb(collar, f.ribs * Vec{0.6 * side, -collar_drop, 0});
        // The shoulder against the chest, which is where the neck less the collar's drop is.
        const Vec chest_here = at[neck22] - f.ribs.y * (collar_drop * gta_lengths[collar] - 0.02);
        const Vec own_shoulder = f.at[left ? left_shoulder : right_shoulder];
        limb(shoulder, chest_here + (own_shoulder - f.at[chest]) - at[collar]);
        limb(elbow, f.at[left ? left_elbow : right_elbow] - own_shoulder);
        limb(wrist, f.at[left ? left_wrist : right_wrist] - f.at[left ? left_elbow : right_elbow]);
        limb(hip, f.at[left ? left_hip : right_hip] - f.at[pelvis]);
        limb(knee, f.at[left ? left_knee : right_knee] - f.at[left ? left_hip : right_hip]);
        limb(ankle, f.at[left ? left_ankle : right_ankle] - f.at[left ? left_knee : right_knee]);
    }
    return at;
}

GtaPlaces mirrored(const GtaPlaces& places) {
    static constexpr std::array<std::size_t, gta_joints> twin{0,  1,  2,  7,  8,  9,  10, 3,  4,  5,  6,
                                                              11, 12, 13, 14, 15, 19, 20, 21, 16, 17, 18};
    GtaPlaces out;
    for (std::size_t j = 0; j < gta_joints; ++j) out[twin[j]] = {-places[j].x, places[j].y, places[j].z};
    return out;
}

}  // namespace actformer::ingest::synth
