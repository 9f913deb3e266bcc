#include "ingest/dataset/height.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "ingest/dataset/body_parts.hpp"

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

using JointPlaces = std::vector<std::array<double, 3>>;  ///< (joints)

/// Some frames, spread over the motion.
Motion some_frames(const Motion& motion) {
    const std::size_t step = std::max<std::size_t>(1, motion.frames / frames_a_clip),
                      frame = std::size_t{motion.persons} * motion.nodes * motion.numbers;
    Motion out{motion.name, 0, motion.persons, motion.nodes, motion.numbers, {}};
    for (std::size_t f = 0; f < motion.frames; f += step, ++out.frames) {
        const auto first = motion.values.begin() + static_cast<std::ptrdiff_t>(f * frame);
        out.values.insert(out.values.end(), first, first + static_cast<std::ptrdiff_t>(frame));
    }
    return out;
}

/// The first person's joints, frame by frame.
std::vector<JointPlaces> first_person(const Motion& motion, const BodyModel& body) {
    const auto positions = joint_positions(motion, body);
    const std::size_t joints = body.topology.joints();
    std::vector<JointPlaces> out;
    for (std::size_t f = 0; f < motion.frames; ++f) {
        auto& places = out.emplace_back(joints);
        for (std::size_t j = 0; j < joints; ++j)
            for (std::size_t d = 0; d < 3; ++d)
                places[j][d] = positions[(f * motion.persons * joints + j) * 3 + d];
    }
    return out;
}

float extent(const JointPlaces& places, std::size_t axis) {
    const auto [least, most] = std::minmax_element(
        places.begin(), places.end(), [&](const auto& a, const auto& b) { return a[axis] < b[axis]; });
    return static_cast<float>((*most)[axis] - (*least)[axis]);
}

/// How far the bodies of some clips reach, and where they point.
struct Look {
    std::array<std::vector<float>, 3> lengths;  ///< along x, y, z: one a clip
    std::array<double, 3> upright{};            ///< sum over the frames
    std::size_t frames = 0;

    void add(const std::vector<JointPlaces>& clip, const BodyParts& parts);
    std::optional<std::size_t> axis_of_the_trunk() const;
    std::optional<BodyHeight> height() const;
};

void Look::add(const std::vector<JointPlaces>& clip, const BodyParts& parts) {
    for (std::size_t d = 0; d < 3; ++d) {
        std::vector<float> of_frames;
        for (const auto& places : clip) of_frames.push_back(extent(places, d));
        lengths[d].push_back(quantile(std::move(of_frames), 0.9));
    }
    frames += clip.size();
    for (const auto& places : clip)
        if (const auto up = upright_direction(places, parts))
            for (std::size_t d = 0; d < 3; ++d) upright[d] += (*up)[d];
}

/// The axis along which bodies point on average. Nothing where names do not tell, or they turn this way and that.
std::optional<std::size_t> Look::axis_of_the_trunk() const {
    const double whole = std::hypot(upright[0], upright[1], upright[2]);
    if (!(whole > 0.5 * static_cast<double>(frames))) return {};
    std::size_t most = 1;
    for (const std::size_t d : {0, 2})
        if (std::abs(upright[d]) > std::abs(upright[most])) most = d;
    return std::abs(upright[1]) < 0.5 * whole ? most : 1;
}

std::optional<BodyHeight> Look::height() const {
    if (lengths[0].empty()) return {};
    std::array<double, 3> metres{};
    for (std::size_t d = 0; d < 3; ++d) metres[d] = quantile(lengths[d], 0.5);
    constexpr std::array axes{'x', 'y', 'z'};
    if (const auto axis = axis_of_the_trunk())
        return BodyHeight{metres[*axis], axes[*axis], upright[*axis] < 0 ? -1 : 1};
    BodyHeight height{metres[1], 'y'};
    for (const std::size_t d : {0, 2})
        if (metres[d] > 1.25 * height.metres) height = {metres[d], axes[d]};
    return height;
}

}  // namespace

std::optional<BodyHeight> body_height(const Dataset& dataset) {
    const std::size_t clips = dataset.clips().size(), looked_at = std::min(clips, most_clips);
    const auto parts = body_parts(dataset.header().topology.names);
    Look look;
    for (std::size_t i = 0; i < looked_at; ++i) {
        const std::size_t clip = i * clips / looked_at;
        if (dataset.clips()[clip].frames > 0)
            look.add(first_person(some_frames(dataset.motion(clip)), dataset.body(clip)), parts);
    }
    return look.height();
}

std::optional<BodyHeight> body_height(const Motion& motion, const BodyModel& body) {
    Look look;
    if (motion.frames > 0) look.add(first_person(some_frames(motion), body), body_parts(body.topology.names));
    return look.height();
}

}  // namespace actformer::ingest
