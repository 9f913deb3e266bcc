// What is done in the 120 actions of NTU RGB+D.
#pragma once

#include <vector>

#include "ingest/synth/performer/programme.hpp"

namespace actformer::ingest::synth {

/// The programme of action 1..120.
const Programme& programme_of(int action);

// The tables, a file each.
std::vector<Programme> daily_programmes();     // 1-49
std::vector<Programme> further_programmes();   // 61-105
std::vector<Programme> together_programmes();  // 50-60 and 106-120

}  // namespace actformer::ingest::synth
