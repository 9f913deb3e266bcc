// What is done in each of BABEL's 120 most frequent categories.
#pragma once

#include <span>
#include <string_view>
#include <vector>

#include "ingest/synth/performer/programme.hpp"

namespace actformer::ingest::synth {

struct Act {
    std::string_view category;
    const Programme* programme;
    std::vector<std::string_view> also;  ///< categories that such a segment has besides
};

/// In the order of how often they occur.
std::span<const Act> acts();

}  // namespace actformer::ingest::synth
