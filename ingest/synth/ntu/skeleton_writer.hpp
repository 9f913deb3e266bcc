// Writes the text of a .skeleton file as the Kinect capture tool of NTU RGB+D did.
#pragma once

#include <string>

#include "ingest/synth/ntu/kinect.hpp"

namespace actformer::ingest::synth {

/// Replaces the contents of `text`.
void write_skeleton(const Recording& recording, std::string& text);

/// Appends `value` with at most seven significant digits, as printf's %.7g does between 1e-4 and 1e7.
void append_number(std::string& text, double value);

}  // namespace actformer::ingest::synth
