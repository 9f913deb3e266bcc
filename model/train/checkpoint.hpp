// Checkpoints: what a training needs to go on exactly where it was. Written aside and renamed; the one before is kept.
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
    std::uint64_t done = 0;        ///< a recogniser's epochs, a generator's steps
    nlohmann::ordered_json state;  ///< of the trainer: `model`, counters, scores, fingerprints
    std::vector<Array> arrays;
};

/// The file's bytes: a line with the kind and version, a line with the checksum of the rest, a line of JSON, the numbers.
std::string to_bytes(const Checkpoint& checkpoint);

/// None where the bytes are cut short, damaged, or of another kind.
std::optional<Checkpoint> checkpoint_from(std::string_view bytes);

/// Writes folder/checkpoint-NNNNN and removes all but it and the one before. Throws Error where it cannot be written.
void save_checkpoint(const std::filesystem::path& folder, const Checkpoint& checkpoint);

/// The newest whole checkpoint in `folder`; none where there is none. `note` hears of every damaged one that was passed over,
/// which stays as NAME.damaged. Throws Error where it is of another model than `model`, or another version's.
std::optional<Checkpoint> newest_checkpoint(const std::filesystem::path& folder, const std::string& model,
                                            const std::function<void(const std::string&)>& note);

}  // namespace actformer::model
