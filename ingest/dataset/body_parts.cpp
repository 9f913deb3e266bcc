#include "ingest/dataset/body_parts.hpp"

#include <algorithm>
#include <cmath>
#include <initializer_list>
#include <string_view>

#include "base/text/lower_case.hpp"

namespace actformer::ingest {
namespace {

using Place = std::array<double, 3>;

bool holds_any(const std::string& name, std::initializer_list<std::string_view> words) {
    const auto lower = lower_case(name);
    return std::any_of(words.begin(), words.end(),
                       [&](std::string_view word) { return lower.find(word) != std::string::npos; });
}

Place middle(std::span<const Place> places, const std::vector<std::size_t>& joints) {
    Place sum{};
    for (const auto j : joints)
        for (std::size_t d = 0; d < 3; ++d) sum[d] += places[j][d] / static_cast<double>(joints.size());
    return sum;
}

/// How far the joint farthest from the root is from it.
double reach(std::span<const Place> places, std::size_t root) {
    double most = 0;
    for (std::size_t j = root; j < places.size(); ++j)
        most = std::max(most, std::hypot(places[j][0] - places[root][0], places[j][1] - places[root][1],
                                         places[j][2] - places[root][2]));
    return most;
}

/// Nothing where they are no farther apart than `near`.
std::optional<Place> direction(const Place& from, const Place& to, double near) {
    const Place way{to[0] - from[0], to[1] - from[1], to[2] - from[2]};
    const double length = std::hypot(way[0], way[1], way[2]);
    if (!(length > near)) return {};
    return Place{way[0] / length, way[1] / length, way[2] / length};
}

}  // namespace

BodyParts body_parts(std::span<const std::string> names, std::size_t root) {
    BodyParts parts;
    std::vector<std::size_t> shoulders;
    for (std::size_t j = root + 1; j < names.size(); ++j) {
        const auto& name = names[j];
        if (holds_any(name,
                      {"foot", "toe", "ankle", "knee", "shin", "calf", "tibia", "femur", "thigh", "leg"}))
            parts.legs.push_back(j);
        else if (holds_any(name, {"head", "neck", "spine", "chest", "thorax", "torso", "abdomen", "back"}))
            parts.trunk.push_back(j);
        else if (holds_any(name, {"collar", "clavicle", "shoulder"}))
            shoulders.push_back(j);
    }
    if (parts.trunk.empty()) parts.trunk = std::move(shoulders);
    return parts;
}

std::optional<Place> upright_direction(std::span<const Place> places, const BodyParts& parts,
                                       std::size_t root) {
    const double near = 1e-4 * reach(places, root);
    std::optional<Place> up;
    if (!parts.trunk.empty()) up = direction(places[root], middle(places, parts.trunk), near);
    if (!up && !parts.legs.empty()) up = direction(middle(places, parts.legs), places[root], near);
    return up;
}

}  // namespace actformer::ingest
