// The attributes of recognisers' weights files, as weights_reader.hpp reads them.
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "eval/weights_reader.hpp"

namespace actformer::hdf5 {
class Writer;
}

namespace actformer::eval {

/// Writes `kind` ("stgcn", "gru"), `representation`, `class_names` where there are any, `channels`, `classes`, `parents`, and `center`, a
/// node of an ST-GCN's graph, where it is given. Throws Error where the file cannot be written.
void write_recogniser_attributes(hdf5::Writer& file, const std::string& kind,
                                 const RecogniserAttributes& about, std::optional<std::uint32_t> center = {});

}  // namespace actformer::eval
