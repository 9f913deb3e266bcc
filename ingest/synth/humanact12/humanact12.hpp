// A stand-in for HumanAct12 as ACTOR reads it: one pickle with the clips' rotations, joints and classes.
#pragma once

#include "ingest/synth/stand_in.hpp"

namespace actformer::ingest::synth {

/// HumanAct12Poses/humanact12poses.pkl: a dictionary of lists, an element a clip: poses (T, 72) rad, joints3D (T, 24, 3) metres, y 0 to
/// 11; y is down. `oldposes` is empty, as in the original.
StandInSummary synthesise_humanact12(const StandInOptions& options);

}  // namespace actformer::ingest::synth
