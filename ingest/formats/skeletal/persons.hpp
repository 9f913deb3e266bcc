// Skeletons of several persons, whose joints often differ in a prefix or a suffix: Hips and Hips2, A_Hips and B_Hips.
#pragma once

#include <string>
#include <variant>

#include "ingest/formats/skeletal/skeleton.hpp"

namespace actformer::ingest {

/// The joints of `person` that make up `wanted`, by their names; where those do not fit, by names less what the person's root has
/// more or less than the wanted root, which then become the wanted names in `person` too. Else what is different.
std::variant<Skeleton, std::string> find_skeleton(Recording& person, const Topology& wanted);

}  // namespace actformer::ingest
