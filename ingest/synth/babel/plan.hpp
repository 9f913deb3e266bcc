// Which actions the recordings hold, and where they are kept.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace actformer::ingest::synth {

struct PlannedSequence {
    std::string folder, set, subject, trial;  ///< as in CMU/CMU/05/05_01
    bool validation = false;                  ///< of val.json
    double fps = 120;
    std::vector<std::size_t> acts;  ///< indices into acts()

    std::string feat_p() const;
};

/// So many actions in all, two to five a recording.
std::vector<PlannedSequence> plan(std::uint64_t actions, std::uint64_t seed);

/// How often each of `categories` occurs among `actions`: all alike up to eight times, and beyond that the c-th as 1 / (c + 4), counted
/// from 0.
std::vector<std::uint64_t> occurrences(std::uint64_t actions, std::size_t categories);

}  // namespace actformer::ingest::synth
