// A training's curves for TensorBoard: event files, records of TFRecord's frame around tensorflow.Event messages.
#pragma once

#include <nlohmann/json.hpp>
#include <string>

namespace actformer::model {

/// What an event file begins with. `time`: seconds since 1970, here and below.
std::string tensorboard_head(double time);

/// The numbers of a line of log.jsonl as scalars at its step, under their names there; empty for a line without a step or numbers.
std::string tensorboard_event(const nlohmann::ordered_json& line, double time);

}  // namespace actformer::model
