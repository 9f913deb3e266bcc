// Two persons who fight: the first attacks, the other is hit, gives way, or falls.
#pragma once

#include <vector>

#include "ingest/synth/performer/programme.hpp"

namespace actformer::ingest::synth {

const std::vector<Programme>& fights();

/// One person beside a fight, who keeps a guard.
const std::vector<Programme>& onlookers();

}  // namespace actformer::ingest::synth
