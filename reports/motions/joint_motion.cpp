#include "reports/motions/joint_motion.hpp"

#include <algorithm>
#include <cmath>

#include "base/error.hpp"

namespace actformer::reports {
namespace {

std::string called(const JointMotion& motion) {
    return motion.title.empty() ? "the motion" : motion.title;
}

void check_joints(const JointMotion& motion) {
    constexpr float furthest = 1e5F;  // metres; float32 keeps centimetres up to here
    for (std::size_t t = 0; t < motion.frames; ++t)
        for (std::size_t p = 0; p < motion.persons; ++p) {
            if (!motion.visible(t, p)) continue;
            for (std::size_t j = 0; j < motion.topology.joints(); ++j) {
                const float* x = motion.at(t, p, j);
                for (int d = 0; d < 3; ++d)
                    if (!(std::abs(x[d]) <= furthest))
                        throw Error(
                            "{}: frame {}, person {}: {} is at ({}, {}, {}), which cannot be drawn; clean "
                            "the motion",
                            called(motion), t, p, motion.topology.names[j], x[0], x[1], x[2]);
            }
        }
}

}  // namespace

void check(const JointMotion& motion) {
    const auto name = called(motion);
    motion.topology.check(name);
    if (motion.frames == 0) throw Error("{} has no frames, so there is nothing to draw", name);
    if (motion.persons == 0) throw Error("{} has no persons, so there is nothing to draw", name);
    if (motion.persons > most_persons)
        throw Error("{} has {} persons; at most {} can be drawn in one motion", name, motion.persons,
                    most_persons);
    if (!(motion.fps > 0 && motion.fps <= 10000))
        throw Error("{} has {} frames a second; it must be above 0 and at most 10000", name, motion.fps);
    const std::size_t bodies = std::size_t{motion.frames} * motion.persons;
    if (motion.joints.size() != bodies * motion.topology.joints() * 3)
        throw Error("{}: {} numbers are not {} frames of {} persons of {} joints in 3 dimensions", name,
                    motion.joints.size(), motion.frames, motion.persons, motion.topology.joints());
    if (!motion.seen.empty() && motion.seen.size() != bodies)
        throw Error("{}: {} visibility flags are not {} frames of {} persons", name, motion.seen.size(),
                    motion.frames, motion.persons);
    if (!motion.seen.empty() && std::ranges::all_of(motion.seen, [](auto s) { return s == 0; }))
        throw Error("{} shows nobody in any frame, so there is nothing to draw", name);
    check_joints(motion);
}

JointMotion joint_motion(const ingest::Motion& motion, const ingest::BodyModel& body, double fps,
                         std::string title) {
    JointMotion out{std::move(title), body.topology, motion.persons, motion.frames, fps, {}, {}, {}, {}, {}};
    out.joints = ingest::joint_positions(motion, body);
    check(out);
    return out;
}

JointMotion joint_motion(const ingest::Motion& motion, ingest::BodyModel body, double fps, std::string title,
                         const std::shared_ptr<const BodySkin>& skin) {
    ingest::check_takes_body(body, title);
    body.rest = skin->body().rest().rest();
    auto out = joint_motion(motion, body, fps, std::move(title));
    out.skin = skin;
    out.rotations = motion;
    return out;
}

JointMotion joint_motion(const ingest::SkeletonFile& file, std::string title) {
    const auto& topology = ingest::ntu25();
    const auto persons = static_cast<std::uint32_t>(file.bodies.size()),
               k = static_cast<std::uint32_t>(topology.joints());
    const std::size_t bodies = std::size_t{file.frames} * persons;
    JointMotion out{std::move(title),
                    topology,
                    persons,
                    file.frames,
                    30,
                    {},
                    std::vector<std::uint8_t>(bodies, 0),
                    {},
                    {},
                    {}};
    out.joints.resize(bodies * k * 3);
    const ingest::BodyModel whole{
        {}, topology, std::vector<float>(k, 1.0F), {}};  // raw limbs have their lengths still
    for (std::uint32_t p = 0; p < persons; ++p) {
        const auto& body = file.bodies[p];
        const ingest::Motion motion{"", static_cast<std::uint32_t>(body.times.size()), 1, k, 3, body.limbs};
        const auto joints = ingest::joint_positions(motion, whole);
        for (std::size_t i = 0; i < body.times.size(); ++i) {
            const std::size_t at = std::size_t{body.times[i]} * persons + p;
            out.seen[at] = 1;
            std::copy_n(&joints[i * k * 3], k * 3, &out.joints[at * k * 3]);
        }
    }
    check(out);
    return out;
}

}  // namespace actformer::reports
