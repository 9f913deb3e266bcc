// The 22 joints of GTA Combat and of JTA (Fabbri et al. 2018), from which it was made.
#pragma once

#include <array>

#include "ingest/dataset/known_topologies.hpp"
#include "ingest/synth/performer/pose.hpp"

namespace actformer::ingest::synth {

/// Metres to the parent in gta22().
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
