#include "ingest/formats/ntu/tracks.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <optional>

namespace actformer::ingest {
namespace {

/// Metres between the root where `earlier` ends and where `later` begins.
double distance(const Body& earlier, const Body& later) {
    const float* a = earlier.limbs.data() + (earlier.times.size() - 1) * ntu_joints * 3;
    const float* b = later.limbs.data();
    return std::hypot(static_cast<double>(b[0] - a[0]), static_cast<double>(b[1] - a[1]),
                      static_cast<double>(b[2] - a[2]));
}

/// The distance, where `later` follows `earlier`.
std::optional<double> follows(const Body& earlier, const Body& later) {
    const auto end = earlier.times.back(), begin = later.times.front();
    if (begin <= end || begin - end > longest_gap) return {};
    const auto apart = distance(earlier, later);
    if (apart > farthest_apart + farther_a_frame * (begin - end)) return {};
    return apart;
}

}  // namespace

std::vector<std::vector<std::size_t>> persons_of(const std::vector<Body>& tracks) {
    std::vector<std::size_t> by_time(tracks.size());
    std::iota(by_time.begin(), by_time.end(), std::size_t{0});
    std::stable_sort(by_time.begin(), by_time.end(), [&](std::size_t a, std::size_t b) {
        return tracks[a].times.front() < tracks[b].times.front();
    });
    std::vector<std::vector<std::size_t>> persons;
    for (const auto track : by_time) {
        std::optional<double> nearest;
        std::size_t whose = persons.size();
        for (std::size_t p = 0; p < persons.size(); ++p) {
            const auto apart = follows(tracks[persons[p].back()], tracks[track]);
            if (apart && (!nearest || *apart < *nearest)) {
                nearest = apart;
                whose = p;
            }
        }
        if (whose == persons.size()) persons.emplace_back();
        persons[whose].push_back(track);
    }
    return persons;
}

std::vector<Body> joined(const std::vector<Body>& tracks,
                         const std::vector<std::vector<std::size_t>>& persons) {
    std::vector<Body> bodies;
    for (const auto& person : persons) {
        auto& body = bodies.emplace_back(tracks[person[0]]);
        for (std::size_t i = 1; i < person.size(); ++i) {
            const auto& next = tracks[person[i]];
            body.times.insert(body.times.end(), next.times.begin(), next.times.end());
            body.limbs.insert(body.limbs.end(), next.limbs.begin(), next.limbs.end());
        }
    }
    return bodies;
}

}  // namespace actformer::ingest
