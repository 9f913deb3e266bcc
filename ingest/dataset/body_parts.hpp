// What joints' names tell of where they are in a body, and the way it points.
#pragma once

#include <array>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace actformer::ingest {

/// Indices of joints. Both are empty where no name is known.
struct BodyParts {
    std::vector<std::size_t>
        trunk;  ///< spine, neck and head; shoulders and collars where no joint is named like these
    std::vector<std::size_t> legs;

    bool known() const { return !trunk.empty() || !legs.empty(); }
};

/// Of the joints behind `root`, by words in their names.
BodyParts body_parts(std::span<const std::string> names, std::size_t root = 0);

/// The unit vector from the root to the middle of the trunk; where no trunk is known, or it is at the root, from the middle of the
/// legs to the root. Arms and legs to the side do not turn it. Nothing where all of these
/// are at one place, but for noise. `places` is (joints).
std::optional<std::array<double, 3>> upright_direction(std::span<const std::array<double, 3>> places,
                                                       const BodyParts& parts, std::size_t root = 0);

}  // namespace actformer::ingest
