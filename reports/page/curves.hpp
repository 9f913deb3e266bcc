// A training's log as curves.
#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>

namespace actformer::reports {

/// The numbers that a training's log.jsonl says of its epochs: one object an epoch, `keys` only, lines of the same epoch joined; at
/// most 500, evenly chosen, the last among them. Empty where there is no log; lines that cannot be read are passed over.
nlohmann::ordered_json read_curves(const std::filesystem::path& run, const std::vector<std::string>& keys);

}  // namespace actformer::reports
