// JTA's annotations of a sequence (Fabbri et al. 2018): a JSON list of rows
// [frame, person, joint, x2d, y2d, x3d, y3d, z3d, occluded, self-occluded], metres in the camera's frame, y down.
#pragma once

#include <cstdint>
#include <string_view>
#include <variant>
#include <vector>

#include "ingest/formats/format.hpp"

namespace actformer::ingest {

/// A person, where all 22 joints are told.
struct JtaPerson {
    std::int64_t id = 0;
    std::vector<std::uint32_t> times;  ///< rising; frames from the file's first on
    std::vector<double> positions;     ///< (times, 22, 3) metres, in JTA's order and frame
};

struct JtaFile {
    std::uint32_t frames = 0;        ///< from the first to the last that has a row
    std::vector<JtaPerson> persons;  ///< those seen in some frame, by their number
    std::size_t incomplete = 0;      ///< how many others there are: no frame tells all their joints
};

/// Throws nothing for what is in the text, which 64 zero bytes follow. A rejection names the row.
std::variant<JtaFile, Rejection> read_jta(std::string_view text);

}  // namespace actformer::ingest
