// Clips whose persons do not move, in words that formats share.
#pragma once

#include <fmt/format.h>

#include <algorithm>
#include <cstdint>
#include <string>
#include <vector>

namespace actformer::ingest {

/// Doubts about a clip of `frames` frames; `still` tells of each person whether nothing changes over them.
inline std::vector<std::string> stillness_doubts(std::uint32_t frames, const std::vector<bool>& still) {
    if (frames == 1) return {"a single frame holds no motion"};
    if (std::find(still.begin(), still.end(), false) == still.end()) return {"nothing moves"};
    std::vector<std::string> doubts;
    for (std::size_t p = 0; p < still.size(); ++p)
        if (still[p]) doubts.push_back(fmt::format("person {} does not move", p + 1));
    return doubts;
}

}  // namespace actformer::ingest
