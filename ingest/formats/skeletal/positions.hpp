// What the position channels of joints below the root mean. Some files write a joint's place in its parent there, which takes the
// place of its OFFSET; some write what is to be added to the OFFSET; some write noise.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "ingest/formats/skeletal/skeleton.hpp"

namespace actformer::ingest {

/// `told`: they replace, but a recording in which that would make limbs vanish is refused.
enum class Positions : std::uint8_t { told, replace, add, ignore };

std::optional<Positions> positions_named(std::string_view name);
std::string_view name_of(Positions positions);

/// Names of the kept joints whose limbs would vanish if their positions replaced their OFFSETs: in every frame the positions are
/// within a tenth of the OFFSET's length of 0, so they are to be added, or they are noise.
std::vector<std::string> joints_that_vanish(const Recording& recording, const Skeleton& skeleton);

/// Writes the places of the joints below the root into their position channels. The root's own positions are always its place.
void settle_positions(Recording& recording, const Skeleton& skeleton, Positions positions);

}  // namespace actformer::ingest
