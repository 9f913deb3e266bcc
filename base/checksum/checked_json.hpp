// JSON objects whose member `checksum` is that of all others.
#pragma once

#include <nlohmann/json.hpp>

#include "base/checksum/own_checksum.hpp"

namespace actformer {

/// `object` with its checksum behind the other members, in place of one that it had.
nlohmann::ordered_json with_checksum(nlohmann::ordered_json object);

/// Neither spaces nor the order of members count. Wrong also where there is none and a member `program` names this program. Absent also of
/// what is no object.
OwnChecksum own_checksum_of(const nlohmann::ordered_json& object);

}  // namespace actformer
