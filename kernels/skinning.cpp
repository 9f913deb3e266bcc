#include "kernels/skinning.hpp"

#include <algorithm>

#include "kernels/round_up.hpp"
#include "kernels/sources.hpp"

namespace actformer::kernels {
namespace {

void check(const SkinnedBody& body) {
    const auto demand = [](bool holds, const char* what) {
        if (!holds) throw Error("skinning: {} of a body do not fit the rest of it", what);
    };
    const auto& parents = body.joints.parents;
    const auto joints = parents.size(), vertices = body.vertices(), shapes = body.joints.shape_count();
    demand(joints > 1 && parents[0] == -1, "the parents");
    for (std::size_t k = 1; k < joints; ++k)
        demand(parents[k] >= 0 && parents[k] < static_cast<int>(k), "the parents");
    demand(body.joints.places.size() == 3 * joints && body.joints.shapes.size() == shapes * 3 * joints,
           "the joints");
    demand(vertices > 0 && body.rest.size() == 3 * vertices, "the vertices");
    demand(body.shapes.size() == shapes * 3 * vertices, "the shapes");
    demand(body.pose_directions.size() == 3 * vertices * 9 * (joints - 1), "the pose blend shapes");
    demand(body.first.size() == vertices + 1 && body.first[0] == 0 &&
               body.first.back() == body.influences.size() && std::ranges::is_sorted(body.first),
           "the weights");
    for (const auto& one : body.influences) demand(one.joint < joints, "the weights");
}

/// (V, 3, F) to (blocks, F, 3 vertices of a block), padded with zeros.
std::vector<float> packed(const std::vector<float>& directions, std::size_t features, std::size_t numbers,
                          std::size_t blocks) {
    std::vector<float> out(blocks * features * numbers, 0.0F);
    for (std::size_t i = 0; i * features < directions.size(); ++i)
        for (std::size_t k = 0; k < features; ++k)
            out[(i / numbers * features + k) * numbers + i % numbers] = directions[i * features + k];
    return out;
}

/// Rows of `from` numbers each to rows of `to`, the rest zeros.
std::vector<float> padded(const std::vector<float>& rows, std::size_t from, std::size_t to) {
    std::vector<float> out(rows.size() / from * to, 0.0F);
    for (std::size_t r = 0; r * from < rows.size(); ++r) std::copy_n(&rows[r * from], from, &out[r * to]);
    return out;
}

/// Makes room for `count` values; keeps what is there where it is large enough.
void grow(Device& device, Buffer<float>& buffer, std::size_t count) {
    if (buffer.size() < count) buffer = Buffer<float>(device, count);
}

}  // namespace

std::vector<double> RestJoints::shaped(std::span<const float> betas) const {
    if (betas.size() > shape_count())
        throw Error("{} shape parameters for a body model of {} shapes", betas.size(), shape_count());
    auto joints = places;
    for (std::size_t b = 0; b < betas.size(); ++b)
        for (std::size_t i = 0; i < joints.size(); ++i)
            joints[i] += double{betas[b]} * shapes[b * joints.size() + i];
    return joints;
}

/// Sums of 24 vectors, 2 of features and a number of P fill the 32 vector registers of AVX-512; 12 sums the 16 of AVX2.
SkinningTiles skinning_tiles(const Device& device) {
    if (device.info().type != "CPU") return {4, 4, 1, 1, 64, 64};
    if (device.info().vector_width >= 16) return {16, 4, 2, 32, 32, 1};
    return {8, 2, 2, 64, 16, 1};
}

cl::Kernel Skinning::kernel(const char* name) {
    return device_->vector_kernel(
        "skinning", name, tiles_.vec,
        fmt::format(" -DJOINTS={} -DPANEL={} -DTILE_VERTICES={} -DTILE_VECTORS={} -DITEM_BLOCKS={}",
                    body_.count(), tiles_.panel, tiles_.vertices, tiles_.vectors, tiles_.blocks));
}

Skinning::Skinning(Device& device, const SkinnedBody& body, const SkinningTiles& tiles)
    : device_(&device),
      body_((check(body), body.joints)),
      vertex_count_(static_cast<std::uint32_t>(body.vertices())),
      tiles_(tiles),
      blocks_(static_cast<std::uint32_t>(round_up(body.vertices(), tiles_.vertices)) / tiles_.vertices),
      shape_(kernel("shape")),
      chain_(kernel("chain")),
      skin_(kernel("skin")) {
    const std::size_t block = 3 * tiles_.vertices, coordinates = block * blocks_;
    rest_ = Buffer<float>(device, padded(body.rest, body.rest.size(), coordinates));
    shapes_ = Buffer<float>(device, padded(body.shapes, body.rest.size(), coordinates));
    shaped_ = Buffer<float>(device, coordinates);
    directions_ =
        Buffer<float>(device, packed(body.pose_directions, 9 * (body_.count() - 1), block, blocks_));
    parents_ = Buffer<std::int32_t>(device, body_.parents);
    auto first = body.first;
    first.resize(coordinates / 3 + 1, first.back());
    first_ = Buffer<std::uint32_t>(device, first);
    std::vector<std::uint32_t> influencing;
    std::vector<float> weights;
    for (const auto& one : body.influences) {
        influencing.push_back(one.joint);
        weights.push_back(one.weight);
    }
    influencing_ = Buffer<std::uint32_t>(device, influencing);
    weights_ = Buffer<float>(device, weights);
    shape({});
}

void Skinning::shape(std::span<const float> betas) {
    const auto joints = body_.shaped(betas);
    rest_joints_ = Buffer<float>(*device_, std::vector<float>(joints.begin(), joints.end()));
    launch(*device_, shape_, {rest_.size(), 1}, rest_, shapes_, Buffer<float>(*device_, betas), shaped_,
           static_cast<std::uint32_t>(rest_.size()), static_cast<std::uint32_t>(betas.size()));
}

void Skinning::pose(std::span<const float> rotations, std::span<const float> translations) {
    const auto k = body_.count();
    frames_ = translations.size() / 3;
    if (translations.size() != 3 * frames_ || rotations.size() != frames_ * k * 9)
        throw Error("skinning: {} rotations and {} numbers of translation for {} joints",
                    rotations.size() / 9, translations.size(), k);
    if (frames_ == 0) return;
    const auto frames = static_cast<std::uint32_t>(frames_),
               padded = static_cast<std::uint32_t>(round_up(frames_, tiles_.panel));
    grow(*device_, features_, std::size_t{padded} * 9 * (k - 1));
    grow(*device_, transforms_, std::size_t{padded} * (12 * k + 3));
    grow(*device_, places_, frames_ * k * 3);
    grow(*device_, vertices_, frames_ * vertex_count_ * 3);
    launch(*device_, chain_, {padded, 1}, Buffer<float>(*device_, rotations),
           Buffer<float>(*device_, translations), rest_joints_, parents_, features_, transforms_, places_,
           frames, padded);
    const auto tile = tiles_.vec * tiles_.vectors, tiles = (frames + tile - 1) / tile;
    launch(*device_, skin_, {tiles, (blocks_ + tiles_.blocks - 1) / tiles_.blocks, 1}, tiles_.group,
           features_, transforms_, shaped_, directions_, first_, influencing_, weights_, vertices_, frames,
           vertex_count_, tiles, blocks_);
}

}  // namespace actformer::kernels
