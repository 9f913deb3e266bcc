// The frames that a label cuts out of a recording.
#pragma once

#include <algorithm>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace actformer::ingest {

/// Frames first .. last - 1, which are there.
struct FrameSpan {
    std::uint32_t first = 0, last = 0;
    bool past_end = false;  ///< the label ends behind the recording

    bool empty() const { return first >= last; }

    /// What is doubtful about a clip of these frames, if anything is.
    void add_doubts(std::vector<std::string>& doubts) const {
        if (past_end) doubts.emplace_back("the label ends behind the motion: cut off there");
    }
};

/// Of a label from frame `start` on, and before frame `end` where it has one, in a recording of `frames`.
inline FrameSpan frame_span(std::optional<std::uint64_t> start, std::optional<std::uint64_t> end,
                            std::uint32_t frames) {
    const auto within = [&](std::uint64_t frame) {
        return static_cast<std::uint32_t>(std::min<std::uint64_t>(frame, frames));
    };
    return {within(start.value_or(0)), within(end.value_or(frames)), end && *end > frames};
}

}  // namespace actformer::ingest
