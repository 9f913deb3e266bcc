// What a Kinect v2 makes of a performance: camera axes, jitter, joints out of sight, lost and imagined
// bodies.
#pragma once

#include "ingest/synth/ntu/performance.hpp"

namespace actformer::ingest::synth {

enum class Tracking : int { lost = 0, inferred = 1, tracked = 2 };

struct Quaternion {
    double w = 0, x = 0, y = 0, z = 0;
};

struct SeenJoint {
    Vec at;  ///< camera axes, metres
    Quaternion orientation;
    Tracking tracking = Tracking::tracked;
};

struct SeenBody {
    std::uint64_t id = 0;
    std::array<int, 6>
        flags{};  ///< clippedEdges, left hand confidence and state, right the same, isRestricted
    double lean_x = 0, lean_y = 0;
    std::array<SeenJoint, joints> joint;
};

/// Bodies a frame, in the order of the file.
using Recording = std::vector<std::vector<SeenBody>>;

/// As seen by camera 1, 2 or 3 (-45, 0 and +45 degrees) of the setup.
Recording record(const Performance& performance, const NtuCasting& casting, int camera);

/// Where the camera of a setup stands: the true joints in its axes. Without noise, for tests and pictures.
std::vector<std::array<Joints, 2>> viewed(const Performance& performance, int setup, int camera);

}  // namespace actformer::ingest::synth
