// A training's log as curves.
#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>

namespace actformer::reports {

/// Whether a training has written a log there.
bool has_log(const std::filesystem::path& run);

struct Curves {
    nlohmann::ordered_json epochs = nlohmann::ordered_json::array();
    std::string fault;  ///< of lines that were left out, in a few words; empty where none was
};

/// The numbers that a training's log.jsonl says of its epochs: one object an epoch, lines of the same epoch joined; at most 500,
/// evenly chosen, the last among them. Empty where there is no log, or `run` is empty. A line that is being written is no fault. Throws
/// Error where the log cannot be read.
Curves read_curves(const std::filesystem::path& run);

/// The charts that epochs give, whatever was trained: {"points": epochs, "charts": [{"title", "unit", "from_zero", "series": [{"key",
/// "name"}]}]}. Losses share a chart, so do a discriminator's scores, and so does what measures one metric (accuracy and
/// train_accuracy); all else (seconds, rates) is left out. A series is called by what stands before "_loss" or the metric's name,
/// by `whole` where nothing does.
nlohmann::ordered_json curve_charts(const nlohmann::ordered_json& epochs, const std::string& whole);

}  // namespace actformer::reports
