// Names of clips: how N of them spread over setups, cameras, performers, replications and actions.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace actformer::ingest::synth {

constexpr int setups = 32, cameras = 3, performers = 106, replications = 2;

/// How many different clips one action can have.
constexpr std::uint64_t clips_per_action = std::uint64_t{setups} * cameras * performers * replications;

struct ClipId {
    int setup = 1, camera = 1, performer = 1, replication = 1, action = 1;

    /// As in S001C002P003R002A013.
    std::string name() const;
    bool operator==(const ClipId&) const = default;
};

/// Clip `i` of a set over `actions`: they take turns, and within each of them the sides of every protocol do.
/// No two numbers below actions.size() * clips_per_action give the same clip.
ClipId clip_at(std::uint64_t i, const std::vector<int>& actions);

}  // namespace actformer::ingest::synth
