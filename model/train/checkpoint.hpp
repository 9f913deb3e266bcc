// Checkpoints: what a training needs to go on exactly where it was. Written aside and renamed; the one before is kept.
//
// folder/checkpoint-NNNNN.h5, NNNNN the steps done: HDF5 with one float32 or float64 dataset an array, `progress` (JSON, the
// state) and the attribute `step`; behind it a line with the checksum of all bytes before, which HDF5's readers pass over.
#pragma once

#include <filesystem>
#include <functional>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "model/nn/array.hpp"

namespace actformer::model {

struct Checkpoint {
    std::uint64_t step = 0;        ///< steps done
    nlohmann::ordered_json state;  ///< of the trainer: `model`, counters, scores, fingerprints
    std::vector<Array> arrays;     ///< as read, by name
};

std::filesystem::path checkpoint_path(const std::filesystem::path& folder, std::uint64_t step);

/// Writes checkpoint_path() and removes all but it and the one before; what cannot be removed stays. Throws Error where it cannot be written.
void save_checkpoint(const std::filesystem::path& folder, const Checkpoint& checkpoint);

/// None where the file is cut short, damaged, or of another kind.
std::optional<Checkpoint> read_checkpoint(const std::filesystem::path& file);

/// The newest whole checkpoint in `folder`; none where there is none. `note` hears of every damaged one that was passed over,
/// which stays as NAME.damaged, and of one of an earlier version that was. Throws Error where it is of another model than `model`, or there are
/// only some of an earlier version.
std::optional<Checkpoint> newest_checkpoint(const std::filesystem::path& folder, const std::string& model,
                                            const std::function<void(const std::string&)>& note);

}  // namespace actformer::model
