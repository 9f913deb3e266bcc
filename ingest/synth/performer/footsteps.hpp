// Where the feet go when a body moves about: planted while it passes over them, swung in between.
#pragma once

#include <vector>

#include "ingest/synth/performer/pose.hpp"

namespace actformer::ingest::synth {

struct Gait {
    std::vector<std::array<Foot, 2>> feet;  ///< a frame
    std::vector<double> swing;              ///< -1..1: positive where the right arm swings forward
};

/// `leg` is the length of the legs in metres, `cadence` the most steps a second.
Gait walk(const std::vector<Place>& places, const Bearing& bearing, double leg, double cadence);

}  // namespace actformer::ingest::synth
