// The 22 joints of GTA Combat and of JTA (Fabbri et al. 2018), from which it was made.
#pragma once

#include <array>

#include "ingest/synth/performer/pose.hpp"

namespace actformer::ingest::synth {

inline constexpr std::size_t gta_joints = 22;

/// pelvis, middle of the head, neck, right collar to wrist, left collar to wrist, spine0 to spine3 (the lowest), top of the head, right
/// hip to ankle, left hip to ankle.
inline constexpr std::array<int, gta_joints> gta_parents{-1, 2,  11, 2, 3, 4, 5,  2,  7, 8,  9,
                                                         12, 13, 14, 0, 1, 0, 16, 17, 0, 19, 20};

/// Metres to the parent.
inline constexpr std::array<double, gta_joints> gta_lengths{
    0,     0.114, 0.244, 0.0585, 0.166, 0.267, 0.253, 0.0585, 0.166, 0.267, 0.253,
    0.116, 0.074, 0.071, 0.023,  0.114, 0.118, 0.411, 0.404,  0.118, 0.411, 0.404};

using GtaPlaces = std::array<Vec, gta_joints>;

/// The body with these lengths: everybody has it.
Body gta_body();

/// Where the joints of a figure with gta_body() are, metres. Limbs have gta_lengths, and legs are the figure's own.
GtaPlaces gta_places(const Figure& figure);

/// Sides exchanged.
GtaPlaces mirrored(const GtaPlaces& places);

}  // namespace actformer::ingest::synth
