// A stand-in for NTU-13: VIBE's output for 13 actions of NTU RGB+D, a pickle a video.
#pragma once

#include "ingest/synth/stand_in.hpp"

namespace actformer::ingest::synth {

/// ntu_vibe_list.txt, a path a line, and ntu_vibe/NAME.pkl: a dictionary person -> VIBE's arrays, of which person 1 acts. `verts`, the
/// body's surface, is None.
StandInSummary synthesise_ntu13(const StandInOptions& options);

}  // namespace actformer::ingest::synth
