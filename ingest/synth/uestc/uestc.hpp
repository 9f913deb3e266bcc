// A stand-in for UESTC's videos as VIBE saw them: one pickle for all of them, and lists of their names and lengths.
#pragma once

#include "ingest/synth/stand_in.hpp"

namespace actformer::ingest::synth {

/// vibe_cache_refined.pkl: a dictionary of lists, an element a video; info/names.txt, info/num_frames_min.txt and
/// info/action_classes.txt. Subjects, sides and views take turns; videos of side 2 are turned by their view, and some are of view 8,
/// which goes round.
StandInSummary synthesise_uestc(const StandInOptions& options);

}  // namespace actformer::ingest::synth
