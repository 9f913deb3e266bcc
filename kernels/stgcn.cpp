#include "kernels/stgcn.hpp"

#include <array>

#include "kernels/round_up.hpp"

namespace actformer::kernels {
namespace {

constexpr std::size_t elementwise_group = 64;  // work-items

constexpr std::array<double, 4> points5{0, 1, -1, 2};                 // and infinity
constexpr std::array<double, 7> points8{0, 1, -1, 2, -2, 0.5, -0.5};  // and infinity

/// A filter's polynomial at the points, each divided by the product of its distances to the others; at infinity its last
/// coefficient. `split8` takes its first row with the other sign, so that it begins with a plain d[0].
template <std::size_t N>
std::array<double, N + 1> at_points(const std::array<double, N>& points, std::span<const double> taps) {
    std::array<double, N + 1> out{};
    for (std::size_t i = 0; i < N; ++i) {
        double value = 0, distances = 1;
        for (std::size_t t = taps.size(); t-- > 0;) value = value * points[i] + taps[t];
        for (std::size_t k = 0; k < N; ++k)
            if (k != i) distances *= points[i] - points[k];
        out[i] = value / (N == points8.size() && i == 0 ? -distances : distances);
    }
    out[N] = taps.back();
    return out;
}

std::vector<double> nested_points(std::span<const double, 9> taps) {
    std::array<std::array<double, 5>, 3> inner;
    for (std::size_t g = 0; g < 3; ++g) inner[g] = at_points(points5, taps.subspan(3 * g, 3));
    std::vector<double> out(40);
    for (std::size_t b = 0; b < 5; ++b) {
        const std::array<double, 3> groups{inner[0][b], inner[1][b], inner[2][b]};
        const auto outer = at_points(points8, groups);
        for (std::size_t a = 0; a < 8; ++a) out[a * 5 + b] = outer[a];
    }
    return out;
}

std::vector<double> phase_points(std::span<const double, 9> taps) {
    std::vector<double> out;
    for (const std::size_t phase : {0U, 1U}) {
        std::array<double, 5> half{};
        for (std::size_t s = 0; 2 * s + phase < 9; ++s) half[s] = taps[2 * s + phase];
        const auto points = at_points(points8, half);
        out.insert(out.end(), points.begin(), points.end());
    }
    return out;
}

}  // namespace

std::vector<double> filter_points(std::span<const double, 9> taps, std::uint32_t stride) {
    return stride == 1 ? nested_points(taps) : phase_points(taps);
}

Stgcn::Stgcn(Device& device, const Tiles& tiles) : device_(&device), tiles_(tiles) {
    if (tiles.block() % tiles.filter_vec != 0)
        throw Error("tiles: filters of {} numbers do not divide rows of blocks of {}", tiles.filter_vec,
                    tiles.block());
    enter_ = device.vector_kernel("graph", "enter", tiles.vec);
    gather_ = device.vector_kernel("graph", "gather", tiles.vec);
    pool_ = device.vector_kernel("graph", "pool", tiles.vec);
    classify_ = device.vector_kernel("graph", "classify", tiles.vec);
    transform_input_ = device.vector_kernel("temporal", "transform_input", tiles.filter_vec);
    transform_output_ = device.vector_kernel("temporal", "transform_output", tiles.filter_vec);
}

cl::Kernel Stgcn::product(bool graph, std::uint32_t a_pitch, std::uint32_t out_pitch) {
    auto& kernel = products_[{graph ? 1U : 0U, a_pitch, out_pitch}];
    if (!kernel())
        kernel = device_->vector_kernel(
            "multiply", "multiply", tiles_.vec,
            fmt::format(" -DTILE_ROWS={} -DTILE_VECTORS={} -DITEM_TILES={} -DCOLUMNS_FIRST={} -DA_PITCH={} "
                        "-DOUT_PITCH={}{}",
                        tiles_.rows, tiles_.vectors, tiles_.item_tiles, tiles_.columns_first ? 1 : 0, a_pitch,
                        out_pitch, graph ? " -DGRAPH" : ""));
    return kernel;
}

/// Work-items along channels: one takes them all where columns do not come first.
std::size_t Stgcn::channel_items(std::uint32_t pitch, std::uint32_t vec) const {
    return tiles_.columns_first ? pitch / vec : 1;
}

std::uint32_t Stgcn::pitch(std::uint32_t channels) const {
    return static_cast<std::uint32_t>(round_up(channels, tiles_.block()));
}

std::uint32_t Stgcn::rows(std::size_t rows) const {
    return static_cast<std::uint32_t>(round_up(rows, tiles_.rows));
}

PackedWeights Stgcn::pack(std::span<const float> values, std::uint32_t sets, std::uint32_t depth,
                          std::uint32_t columns) const {
    const std::size_t block = tiles_.block(), blocks = pitch(columns) / block;
    std::vector<float> packed(sets * blocks * depth * block, 0.0F);
    const auto at = [&](std::size_t s, std::size_t k, std::size_t column) {  // as multiply.cl says
        return tiles_.columns_first ? (s * depth + k) * blocks + column : (s * blocks + column) * depth + k;
    };
    for (std::size_t s = 0; s < sets; ++s)
        for (std::size_t k = 0; k < depth; ++k)
            for (std::size_t c = 0; c < columns; ++c)
                packed[at(s, k, c / block) * block + c % block] = values[(s * depth + k) * columns + c];
    return {Buffer<float>(*device_, packed), depth, static_cast<std::uint32_t>(blocks)};
}

void Stgcn::enter(const cl::Buffer& motion, const Buffer<float>& scale, const Buffer<float>& shift,
                  const Panels& to, std::uint32_t begin, std::uint32_t sequences, std::uint32_t channels,
                  std::uint32_t frames) {
    launch(*device_, enter_, {to.count, std::size_t{sequences} * frames}, motion, scale, shift, to.memory,
           begin, sequences, channels, frames, to.count, to.rows, to.pitch);
}

void Stgcn::gather(const Panels& from, const Mixture& mixture, const Panels& to, std::uint32_t behind,
                   std::uint32_t sequences, std::uint32_t frames, std::uint32_t stride) {
    const auto left = strided(frames, stride);
    launch(*device_, gather_,
           {channel_items(to.pitch, tiles_.vec), std::size_t{sequences} * left, mixture.count},
           elementwise_group, from.memory, mixture.first, mixture.source, mixture.share, to.memory, sequences,
           frames, left, stride, from.rows, to.rows, to.pitch, mixture.count, behind);
}

void Stgcn::multiply(cl::Kernel kernel, const Panels& from, const PackedWeights& weights,
                     const Problems& problems, const Buffer<float>& bias, const Panels& to,
                     std::size_t rows_used) {
    const auto tiles = rows(rows_used) / tiles_.rows;
    const std::size_t items = (tiles + tiles_.item_tiles - 1) / tiles_.item_tiles,
                      columns = weights.column_blocks;
    const auto range = tiles_.columns_first ? std::array<std::size_t, 3>{columns, items, problems.count}
                                            : std::array<std::size_t, 3>{items, columns, problems.count};
    launch(*device_, kernel, range, tiles_.group, from.memory, weights.values, problems.first,
           problems.segments, problems.scale, bias, to.memory, tiles, weights.column_blocks, problems.count,
           weights.depth, from.rows, to.rows);
}

void Stgcn::multiply(const Panels& from, const PackedWeights& weights, const Problems& problems,
                     const Panels& to, std::size_t rows_used) {
    multiply(product(false, from.pitch, to.pitch), from, weights, problems, problems.scale, to, rows_used);
}

void Stgcn::multiply_graph(const Panels& from, const PackedWeights& weights, const Problems& problems,
                           const Buffer<float>& bias, const Panels& to, std::size_t rows_used) {
    multiply(product(true, from.pitch, to.pitch), from, weights, problems, bias, to, rows_used);
}

void Stgcn::transform_input(const Panels& from, const Panels& to, std::uint32_t sequences,
                            std::uint32_t frames, std::uint32_t stride) {
    const auto tile = filtering(stride).tile, tiles = (strided(frames, stride) + tile - 1) / tile;
    const auto strips = from.count * sequences;
    launch(*device_, transform_input_,
           {channel_items(to.pitch, tiles_.filter_vec), std::size_t{strips} * tiles, 1}, elementwise_group,
           from.memory, to.memory, stride, sequences, frames, tiles, strips, from.rows, to.rows, to.pitch);
}

void Stgcn::transform_output(const Panels& from, const Buffer<float>& bias, const Panels* residual,
                             const Panels& to, std::uint32_t sequences, std::uint32_t frames,
                             std::uint32_t stride) {
    const auto tile = filtering(stride).tile, tiles = (frames + tile - 1) / tile,
               strips = to.count * sequences;
    launch(*device_, transform_output_,
           {channel_items(to.pitch, tiles_.filter_vec), std::size_t{strips} * tiles, 1}, elementwise_group,
           from.memory, bias, residual ? residual->memory : bias.memory(), to.memory, residual ? 1U : 0U,
           stride, sequences, frames, tiles, strips, to.rows, from.rows, to.pitch);
}

void Stgcn::pool(const Panels& from, const Buffer<float>& features, std::uint32_t begin,
                 std::uint32_t sequences, std::uint32_t channels, std::uint32_t frames) {
    launch(*device_, pool_, {channels, sequences}, from.memory, features, begin, sequences, channels, frames,
           from.count, from.rows, from.pitch);
}

void Stgcn::classify(const Buffer<float>& features, const Buffer<float>& weights, const Buffer<float>& bias,
                     const Buffer<float>& logits, std::uint32_t sequences, std::uint32_t channels,
                     std::uint32_t classes) {
    launch(*device_, classify_, {classes, sequences}, features, weights, bias, logits, sequences, channels,
           classes);
}

}  // namespace actformer::kernels
