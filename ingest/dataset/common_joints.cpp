#include "ingest/dataset/common_joints.hpp"

#include <array>
#include <cmath>

#include "base/error.hpp"
#include "ingest/dataset/known_topologies.hpp"

namespace actformer::ingest {
namespace {

constexpr std::size_t joints = 15;
constexpr double leg = 0.75;        // metres, about an adult's from hip to ankle
constexpr double no_length = 1e-4;  // as limbs of shards: child - parent over its length and this

using Places = std::array<std::uint32_t, joints>;

/// Where the joints of common15() are among those of another skeleton; NTU's neck joint is the one between its shoulders.
constexpr Places of_common{0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14},
    of_ntu{0, 20, 3, 4, 5, 6, 8, 9, 10, 12, 13, 14, 16, 17, 18},
    of_gta{0, 2, 1, 8, 9, 10, 4, 5, 6, 19, 20, 21, 16, 17, 18},
    of_smpl{0, 12, 15, 16, 18, 20, 17, 19, 21, 1, 4, 7, 2, 5, 8};

const Places* places_in(const Topology& topology) {
    const std::pair<const Topology*, const Places*> known[] = {
        {&ntu25(), &of_ntu}, {&smpl24(), &of_smpl}, {&gta22(), &of_gta}, {&common15(), &of_common}};
    for (const auto& [one, places] : known)
        if (topology.parents == one->parents) return places;
    return nullptr;
}

double distance(const float* a, const float* b) {
    return std::hypot(double{a[0]} - b[0], double{a[1]} - b[1], double{a[2]} - b[2]);
}

/// Joint positions, and where the common ones are among them.
struct Positions {
    const std::vector<float>& values;  ///< (frames, persons, all joints, 3)
    std::size_t frames, persons, all;
    const std::uint32_t* joints;

    const float* at(std::size_t frame, std::size_t person, std::size_t joint) const {
        return &values[((frame * persons + person) * all + joints[joint]) * 3];
    }

    /// Of both legs, over all frames.
    double mean_leg(std::size_t person) const {
        double sum = 0;
        for (std::size_t t = 0; t < frames; ++t)
            for (const std::size_t hip : {9, 12})
                for (const auto joint : {hip, hip + 1})
                    sum += distance(at(t, person, joint), at(t, person, joint + 1)) / 2;
        return sum / static_cast<double>(frames);
    }

    std::array<double, 3> mean_root() const {
        std::array<double, 3> mean{};
        for (std::size_t t = 0; t < frames; ++t)
            for (std::size_t p = 0; p < persons; ++p)
                for (std::size_t d = 0; d < 3; ++d)
                    mean[d] += at(t, p, 0)[d] / static_cast<double>(frames * persons);
        return mean;
    }
};

/// (15, 3) of a person in a frame.
void write_limbs(const Positions& positions, std::size_t frame, std::size_t person,
                 const std::array<double, 3>& centre, double scale, float* to) {
    const auto& parents = common15().parents;
    const auto* root = positions.at(frame, person, 0);
    for (std::size_t d = 0; d < 3; ++d) to[d] = static_cast<float>(scale * (root[d] - centre[d]));
    for (std::size_t j = 1; j < joints; ++j) {
        const auto *child = positions.at(frame, person, j),
                   *parent = positions.at(frame, person, static_cast<std::size_t>(parents[j]));
        const auto divisor = distance(child, parent) + no_length;
        for (std::size_t d = 0; d < 3; ++d)
            to[3 * j + d] = static_cast<float>((double{child[d]} - parent[d]) / divisor);
    }
}

}  // namespace

void expect_common_joints(const Topology& topology, const std::string& where) {
    if (!places_in(topology))
        throw Error(
            "{}: its {} joints are not those of NTU RGB+D, GTA Combat or SMPL, which alone can be seen as 15 "
            "common joints",
            where, topology.joints());
}

CommonJoints::CommonJoints(BodyModel body, const std::string& where) : body_(std::move(body)) {
    expect_common_joints(body_.topology, where);
    const auto* places = places_in(body_.topology);
    if (body_.representation == Representation::limb && body_.bone_length.empty())
        throw Error("{}: without limb lengths its joints cannot be told; write it again with this program",
                    where);
    joints_ = places->data();
}

Motion CommonJoints::of(const Motion& motion) const {
    return seen(motion, body_);
}

Motion CommonJoints::of(const Motion& motion, std::vector<float> bone_length) const {
    auto body = body_;
    body.bone_length = std::move(bone_length);
    return seen(motion, body);
}

Motion CommonJoints::seen(const Motion& motion, const BodyModel& body) const {
    const auto values = joint_positions(motion, body);
    const Positions positions{values, motion.frames, motion.persons, body.topology.joints(), joints_};
    const auto centre = positions.mean_root();
    Motion out{motion.name, motion.frames, motion.persons, joints, 3, {}};
    out.values.resize(std::size_t{motion.frames} * motion.persons * joints * 3);
    for (std::size_t p = 0; p < motion.persons; ++p) {
        const auto length = positions.mean_leg(p);
        const auto scale = length > no_length ? leg / length : 1.0;
        for (std::size_t t = 0; t < motion.frames; ++t)
            write_limbs(positions, t, p, centre, scale, &out.values[(t * motion.persons + p) * joints * 3]);
    }
    return out;
}

}  // namespace actformer::ingest
