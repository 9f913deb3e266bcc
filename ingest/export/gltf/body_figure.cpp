#include "ingest/export/gltf/body_figure.hpp"

#include <algorithm>

#include "ingest/smpl/vertex_normals.hpp"

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

}  // namespace

SkinFigure body_figure(const SmplBody& body) {
    SkinFigure figure;
    figure.normals = vertex_normals(body.skin.rest, body.faces);
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
