#pragma once

#include <utility>
#include <vector>

#include "ingest/formats/format.hpp"

namespace actformer::test {

/// All that a file gives.
struct Collected : ingest::ClipSink {
    void take(ingest::ParsedClip clip) override { clips.push_back(std::move(clip)); }
    std::vector<ingest::ParsedClip> clips;
};

}  // namespace actformer::test
