// A licence-free stand-in for NTU RGB+D: genuine .skeleton files of invented performances.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "ingest/synth/ntu/naming.hpp"

namespace actformer::ingest::synth {

struct NtuOptions {
    std::filesystem::path folder;
    std::uint64_t clips = 1200;
    std::uint64_t seed = 1;
    std::vector<int> actions;  ///< empty: all 120
    unsigned threads = 0;      ///< 0: one a processor
};

struct NtuSummary {
    std::uint64_t clips = 0;              ///< in the set
    std::uint64_t written = 0;            ///< now; the others were there already
    std::uint64_t frames = 0, bytes = 0;  ///< of the clips written
};

/// Writes clips into the folder, each file whole or not at all. Clips that are there from an earlier run with
/// the same seed are kept. `progress` is told how many are done. The bytes of a clip depend on its name and
/// the seed alone. Throws Error naming the file and the remedy, also for a folder that holds .skeleton files that these options do not make.
NtuSummary synthesise_ntu(const NtuOptions& options, const std::function<void(std::uint64_t)>& progress = {});

/// The text of one clip.
std::string skeleton_text(const ClipId& clip, std::uint64_t seed);

}  // namespace actformer::ingest::synth
