#include "ingest/formats/skeletal/up.hpp"

#include <algorithm>

namespace actformer::ingest {
namespace {

struct Axis {
    std::string_view name;
    Vector3 direction;
    UpTurn turn;
};

constexpr std::array<Axis, 6> axes{{{"y", {0, 1, 0}, {0, 0}},
                                    {"z", {0, 0, 1}, {0, -90}},
                                    {"-y", {0, -1, 0}, {0, 180}},
                                    {"-z", {0, 0, -1}, {0, 90}},
                                    {"x", {1, 0, 0}, {2, 90}},
                                    {"-x", {-1, 0, 0}, {2, -90}}}};

double product(const Vector3& a, const Vector3& b) {
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

}  // namespace

std::optional<Up> up_named(std::string_view name) {
    for (std::size_t i = 0; i < axes.size(); ++i)
        if (axes[i].name == name) return static_cast<Up>(i);
    return {};
}

std::string_view name_of(Up up) {
    return axes[static_cast<std::size_t>(up)].name;
}

UpTurn turn_of(Up up) {
    return axes[static_cast<std::size_t>(up)].turn;
}

Up nearest_up(const Vector3& direction) {
    const auto best = std::max_element(axes.begin(), axes.end(), [&](const Axis& a, const Axis& b) {
        return product(a.direction, direction) < product(b.direction, direction);
    });
    return static_cast<Up>(best - axes.begin());
}

}  // namespace actformer::ingest
