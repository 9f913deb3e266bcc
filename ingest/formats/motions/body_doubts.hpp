// What is doubtful about how tall bodies are and which way they stand, in words that clips share.
#pragma once

#include <string>
#include <vector>

#include "ingest/dataset/height.hpp"
#include "ingest/formats/motions/clip_positions.hpp"

namespace actformer::ingest {

/// Of joint positions read as `request` says, with the option that mends each.
std::vector<std::string> body_doubts(const BodyHeight& height, const PositionsRequest& request);

/// Of motions in the public layout, which no option scales or turns.
std::vector<std::string> stored_body_doubts(const BodyHeight& height, const Topology& topology);

}  // namespace actformer::ingest
