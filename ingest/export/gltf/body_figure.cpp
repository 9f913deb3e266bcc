#include "ingest/export/gltf/body_figure.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace actformer::ingest {
namespace {

constexpr std::size_t most_influences = 4;

void add_weights(std::span<const kernels::Influence> influences, SkinFigure& figure) {
    std::vector<kernels::Influence> largest(influences.begin(), influences.end());
    std::ranges::stable_sort(largest, std::greater{}, &kernels::Influence::weight);
    largest.resize(most_influences);  // those that are not there weigh nothing
    double all = 0;
    for (const auto& one : largest) all += one.weight;
    // The first takes what rounding leaves of the sum.
    float rest = 1;
    for (std::size_t i = 1; i < most_influences; ++i)
        rest -= largest[i].weight = static_cast<float>(largest[i].weight / all);
    largest[0].weight = rest;
    for (const auto& one : largest) {
        figure.joints.push_back(static_cast<std::uint16_t>(one.joint));
        figure.weights.push_back(one.weight);
    }
}

/// Each vertex's is the sum of its faces', which are as long as twice their areas.
std::vector<float> normals_of(const SmplBody& body) {
    const auto& at = body.skin.rest;
    std::vector<double> sums(at.size(), 0);
    for (std::size_t f = 0; f < body.faces.size(); f += 3) {
        const std::array<std::size_t, 3> v{body.faces[f], body.faces[f + 1], body.faces[f + 2]};
        std::array<double, 3> a{}, b{};
        for (std::size_t d = 0; d < 3; ++d) {
            a[d] = double{at[3 * v[1] + d]} - at[3 * v[0] + d];
            b[d] = double{at[3 * v[2] + d]} - at[3 * v[0] + d];
        }
        for (const auto corner : v)
            for (std::size_t d = 0; d < 3; ++d)
                sums[3 * corner + d] += a[(d + 1) % 3] * b[(d + 2) % 3] - a[(d + 2) % 3] * b[(d + 1) % 3];
    }
    std::vector<float> out;
    for (std::size_t i = 0; i < sums.size(); i += 3) {
        const double length = std::hypot(sums[i], sums[i + 1], sums[i + 2]);
        for (std::size_t d = 0; d < 3; ++d)  // up where a vertex has no face
            out.push_back(static_cast<float>(length > 0 ? sums[i + d] / length : d == 1 ? 1 : 0));
    }
    return out;
}

}  // namespace

SkinFigure body_figure(const SmplBody& body) {
    SkinFigure figure;
    figure.normals = normals_of(body);
    figure.faces = body.faces;
    const auto root = body.rest().offsets;
    for (std::size_t i = 0; i < body.skin.rest.size(); ++i)
        figure.positions.push_back(static_cast<float>(body.skin.rest[i] - root[i % 3]));
    const std::span influences(body.skin.influences);
    for (std::size_t v = 0; v < body.skin.vertices(); ++v)
        add_weights(influences.subspan(body.skin.first[v], body.skin.first[v + 1] - body.skin.first[v]),
                    figure);
    return figure;
}

}  // namespace actformer::ingest
