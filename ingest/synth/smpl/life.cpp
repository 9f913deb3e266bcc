#include "ingest/synth/smpl/life.hpp"

#include <algorithm>
#include <cmath>

#include "ingest/synth/rotation_vector.hpp"

namespace actformer::ingest::synth {
namespace {

constexpr double frames_a_second = 30;

/// One axis of one joint over time.
class Turning {
  public:
    Turning(const Life& life, Random& random) : habit_(life.habit * random.normal()) {
        // Slow waves are the larger ones; the squares of their shares add up to 1.
        constexpr std::array<Wave, wave_count> bands{
            {{0.3, 0.6, 0.8}, {0.6, 1.1, 0.5}, {1.1, 2.0, 0.33166247903554}}};
        for (std::size_t i = 0; i < wave_count; ++i) {
            rate_[i] = random.uniform(bands[i].from, bands[i].to);
            phase_[i] = random.uniform();
            size_[i] = life.sway * bands[i].share * std::sqrt(2.0);
        }
    }

    /// Degrees.
    double at(double seconds) const {
        double out = habit_;
        for (std::size_t i = 0; i < wave_count; ++i)
            out += size_[i] * std::sin(2 * pi * (phase_[i] + rate_[i] * seconds));
        return out;
    }

  private:
    struct Wave {
        double from, to, share;  ///< Hz
    };
    static constexpr std::size_t wave_count = 3;
    double habit_;
    std::array<double, wave_count> rate_{}, phase_{}, size_{};
};

/// Rotation vectors to be added, radians.
using Small = std::array<Vec, smpl_joints>;

/// How much of it each joint has. The pelvis carries everything; hands are small, and estimated badly.
double share_of(std::size_t joint) {
    switch (joint) {
        case pelvis24:
            return 0.6;
        case left_hand24:
        case right_hand24:
            return 2;
        default:
            return 1;
    }
}

/// Two bones and what stands or grips at their end.
struct Chain {
    std::size_t upper, lower, end, tip;
    Vec hinge;  ///< axis of the lower joint
};
const std::array<Chain, 4> chains{
    {{left_hip24, left_knee24, left_ankle24, left_foot24, {1, 0, 0}},
     {right_hip24, right_knee24, right_ankle24, right_foot24, {1, 0, 0}},
     {left_shoulder24, left_elbow24, left_wrist24, left_hand24, {0, 1, 0}},
     {right_shoulder24, right_elbow24, right_wrist24, right_hand24, {0, 1, 0}}}};

/// The turn about `hinge` after which the unit vector `bone` has cosine `wanted` with `along`, which is at right angles to the hinge; the
/// joint stays bent to its side. Radians.
double bend_to(double wanted, const Vec& bone, const Vec& along, const Vec& hinge) {
    const double p = dot(bone, along), q = dot(bone, cross(hinge, along));
    const double now = std::atan2(q, p), size = std::hypot(p, q);
    return std::copysign(std::acos(std::clamp(wanted / size, -1.0, 1.0)), now) - now;
}

/// A pose built anew from another one, parents first.
class Alive {
  public:
    Alive(const SmplPose& still, const Small& small)
        : still_(still), was_(smpl_placed(still)), small_(small) {
        trunk();
        for (const auto& chain : chains) limb(chain);
    }
    SmplPose pose() const { return smpl_pose(at_[0], world_); }

  private:
    const SmplPose& still_;
    SmplPlaced was_;
    const Small& small_;
    SmplTurns world_;
    std::array<Vec, smpl_joints> at_;

    Rotation added(std::size_t joint) const { return rotation_of(small_[joint]); }

    void put(std::size_t joint) {
        const auto parent = static_cast<std::size_t>(smpl24_parents[joint]);
        at_[joint] = at_[parent] + world_[parent] * smpl_offsets()[joint];
    }
    void turn(std::size_t joint) {
        put(joint);
        world_[joint] =
            world_[static_cast<std::size_t>(smpl24_parents[joint])] * still_.turned[joint] * added(joint);
    }
    /// As it was on the stage, which undoes what parents added.
    void keep(std::size_t joint) {
        put(joint);
        world_[joint] = was_.world[joint];
    }

    void trunk() {
        world_[pelvis24] = was_.world[pelvis24] * added(pelvis24);
        at_[pelvis24] = was_.at[pelvis24];
        // No hip rises: legs that were nearly straight would come off the floor.
        double rise = 0;
        for (const auto hip : {left_hip24, right_hip24})
            rise = std::max(rise, (world_[pelvis24] * smpl_offsets()[hip] + at_[pelvis24] - was_.at[hip]).y);
        at_[pelvis24].y -= rise;
        turn(spine1);
        turn(spine2);
        keep(spine3);
        turn(neck24);
        keep(head24);
        world_[head24] = world_[head24] * added(head24);
        turn(left_collar);
        turn(right_collar);
    }

    /// The lower joint twists and tilts; then it bends, and the upper joint turns, until the end is where it was.
    void limb(const Chain& c) {
        put(c.upper);
        const Vec upper = smpl_offsets()[c.lower], lower = smpl_offsets()[c.end];
        const double a = length(upper), b = length(lower);
        const Vec way = was_.at[c.end] - at_[c.upper], towards = normalised(way);
        const double straight = std::max(0.9985 * (a + b), length(was_.at[c.end] - was_.at[c.upper]));
        const double far = std::min(length(way), straight);
        const Rotation tilted = still_.turned[c.lower] * rotation_of(reject(small_[c.lower], c.hinge));
        const double bend = bend_to((far * far - a * a - b * b) / (2 * a * b), tilted * normalised(lower),
                                    normalised(upper), c.hinge);
        const Rotation below = rotation_of(c.hinge * bend) * tilted;

        const Rotation swung = rotation_of(towards * small_[c.upper].x) * was_.world[c.upper];
        world_[c.upper] = shortest_turn(normalised(swung * (upper + below * lower)), towards) * swung;
        put(c.lower);
        world_[c.lower] = world_[c.upper] * below;
        keep(c.end);
        turn(c.tip);
    }
};

}  // namespace

void enliven(std::vector<SmplPose>& motion, const Life& life, Random random) {
    std::vector<std::array<Turning, 3>> joints;
    for (std::size_t j = 0; j < smpl_joints; ++j) {
        const Life here{life.habit * share_of(j), life.sway * share_of(j)};
        joints.push_back({Turning(here, random), Turning(here, random), Turning(here, random)});
    }
    for (std::size_t f = 0; f < motion.size(); ++f) {
        const double seconds = static_cast<double>(f) / frames_a_second;
        Small small;
        for (std::size_t j = 0; j < smpl_joints; ++j) {
            const auto& [x, y, z] = joints[j];
            small[j] = Vec{x.at(seconds), y.at(seconds), z.at(seconds)} * (pi / 180);
        }
        motion[f] = Alive(motion[f], small).pose();
    }
}

}  // namespace actformer::ingest::synth
