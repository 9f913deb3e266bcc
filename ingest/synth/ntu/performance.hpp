// One action of NTU RGB+D performed once: true joint positions on the stage, before any camera sees them.
#pragma once

#include <cstdint>
#include <vector>

#include "ingest/synth/performer/body.hpp"

namespace actformer::ingest::synth {

struct Performance {
    int persons = 1;
    std::vector<std::array<Joints, 2>>
        frames;        ///< metres; the floor is y = 0, the middle of the stage x = z = 0
    int contact = -1;  ///< the frame at which two persons touch, if they do
};

/// What makes a performance the one it is; the camera does not.
struct NtuCasting {
    std::uint64_t seed = 1;
    int setup = 1, performer = 1, replication = 1, action = 1;
};

/// The second person of a two-person clip: never the performer himself, and on the same side of the xsub
/// protocol.
int partner_of(const NtuCasting& casting);

/// At 30 frames a second, 40 to 180 of them.
Performance perform(const NtuCasting& casting);

}  // namespace actformer::ingest::synth
