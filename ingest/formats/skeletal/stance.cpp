#include "ingest/formats/skeletal/stance.hpp"

#include <algorithm>
#include <cmath>
#include <span>
#include <string>
#include <vector>

#include "ingest/dataset/body_parts.hpp"
#include "ingest/formats/skeletal/pose.hpp"

namespace actformer::ingest {
namespace {

constexpr std::uint32_t looked_at = 16, steps = 8;  // frames, and steps from frame to frame
constexpr double person = 1.7;                      // metres

double distance(const Vector3& a, const Vector3& b) {
    return std::hypot(a[0] - b[0], a[1] - b[1], a[2] - b[2]);
}

/// The value that a fraction `share` of `values` lies below.
double quantile(std::vector<double> values, double share) {
    if (values.empty()) return 0;
    const auto at = static_cast<std::size_t>(share * static_cast<double>(values.size() - 1) + 0.5);
    std::nth_element(values.begin(), values.begin() + static_cast<std::ptrdiff_t>(at), values.end());
    return values[at];
}

std::vector<std::string> names_of(const Recording& recording) {
    std::vector<std::string> names;
    for (const auto& joint : recording.joints) names.push_back(joint.name);
    return names;
}

Vector3 box(std::span<const Vector3> places) {
    Vector3 least = places[0], most = places[0];
    for (const auto& place : places)
        for (std::size_t d = 0; d < 3; ++d) {
            least[d] = std::min(least[d], place[d]);
            most[d] = std::max(most[d], place[d]);
        }
    return {most[0] - least[0], most[1] - least[1], most[2] - least[2]};
}

}  // namespace

Stance stance_of(const Recording& recording, std::size_t root, std::uint32_t first) {
    first = std::min(first, recording.frames - 1);
    const std::uint32_t left = recording.frames - first, count = std::min(left, looked_at);
    const auto parts = body_parts(names_of(recording), root);
    std::array<std::vector<double>, 3> extents;
    std::vector<double> sizes;
    Vector3 direction{};
    for (std::uint32_t i = 0; i < count; ++i) {
        const auto frame = first + static_cast<std::uint32_t>(std::uint64_t{i} * left / count);
        const auto places = places_of(recording, frame);
        const auto sides = box(std::span(places).subspan(root));
        for (std::size_t d = 0; d < 3; ++d) extents[d].push_back(sides[d]);
        sizes.push_back(std::hypot(sides[0], sides[1], sides[2]));
        if (const auto up = upright_direction(places, parts, root))
            for (std::size_t d = 0; d < 3; ++d) direction[d] += (*up)[d] / count;
    }
    Stance stance;
    for (std::size_t d = 0; d < 3; ++d) stance.extent[d] = quantile(extents[d], 0.9);
    stance.size = quantile(sizes, 0.5);
    if (parts.known()) stance.upright = direction;
    return stance;
}

bool begins_with_jump(const Recording& recording, std::size_t root) {
    if (recording.frames < 3) return false;
    std::vector<double> moved;
    double size = 0;
    std::vector<Vector3> before;
    for (std::uint32_t f = 0; f < std::min(recording.frames, steps + 1); ++f) {
        auto places = places_of(recording, f);
        double sum = 0;
        for (std::size_t j = root; j < before.size(); ++j) sum += distance(places[j], before[j]);
        if (f > 0) moved.push_back(sum / static_cast<double>(places.size() - root));
        const auto sides = box(std::span(places).subspan(root));
        if (f == 1) size = std::hypot(sides[0], sides[1], sides[2]);
        before = std::move(places);
    }
    return moved[0] > 0.1 * size && moved[0] > 4 * *std::max_element(moved.begin() + 1, moved.end());
}

bool stands_still(const Recording& recording) {
    for (std::uint32_t c = 0; c < recording.channels; ++c) {
        const auto values = recording.channel(c);
        if (std::any_of(values.begin(), values.end(), [&](float v) { return v != values[0]; })) return false;
    }
    return true;
}

double fitting_scale(double height) {
    double best = 1;
    for (const double unit : {1.0, 0.3048, 0.0254 / 0.45, 0.0254, 0.01, 0.001})
        if (std::abs(std::log(unit * height / person)) < std::abs(std::log(best * height / person)))
            best = unit;
    if (std::abs(std::log(best * height / person)) <= std::log(3)) return best;
    const double exact = person / height, digits = std::pow(10, std::floor(std::log10(exact)) - 1);
    return std::round(exact / digits) * digits;
}

}  // namespace actformer::ingest
