#include "ingest/dataset/height.hpp"

#include <algorithm>
#include <array>
#include <limits>
#include <utility>
#include <vector>

namespace actformer::ingest {
namespace {

constexpr std::size_t most_clips = 64, frames_a_clip = 32;

/// The value that a fraction `share` of `values`, at least one, lies below.
float quantile(std::vector<float> values, double share) {
    const auto at =
        values.begin() + static_cast<std::ptrdiff_t>(share * static_cast<double>(values.size() - 1) + 0.5);
    std::nth_element(values.begin(), at, values.end());
    return *at;
}

using Extent = std::array<std::vector<float>, 3>;  ///< along x, y, z

/// Of the first person, in some frames.
void add_extent(const Motion& motion, const BodyModel& body, Extent& out) {
    const auto positions = joint_positions(motion, body);
    const std::size_t joints = body.topology.joints(),
                      step = std::max<std::size_t>(1, motion.frames / frames_a_clip);
    for (std::size_t d = 0; d < 3; ++d) {
        std::vector<float> lengths;
        for (std::size_t f = 0; f < motion.frames; f += step) {
            float least = std::numeric_limits<float>::max(), most = std::numeric_limits<float>::lowest();
            for (std::size_t j = 0; j < joints; ++j) {
                const float place = positions[(f * motion.persons * joints + j) * 3 + d];
                least = std::min(least, place);
                most = std::max(most, place);
            }
            lengths.push_back(most - least);
        }
        out[d].push_back(quantile(std::move(lengths), 0.9));
    }
}

}  // namespace

std::optional<BodyHeight> body_height(const Dataset& dataset) {
    const std::size_t clips = dataset.clips().size(), looked_at = std::min(clips, most_clips);
    Extent extents;
    for (std::size_t i = 0; i < looked_at; ++i) {
        const std::size_t clip = i * clips / looked_at;
        if (dataset.clips()[clip].frames > 0) add_extent(dataset.motion(clip), dataset.body(clip), extents);
    }
    if (extents[0].empty()) return {};
    BodyHeight height{quantile(extents[1], 0.5), 'y'};
    for (const auto& [d, axis] : {std::pair{0, 'x'}, {2, 'z'}})
        if (const double length = quantile(extents[d], 0.5); length > 1.25 * height.metres)
            height = {length, axis};
    return height;
}

}  // namespace actformer::ingest
