// The BVH format: a skeleton and the numbers that move it.
#pragma once

#include <string_view>
#include <variant>
#include <vector>

#include "ingest/formats/format.hpp"
#include "ingest/formats/skeletal/recording.hpp"

namespace actformer::ingest {

/// Reads a whole file: a recording for every ROOT, of equal frames. 64 zero bytes follow `text`. Throws nothing for what is in the
/// text. Refused beside what is malformed: two joints of one name below one ROOT, more than 4096 joints.
std::variant<std::vector<Recording>, Rejection> parse_bvh(std::string_view text);

}  // namespace actformer::ingest
