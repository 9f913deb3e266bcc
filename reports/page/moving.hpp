// Motions for the page's viewer: joint positions in 16 bits a number.
#pragma once

#include <nlohmann/json.hpp>

#include "reports/motions/joint_motion.hpp"

namespace actformer::reports {

/// {"label", "title", "persons", "frames", "fps", "origin": [x, y, z], "scale", "xyz"}: every `step`-th of the first `frames`
/// frames, position = origin + scale * whole number, metres. A body that is not there in a frame stays where it was last seen.
nlohmann::ordered_json packed_motion(const JointMotion& motion, std::uint32_t frames, std::uint32_t step = 1);

/// {"parents", "names"}
nlohmann::ordered_json topology_json(const ingest::Topology& topology);

}  // namespace actformer::reports
