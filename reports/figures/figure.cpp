#include "reports/figures/figure.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "base/error.hpp"

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

}  // namespace

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

Figure figure_of(const ingest::Motion& motion, const ingest::BodyModel& body, double fps, std::string title) {
    Figure figure{std::move(title), body.topology, motion.persons, motion.frames, fps, {}, {}, {}};
    figure.joints = ingest::joint_positions(motion, body);
    check(figure);
    return figure;
}

Figure figure_of(const ingest::SkeletonFile& file, std::string title) {
    const auto& topology = ingest::ntu25();
    const auto persons = static_cast<std::uint32_t>(file.bodies.size()),
               k = static_cast<std::uint32_t>(topology.joints());
    const std::size_t bodies = std::size_t{file.frames} * persons;
    Figure figure{
        std::move(title), topology, persons, file.frames, 30, {}, std::vector<std::uint8_t>(bodies, 0), {}};
    figure.joints.resize(bodies * k * 3);
    const ingest::BodyModel whole{
        {}, topology, std::vector<float>(k, 1.0F), {}};  // raw limbs have their lengths still
    for (std::uint32_t p = 0; p < persons; ++p) {
        const auto& body = file.bodies[p];
        const ingest::Motion motion{"", static_cast<std::uint32_t>(body.times.size()), 1, k, 3, body.limbs};
        const auto joints = ingest::joint_positions(motion, whole);
        for (std::size_t i = 0; i < body.times.size(); ++i) {
            const std::size_t at = std::size_t{body.times[i]} * persons + p;
            figure.seen[at] = 1;
            std::copy_n(&joints[i * k * 3], k * 3, &figure.joints[at * k * 3]);
        }
    }
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
