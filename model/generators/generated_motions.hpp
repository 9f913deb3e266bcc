// A generator's motions on their way to a recogniser, without a file between. Includes no torch headers.
#pragma once

#include "eval/scoring/motion_source.hpp"

namespace actformer::model {

/// Sets of motions by the seeds request.seed, request.seed + 1, ...: numbers, names and order are those of a file that
/// `generate` would write. The weights are read once. Throws Error as load_generator does, and for a label out of range; a
/// set's source, for numbers that are not finite.
std::vector<eval::MotionSet> generated_sets(const eval::GeneratedRequest& request);

}  // namespace actformer::model
