#include "ingest/formats/motions/body_doubts.hpp"

#include <cstdlib>

#include "base/error.hpp"
#include "ingest/dataset/known_topologies.hpp"
#include "ingest/formats/skeletal/stance.hpp"

namespace actformer::ingest {
namespace {

constexpr double smallest_body = 0.1;  // metres: a hand's skeleton is larger

/// "taller than 4 m"; empty for a body of usual size.
std::string odd_size(const BodyHeight& height) {
    if (height.metres > tallest_body) return fmt::format("taller than {:g} m", tallest_body);
    if (height.metres > 0 && height.metres < smallest_body)
        return fmt::format("smaller than {:g} m", smallest_body);
    return {};
}

bool stands(const BodyHeight& height) {
    return height.axis == 'y' && height.up >= 0;
}

/// The beginning of a doubt that the remedy follows: how bodies stand along the axis `along`.
std::string odd_stance(const BodyHeight& height, const std::string& along) {
    if (height.axis == 'y') return "bodies stand on their heads: where they should not, ";
    return fmt::format("bodies {} along {}: where they do not lie, ",
                       height.up == 0 ? "are longest" : "point from the root to the head", along);
}

/// The array's axis along which bodies stand, as --up takes it.
std::string axis_of_array(const BodyHeight& height, const PositionsRequest& request) {
    const int from = request.axes[static_cast<std::size_t>(height.axis - 'x')] * (height.up < 0 ? -1 : 1);
    return fmt::format("{}{}", height.up != 0 && from < 0 ? "-" : "", "xyz"[std::abs(from) - 1]);
}

}  // namespace

std::vector<std::string> body_doubts(const BodyHeight& height, const PositionsRequest& request) {
    std::vector<std::string> out;
    if (const auto size = odd_size(height); !size.empty())
        out.push_back(fmt::format(
            "bodies {} at --scale {:.4g}: --scale {:.4g} would make them about as tall as a person", size,
            request.scale, fitting_scale(height.metres / request.scale)));
    if (stands(height)) return out;
    const auto up = axis_of_array(height, request);
    out.push_back(fmt::format("{}--up {}{} turns them upright", odd_stance(height, up), up,
                              height.up == 0 ? " or --up -" + up : ""));
    return out;
}

std::vector<std::string> stored_body_doubts(const BodyHeight& height, const Topology& topology) {
    std::vector<std::string> out;
    if (const auto size = odd_size(height); !size.empty())
        out.push_back(fmt::format(
            "bodies {}: --scale is for joint positions alone; bring the file's lengths to metres", size));
    if (stands(height)) return out;
    const auto along = fmt::format("{}{}", height.up < 0 ? "-" : "", height.axis);
    out.push_back(fmt::format("{}{}", odd_stance(height, along),
                              topology.parents == gta22().parents
                                  ? "ingest gta turns GTA Combat's files upright"
                                  : "turn the file's motions so that y is up; --up is for joint positions "
                                    "alone"));
    return out;
}

}  // namespace actformer::ingest
