#include "ingest/export/gltf/stick_figure.hpp"

#include <Eigen/Geometry>
#include <algorithm>

namespace actformer::ingest {
namespace {

using Eigen::Vector3d;

Vector3d vector_of(const Point& p) {
    return {p[0], p[1], p[2]};
}

struct Corner {
    Vector3d at;
    std::size_t joint;
};

void add_triangle(SkinFigure& figure, const Corner& a, const Corner& b, const Corner& c) {
    const Vector3d normal = (b.at - a.at).cross(c.at - a.at).normalized();
    for (const auto* corner : {&a, &b, &c}) {
        for (int d = 0; d < 3; ++d) {
            figure.positions.push_back(static_cast<float>(corner->at[d]));
            figure.normals.push_back(static_cast<float>(normal[d]));
        }
        figure.joints.insert(figure.joints.end(), {static_cast<std::uint16_t>(corner->joint), 0, 0, 0});
        figure.weights.insert(figure.weights.end(), {1, 0, 0, 0});
    }
}

/// Two pyramids on one square, an eighth of the way from `from` to `to`.
void add_bone(SkinFigure& figure, const Corner& from, const Corner& to) {
    const Vector3d along = to.at - from.at;
    const double thick = std::clamp(0.12 * along.norm(), 0.004, 0.03);
    const Vector3d side = along.unitOrthogonal() * thick, other = along.normalized().cross(side);
    const Vector3d middle = from.at + along / 8;
    const std::array<Corner, 4> square{{{middle + side, from.joint},
                                        {middle + other, from.joint},
                                        {middle - side, from.joint},
                                        {middle - other, from.joint}}};
    for (std::size_t i = 0; i < 4; ++i) {
        add_triangle(figure, from, square[(i + 1) % 4], square[i]);
        add_triangle(figure, to, square[i], square[(i + 1) % 4]);
    }
}

}  // namespace

std::vector<Point> rest_places(const SkeletonMotion& motion) {
    std::vector<Point> places(motion.joints(), Point{});
    for (const auto j : motion.topology.order())
        if (const int parent = motion.topology.parents[j]; parent >= 0)
            for (std::size_t d = 0; d < 3; ++d) places[j][d] = places[parent][d] + motion.rest[j][d];
    return places;
}

SkinFigure stick_figure(const SkeletonMotion& motion) {
    constexpr double shortest = 1e-4;  // metres: nothing would be seen of it
    const auto places = rest_places(motion);
    SkinFigure figure;
    for (std::size_t j = 1; j < motion.joints(); ++j)
        if (vector_of(motion.rest[j]).norm() > shortest) {
            const auto parent = static_cast<std::size_t>(motion.topology.parents[j]);
            add_bone(figure, {vector_of(places[parent]), parent}, {vector_of(places[j]), j});
        }
    if (figure.corners() == 0) add_bone(figure, {Vector3d::Zero(), 0}, {0.1 * Vector3d::UnitY(), 0});
    return figure;
}

}  // namespace actformer::ingest
