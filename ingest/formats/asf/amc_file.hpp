// Acclaim's motions (.amc) of a skeleton (.asf).
#pragma once

#include <string_view>
#include <variant>

#include "ingest/formats/asf/asf_file.hpp"
#include "ingest/formats/skeletal/recording.hpp"

namespace actformer::ingest {

/// CMU's recordings; an .amc does not say its rate.
inline constexpr double amc_frame_time = 1.0 / 120;

/// Reads a whole file. A joint is a bone's end and bears the bone's name; the root is called "root". What a bone's numbers turn about
/// its own axes is turned about z, y and x of its parent here. 64 zero bytes follow `text`. Throws nothing for what is in the text.
std::variant<Recording, Rejection> parse_amc(std::string_view text, const AsfSkeleton& skeleton);

}  // namespace actformer::ingest
