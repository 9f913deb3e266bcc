// A stand-in for GTA Combat: groups of 2 to 5 persons who fight in pairs, in the published files' layout.
#pragma once

#include <vector>

#include "ingest/synth/gta/gta_skeleton.hpp"
#include "ingest/synth/stand_in.hpp"

namespace actformer::ingest::synth {

/// gta_combat_{2,3,4,5}p.h5 with a dataset NNNNN_A001 a clip: (3 P, 22, T) float32, z up; node 0 is the root's position about the group's
/// mean, x and y divided by 5, the others are unit limb vectors. gta_adjacency.h5 has parent and adjacency (22, 22) and avglength (22).
StandInSummary synthesise_gta(const StandInOptions& options);

/// Frames of all persons of a clip, on the stage: y up, metres, the floor y = 0.
using GtaClip = std::vector<std::vector<GtaPlaces>>;

/// Pairs that fight, each by itself; where the number is odd, one who keeps a guard beside them.
GtaClip gta_clip(std::size_t persons, std::uint64_t number, std::uint64_t seed);

}  // namespace actformer::ingest::synth
