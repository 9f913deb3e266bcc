#include "ingest/dataset/layout.hpp"

namespace actformer::ingest {
namespace {

/// Calls use(place in (P*D, T, K), place in (T, P, K, D)) for every number.
template <typename Use>
void for_each_place(const Motion& shape, const Use& use) {
    std::size_t place = 0;
    if (shape.values.empty()) return;  // whatever extents the others have
    for (std::size_t p = 0; p < shape.persons; ++p)
        for (std::size_t d = 0; d < shape.numbers; ++d)
            for (std::size_t t = 0; t < shape.frames; ++t)
                for (std::size_t k = 0; k < shape.nodes; ++k)
                    use(place++, ((t * shape.persons + p) * shape.nodes + k) * shape.numbers + d);
}

}  // namespace

std::vector<float> with_last_axes_swapped(std::span<const float> values, std::size_t channels,
                                          std::size_t rows, std::size_t columns) {
    std::vector<float> swapped(values.size());
    if (values.empty()) return swapped;  // whatever extents the others have
    const float* from = values.data();
    for (std::size_t c = 0; c < channels; ++c)
        for (std::size_t r = 0; r < rows; ++r)
            for (std::size_t i = 0; i < columns; ++i) swapped[(c * columns + i) * rows + r] = *from++;
    return swapped;
}

std::vector<float> channels_first(const Motion& motion) {
    std::vector<float> values(motion.values.size());
    for_each_place(motion, [&](std::size_t to, std::size_t from) { values[to] = motion.values[from]; });
    return values;
}

void take_channels_first(std::span<const float> values, Motion& motion) {
    motion.values.resize(values.size());
    for_each_place(motion, [&](std::size_t from, std::size_t to) { motion.values[to] = values[from]; });
}

}  // namespace actformer::ingest
