#include "reports/figure.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "kernels/error.hpp"

namespace actformer::reports {
namespace {

std::string called(const Figure& figure) {
    return figure.title.empty() ? "the figure" : figure.title;
}

void check_joints(const Figure& figure) {
    constexpr float furthest = 1e5F;  // metres; float32 keeps centimetres up to here
    for (std::size_t t = 0; t < figure.frames; ++t)
        for (std::size_t p = 0; p < figure.persons; ++p) {
            if (!figure.visible(t, p)) continue;
            for (std::size_t j = 0; j < figure.topology.joints(); ++j) {
                const float* x = figure.at(t, p, j);
                for (int d = 0; d < 3; ++d)
                    if (!(std::abs(x[d]) <= furthest))
                        throw Error(
                            "{}: frame {}, person {}: {} is at ({}, {}, {}), which cannot be drawn; clean "
                            "the motion",
                            called(figure), t, p, figure.topology.names[j], x[0], x[1], x[2]);
            }
        }
}

/// The only child of the root where that branches in turn; 0 otherwise.
std::size_t hips_below_root(const ingest::Topology& topology) {
    const auto children = [&](int joint) { return std::ranges::count(topology.parents, joint); };
    if (children(0) != 1) return 0;
    const auto child = std::ranges::find(topology.parents, 0) - topology.parents.begin();
    return children(static_cast<int>(child)) > 1 ? static_cast<std::size_t>(child) : 0;
}

/// The root of every person stays where it is, or the way from it to `hips` changes by more than a fifth.
bool is_anchor(const Figure& figure, std::size_t hips) {
    bool moves = false, stretches = false;
    for (std::size_t p = 0; p < figure.persons; ++p) {
        const float* first = nullptr;
        float shortest = 1e9F, longest = 0;
        for (std::size_t t = 0; t < figure.frames; ++t) {
            if (!figure.visible(t, p)) continue;
            const float *root = figure.at(t, p, 0), *child = figure.at(t, p, hips);
            if (first == nullptr) first = root;
            for (int d = 0; d < 3; ++d) moves = moves || std::abs(root[d] - first[d]) > 1e-3F;
            const float length = std::hypot(child[0] - root[0], child[1] - root[1], child[2] - root[2]);
            shortest = std::min(shortest, length);
            longest = std::max(longest, length);
        }
        stretches = stretches || longest > 1.2F * shortest + 1e-3F;
    }
    return stretches || !moves;
}

/// `figure` with joint `hips` in the root's place.
Figure rooted_at(const Figure& figure, std::size_t hips) {
    const auto k = figure.topology.joints();
    std::vector<std::size_t> kept{hips};
    for (std::size_t j = 1; j < k; ++j)
        if (j != hips) kept.push_back(j);
    Figure out{figure.title, {}, figure.persons, figure.frames, figure.fps, {}, figure.seen};
    for (const auto j : kept) {
        const auto parent = std::ranges::find(kept, static_cast<std::size_t>(figure.topology.parents[j]));
        out.topology.names.push_back(figure.topology.names[j]);
        out.topology.parents.push_back(j == hips ? -1 : static_cast<int>(parent - kept.begin()));
    }
    out.joints.reserve(figure.joints.size());
    for (std::size_t t = 0; t < figure.frames; ++t)
        for (std::size_t p = 0; p < figure.persons; ++p)
            for (const auto j : kept)
                out.joints.insert(out.joints.end(), figure.at(t, p, j), figure.at(t, p, j) + 3);
    return out;
}

}  // namespace

Figure without_anchor(Figure figure) {
    for (auto hips = hips_below_root(figure.topology); hips > 0 && is_anchor(figure, hips);
         hips = hips_below_root(figure.topology))
        figure = rooted_at(figure, hips);
    return figure;
}

void check(const Figure& figure) {
    const auto name = called(figure);
    figure.topology.check(name);
    if (figure.frames == 0) throw Error("{} has no frames, so there is nothing to draw", name);
    if (figure.persons == 0) throw Error("{} has no persons, so there is nothing to draw", name);
    if (figure.persons > most_persons)
        throw Error("{} has {} persons; at most {} can be drawn in one figure", name, figure.persons,
                    most_persons);
    if (!(figure.fps > 0 && figure.fps <= 10000))
        throw Error("{} has {} frames a second; it must be above 0 and at most 10000", name, figure.fps);
    const std::size_t bodies = std::size_t{figure.frames} * figure.persons;
    if (figure.joints.size() != bodies * figure.topology.joints() * 3)
        throw Error("{}: {} numbers are not {} frames of {} persons of {} joints in 3 dimensions", name,
                    figure.joints.size(), figure.frames, figure.persons, figure.topology.joints());
    if (!figure.seen.empty() && figure.seen.size() != bodies)
        throw Error("{}: {} visibility flags are not {} frames of {} persons", name, figure.seen.size(),
                    figure.frames, figure.persons);
    if (!figure.seen.empty() && std::ranges::all_of(figure.seen, [](auto s) { return s == 0; }))
        throw Error("{} shows nobody in any frame, so there is nothing to draw", name);
    check_joints(figure);
}

Figure figure_of(const ingest::Motion& motion, const ingest::Topology& topology,
                 const std::vector<float>& bone_length, double fps, std::string title) {
    if (motion.joints != topology.joints())
        throw Error("{} has {} joints, and the skeleton to draw it with {}", motion.name, motion.joints,
                    topology.joints());
    if (bone_length.size() != std::size_t{motion.persons} * motion.joints)
        throw Error("{}: {} limb lengths for {} persons of {} joints", motion.name, bone_length.size(),
                    motion.persons, motion.joints);
    Figure figure{std::move(title), topology, motion.persons, motion.frames, fps, {}, {}};
    figure.joints = ingest::joint_positions(motion, topology, bone_length);
    check(figure);
    return figure;
}

std::vector<float> usual_bone_lengths(const ingest::Topology& topology) {
    // Round figures for a standing adult of about 1.7 m as a depth camera sees one, in ntu25()'s order.
    static constexpr std::array<float, 25> adult{
        0,     0.29F, 0.08F, 0.14F, 0.17F, 0.26F, 0.23F, 0.07F, 0.17F, 0.26F, 0.23F, 0.07F, 0.08F,
        0.38F, 0.38F, 0.11F, 0.08F, 0.38F, 0.38F, 0.11F, 0.22F, 0.07F, 0.06F, 0.07F, 0.06F};
    if (topology.parents == ingest::ntu25().parents) return {adult.begin(), adult.end()};
    std::vector<float> lengths(topology.joints(), 0.2F);
    if (!lengths.empty()) lengths[0] = 0;
    return lengths;
}

}  // namespace actformer::reports
