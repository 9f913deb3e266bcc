// Forward kinematics of single frames in double precision, for looking at a recording before it is ingested.
#pragma once

#include <vector>

#include "ingest/formats/skeletal/matrix.hpp"
#include "ingest/formats/skeletal/recording.hpp"

namespace actformer::ingest {

/// Where every joint is in `frame` (joints), in the file's units, relative to Recording::origin. Position channels take the place of
/// OFFSETs, as on the device.
std::vector<Vector3> places_of(const Recording& recording, std::uint32_t frame);

}  // namespace actformer::ingest
