#include "ingest/formats/ntu/bodies.hpp"

#include <algorithm>
#include <array>
#include <numeric>
#include <utility>

namespace actformer::ingest {

double motion_of(const Body& body) {
    static const auto order = ntu25().order();
    constexpr std::size_t numbers = ntu_joints * 3;
    std::array<double, numbers> at{}, mean{}, squares{};
    for (std::size_t i = 0; i < body.times.size(); ++i) {
        const float* limbs = body.limbs.data() + i * numbers;
        for (const auto j : order)
            for (std::size_t d = 0; d < 3; ++d) {
                const auto n = 3 * j + d;
                at[n] = limbs[n] + (j == 0 ? 0.0 : at[3 * static_cast<std::size_t>(ntu25_parents[j]) + d]);
                const auto off = at[n] - mean[n];  // Welford's update: no difference of large sums
                mean[n] += off / static_cast<double>(i + 1);
                squares[n] += off * (at[n] - mean[n]);
            }
    }
    return std::accumulate(squares.begin(), squares.end(), 0.0) /
           static_cast<double>(std::max<std::size_t>(body.times.size(), 1));
}

bool stands_still(const Body& body) {
    const auto& limbs = body.limbs;
    return std::equal(limbs.begin() + ntu_joints * 3, limbs.end(), limbs.begin());
}

std::vector<std::size_t> preferred(const std::vector<Body>& bodies, std::size_t persons, BodyRule rule) {
    std::vector<std::size_t> order(bodies.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::vector<std::pair<bool, double>> worth;
    for (const auto& body : bodies) {
        const auto frames = body.times.size();
        if (rule == BodyRule::frames)
            worth.emplace_back(true, frames);
        else
            worth.emplace_back(frames >= fleeting, motion_of(body));
    }
    std::stable_sort(order.begin(), order.end(),
                     [&](std::size_t a, std::size_t b) { return worth[a] > worth[b]; });
    order.resize(std::min(persons, order.size()));
    return order;
}

}  // namespace actformer::ingest
