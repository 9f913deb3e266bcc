// Which axis of a recording points up. In a dataset it is y.
#pragma once

#include <optional>
#include <string_view>

#include "ingest/formats/skeletal/matrix.hpp"

namespace actformer::ingest {

enum class Up : std::uint8_t { y, z, minus_y, minus_z, x, minus_x };

/// As in "-z"; nothing where it is no axis.
std::optional<Up> up_named(std::string_view name);
std::string_view name_of(Up up);

/// The quarter or half turn that makes y of `up`: degrees about axis 0 (x) or 2 (z).
struct UpTurn {
    std::size_t axis = 0;
    float degrees = 0;
};
UpTurn turn_of(Up up);

/// The axis along which `direction` mostly points.
Up nearest_up(const Vector3& direction);

}  // namespace actformer::ingest
