// From a posture to joints: trunk by forward kinematics, legs and arms by two-bone inverse kinematics.
#pragma once

#include <array>

#include "ingest/synth/performer/body.hpp"
#include "ingest/synth/performer/programme.hpp"

namespace actformer::ingest::synth {

/// How one performer holds himself, all the time.
struct Bearing {
    double stance = 0.09;      ///< half the distance between the feet, metres
    double toe_out = 9;        ///< degrees
    double slouch = 3;         ///< forward bend, degrees
    double chin = 2;           ///< nod, degrees
    double arms_out = 0.08;    ///< hanging hands beside the shoulders, metres
    double elbow_bend = 0.95;  ///< reach of a hanging arm
};

/// A foot on the floor or on its way: the ankle's place, y above its height when standing.
struct Foot {
    Vec place;
    double heading = 0, toes_down = 0;
    double slack = 0;  ///< how far the pelvis may rise beyond the leg's reach: 0 for a foot that bears weight
};

/// Where a body is on the stage.
struct Place {
    Vec position;  ///< on the floor
    double heading = 0;
};

struct Figure {
    Joints at;
    Rotation hips, ribs, skull,
        upright;  ///< frames of pelvis, chest and head, and the chest's without its lean
};

/// How far the pelvis must sink for both feet to be in reach, metres.
double sink_needed(const Body& body, const Bearing& bearing, const Place& place, const Posture& posture,
                   const std::array<Foot, 2>& feet);

/// Everything but the arms, the pelvis lowered by `sink`.
Figure stand(const Body& body, const Bearing& bearing, const Place& place, const Posture& posture,
             const std::array<Foot, 2>& feet, double sink);

/// What hands of two persons can be sent to besides their own body.
struct Others {
    const Figure* partner = nullptr;
    Vec meeting;     ///< midway between the chests
    Rotation stage;  ///< x to the first person's left, z to the second
};

/// Which way each elbow points from the line between shoulder and hand, in the frame before; zero at the
/// start.
using Elbows = std::array<Vec, 2>;

/// The arms. `shift` moves each hand's goal a little (metres, stage axes). Elbows come around without haste.
void reach(Figure& figure, const Body& body, const Bearing& bearing, const Place& place,
           const Posture& posture, const Others& others, const std::array<Vec, 2>& shift, Elbows& elbows);

}  // namespace actformer::ingest::synth
