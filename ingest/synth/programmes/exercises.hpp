// The 40 aerobic exercises of UESTC's RGB-D action dataset (Ji et al. 2018).
#pragma once

#include <vector>

#include "ingest/synth/programmes/everyday.hpp"

namespace actformer::ingest::synth {

/// In the order of the classes, called as in the dataset's action_classes.txt.
const std::vector<NamedProgramme>& exercises();

}  // namespace actformer::ingest::synth
