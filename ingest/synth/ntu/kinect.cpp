#include "ingest/synth/ntu/kinect.hpp"

#include <algorithm>
#include <cmath>

#include "ingest/dataset/topology.hpp"
#include "ingest/synth/random.hpp"

namespace actformer::ingest::synth {
namespace {

struct Camera {
    Rotation axes;
    Vec position;

    Vec view(const Vec& v) const { return axes.into(v - position); }
};

/// Setups differ in the height of the tripod and its distance; cameras of one setup stand on a circle. They are about as high as the
/// middle of a body and look at it, so that y of their axes is up within five degrees: people who stand stand upright.
Camera camera_of(int setup, int camera) {
    Random random{0x5E7, static_cast<std::uint64_t>(setup)};
    const double height = random.uniform(0.75, 1.15), distance = random.uniform(2.75, 3.6);
    const double angle = 45.0 * (camera - 2);
    const Rotation around = about_y(angle);
    const Vec position = around * Vec{0, 0, -distance} + Vec{0, height, 0};
    const double down = std::atan2(height - 0.95, distance) * 180 / pi;
    return {around * about_x(down), position};
}

/// Jitter of one joint in millimetres at 3 m: white from frame to frame, and slow, against the joint before
/// it.
struct Jitter {
    double white, slow;
};

Jitter jitter_of(int joint) {
    switch (joint) {
        case pelvis:
            return {0.2, 5};
        case spine:
        case chest:
            return {0.25, 5};
        case left_hip:
        case right_hip:
            return {0.3, 2.5};
        case neck:
            return {0.5, 2.5};
        case head:
            return {0.6, 6};
        case left_shoulder:
        case right_shoulder:
            return {0.6, 7};
        case left_elbow:
        case right_elbow:
            return {0.9, 13};
        case left_wrist:
        case right_wrist:
            return {2.5, 14};
        case left_hand:
        case right_hand:
            return {4.0, 12};
        case left_tip:
        case right_tip:
        case left_thumb:
        case right_thumb:
            return {6.5, 11};
        case left_knee:
        case right_knee:
            return {0.6, 10};
        case left_ankle:
        case right_ankle:
            return {1.2, 12};
        default:
            return {3.5, 13};  // feet
    }
}

/// A part of a body that hides what is behind it.
struct Cover {
    Joint from, to;
    double radius;
};
constexpr std::array<Cover, 8> covers = {{{pelvis, spine, 0.13},
                                          {spine, chest, 0.15},
                                          {neck, head, 0.10},
                                          {left_shoulder, right_shoulder, 0.08},
                                          {left_hip, left_knee, 0.075},
                                          {right_hip, right_knee, 0.075},
                                          {left_knee, left_ankle, 0.055},
                                          {right_knee, right_ankle, 0.055}}};

/// Is `p` behind the bone a-b of the given radius, seen from the origin? `margin` metres behind at least.
bool behind(const Vec& p, const Vec& a, const Vec& b, double radius, double margin) {
    // Compared on the plane at the depth of `p`: cheap, and exact enough for limbs.
    const double ka = p.z / a.z, kb = p.z / b.z;
    const double ax = a.x * ka - p.x, ay = a.y * ka - p.y, bx = b.x * kb - p.x, by = b.y * kb - p.y;
    const double dx = bx - ax, dy = by - ay;
    const double u = std::clamp(-(ax * dx + ay * dy) / (dx * dx + dy * dy + 1e-9), 0.0, 1.0);
    const double depth = a.z + (b.z - a.z) * u;
    if (p.z < depth + margin) return false;
    const double x = ax + u * dx, y = ay + u * dy, r = radius * p.z / depth;
    return x * x + y * y < r * r;
}

bool limb_joint(int j) {
    return (j >= left_elbow && j <= left_hand) || (j >= right_elbow && j <= right_hand) ||
           (j >= left_knee && j <= left_foot) || (j >= right_knee && j <= right_foot) || j >= left_tip;
}

bool hidden(const std::array<Joints, 2>& bodies, int persons, int p, int j) {
    const Vec& at = bodies[p][j];
    for (const auto& c : covers) {
        if (limb_joint(j) && c.from != j && c.to != j) {
            const bool own_leg = (j >= left_hip && j <= right_foot) && c.from >= left_hip &&
                                 (c.from >= right_hip) == (j >= right_hip);
            if (!own_leg && behind(at, bodies[p][c.from], bodies[p][c.to], c.radius, 0.09)) return true;
        }
        if (persons == 2 && behind(at, bodies[1 - p][c.from], bodies[1 - p][c.to], c.radius, 0.12))
            return true;
    }
    return false;
}

/// Hands at the face, at each other or at the trunk run together with what they touch.
bool confusable(const Joints& body, int j) {
    const bool left = j == left_wrist || j == left_hand || j == left_tip || j == left_thumb;
    const bool right = j == right_wrist || j == right_hand || j == right_tip || j == right_thumb;
    if (!left && !right) return false;
    const auto near = [&](Joint other, double reach) { return length(body[j] - body[other]) < reach; };
    return near(head, 0.2) || near(left ? right_hand : left_hand, 0.13) || near(spine, 0.2) ||
           near(chest, 0.2);
}

/// Whether the tracker is sure of a joint, and how far off it is: doubts come, stay a while, and fade.
struct Doubt {
    int left = 0;  ///< frames of doubt to come
    bool lost = false;
    double weight = 0;  ///< 0 sure .. 1 guessing
    Vec error;          ///< where guessing leads, metres
};

class Tracker {
  public:
    Tracker(Random random, double depth) : random_(random), far_(std::clamp(depth * depth / 9.0, 0.5, 2.2)) {
        for (auto& joint : slow_)
            for (auto& axis : joint) axis.start(random_);
    }

    /// Spoils the joints of one body in one frame. Part of a joint's slow error is handed on to the joints it
    /// carries.
    void spoil(SeenBody& body, const std::array<Joints, 2>& truth, int persons, int p) {
        static const auto order = ntu25().order();
        static const auto& parents = ntu25().parents;
        Joints drift;
        for (const auto k : order) {
            const int j = static_cast<int>(k);
            auto& seen = body.joint[j];
            const Vec at = truth[p][j];
            auto& d = doubt_[j];
            doubt(d, j, hidden(truth, persons, p, j), confusable(truth[p], j));
            const auto [white, slow] = jitter_of(j);
            const double w = 0.001 * white * far_ * (1 + 2 * d.weight);
            const double s = 0.001 * slow * std::sqrt(far_) * (1 + d.weight);
            drift[j] = wander(j) * s + (j == pelvis ? Vec{} : drift[parents[j]] * 0.7);
            const Vec noise = drift[j] + Vec{random_.normal(), random_.normal(), 2.0 * random_.normal()} * w;
            seen.at = at + noise + d.error * d.weight;
            seen.tracking = d.left == 0 ? Tracking::tracked : d.lost ? Tracking::lost : Tracking::inferred;
        }
    }

  private:
    void doubt(Doubt& d, int j, bool out_of_sight, bool mixed_up) {
        if (out_of_sight && d.left == 0 && random_.chance(0.6)) begin(d, 0.045, 4 + random_.below(10));
        if (out_of_sight && d.left > 0) d.left = std::max(d.left, 2);
        if (mixed_up && d.left == 0 && random_.chance(0.08)) begin(d, 0.022, 3 + random_.below(12));
        if (limb_joint(j) && d.left == 0 && random_.chance(0.004)) begin(d, 0.02, 2 + random_.below(8));
        if (d.left > 0) --d.left;
        d.weight += ((d.left > 0 ? 1.0 : 0.0) - d.weight) * 0.35;
        if (d.left > 0) d.error += Vec{random_.normal(), random_.normal(), random_.normal()} * 0.006;
    }

    /// Slow error of one joint, smooth from frame to frame, of deviation about 1.
    Vec wander(int j) {
        auto& a = slow_[j];
        const Vec next{a[0].next(random_), a[1].next(random_), 1.4 * a[2].next(random_)};
        smooth_[j] += (next * 1.35 - smooth_[j]) * 0.2;
        return smooth_[j];
    }

    void begin(Doubt& d, double size, int frames) {
        d.left = frames;
        d.lost = random_.chance(0.08);
        const double s = size * (d.lost ? 1.8 : 1.0);
        d.error = Vec{random_.normal(), random_.normal(), 1.3 * random_.normal()} * s;
    }

    using Axes = std::array<Wander, 3>;
    template <std::size_t... j>
    static std::array<Axes, joints> make(std::index_sequence<j...>) {
        return {((void)j, Axes{Wander(9), Wander(9), Wander(9)})...};
    }

    Random random_;
    double far_;  ///< noise grows with the square of depth: 1 at 3 m
    std::array<Axes, joints> slow_ = make(std::make_index_sequence<joints>{});
    Joints smooth_{};
    std::array<Doubt, joints> doubt_{};
};

Quaternion quaternion(const Rotation& r) {
    const double trace = r.x.x + r.y.y + r.z.z;
    Quaternion q;
    if (trace > 0) {
        const double s = 2 * std::sqrt(1 + trace);
        q = {s / 4, (r.y.z - r.z.y) / s, (r.z.x - r.x.z) / s, (r.x.y - r.y.x) / s};
    } else if (r.x.x > r.y.y && r.x.x > r.z.z) {
        const double s = 2 * std::sqrt(1 + r.x.x - r.y.y - r.z.z);
        q = {(r.y.z - r.z.y) / s, s / 4, (r.y.x + r.x.y) / s, (r.z.x + r.x.z) / s};
    } else if (r.y.y > r.z.z) {
        const double s = 2 * std::sqrt(1 + r.y.y - r.x.x - r.z.z);
        q = {(r.z.x - r.x.z) / s, (r.y.x + r.x.y) / s, s / 4, (r.z.y + r.y.z) / s};
    } else {
        const double s = 2 * std::sqrt(1 + r.z.z - r.x.x - r.y.y);
        q = {(r.x.y - r.y.x) / s, (r.z.x + r.x.z) / s, (r.z.y + r.y.z) / s, s / 4};
    }
    return q;
}

bool leaf(int j) {
    return j == head || j == left_foot || j == right_foot || j >= left_tip;
}

/// Bones along y, the normal of the body or of the bent limb along z, as the Kinect gives them. Ends of limbs
/// have none.
void orient(SeenBody& body) {
    const auto at = [&](int j) { return body.joint[j].at; };
    const auto& parents = ntu25().parents;
    const Vec across = normalised(at(left_shoulder) - at(right_shoulder));
    const Vec front = normalised(cross(across, normalised(at(chest) - at(pelvis))));
    for (int j = 0; j < joints; ++j) {
        if (leaf(j)) continue;
        const Vec y = normalised(j == pelvis ? at(spine) - at(pelvis) : at(j) - at(parents[j]));
        Vec normal = front;
        if (j == left_wrist || j == left_hand) normal = at(left_thumb) - at(left_hand);
        if (j == right_wrist || j == right_hand) normal = at(right_thumb) - at(right_hand);
        Vec z = reject(normal, y);
        if (dot(z, z) < 1e-6) z = reject(across, y);
        z = normalised(z);
        body.joint[j].orientation = quaternion({cross(y, z), y, z});
    }
}

/// Hand states and leaning as the sensor reports them beside the joints.
void fill_header(SeenBody& body, Random& random) {
    const auto confident = [&](int hand) {
        return body.joint[hand].tracking == Tracking::tracked && random.chance(0.7) ? 1 : 0;
    };
    const int l = confident(left_hand), r = confident(right_hand);
    body.flags = {0, l, l ? 2 + random.below(2) : 0, r, r ? 2 + random.below(2) : 0, 0};
    const Vec lean = body.joint[chest].at - body.joint[pelvis].at;
    const double up = std::max(0.05, std::abs(lean.y));
    body.lean_x = std::clamp(lean.x / up, -1.0, 1.0);
    body.lean_y = std::clamp(-lean.z / up, -1.0, 1.0);
}

/// Frames from..to are without a body.
struct Gap {
    std::size_t from, to;
};

std::vector<Gap> gaps_of(std::size_t frames, Random& random) {
    std::vector<Gap> out;
    const auto some = [&](int most) { return std::size_t{1} + static_cast<std::size_t>(random.below(most)); };
    if (random.chance(0.06)) out.push_back({0, some(10)});
    if (random.chance(0.05)) out.push_back({frames - some(8), frames});
    for (const double p : {0.13, 0.04})
        if (random.chance(p)) {
            const std::size_t from =
                static_cast<std::size_t>(random.uniform(0.15, 0.75) * static_cast<double>(frames));
            out.push_back({from, std::min(from + some(7), frames - 1)});
        }
    return out;
}

bool in_gap(const std::vector<Gap>& gaps, std::size_t f) {
    return std::any_of(gaps.begin(), gaps.end(), [f](const Gap& g) { return f >= g.from && f < g.to; });
}

/// A chair taken for a person: a crumpled body beside the real one that hardly moves, for a short time.
struct Ghost {
    std::size_t from = 0, to = 0;
    std::array<Joints, 2> at{};
};

Ghost ghost_of(std::size_t frames, const Joints& person, Random& random) {
    Ghost g;
    if (!random.chance(0.07)) return g;
    const int longest = std::max(6, static_cast<int>(frames) / 3);
    g.from = static_cast<std::size_t>(random.below(static_cast<int>(frames) - 6));
    g.to = std::min(frames, g.from + 4 + static_cast<std::size_t>(random.below(longest - 4)));
    const double aside = (random.chance(0.5) ? 1 : -1) * random.uniform(0.7, 1.2);
    const Vec centre = person[pelvis] + Vec{aside, -0.25, random.uniform(-0.2, 0.6)};
    for (int j = 0; j < joints; ++j) {
        const Vec from = person[j] - person[pelvis];
        const Vec crumpled{0.9 * from.x, 0.55 * from.y, 0.9 * from.z};
        g.at[0][j] = centre + crumpled + Vec{random.normal(), random.normal(), random.normal()} * 0.05;
    }
    return g;
}

/// Identities are large and differ from clip to clip; they rise with each body that appears.
std::uint64_t first_id(Random& random) {
    return 72057594037930000u + static_cast<std::uint64_t>(random.below(7000));
}

}  // namespace

std::vector<std::array<Joints, 2>> viewed(const Performance& performance, int setup, int camera) {
    const auto c = camera_of(setup, camera);
    auto out = performance.frames;
    for (auto& frame : out)
        for (int p = 0; p < performance.persons; ++p)
            for (auto& v : frame[p]) v = c.view(v);
    return out;
}

Recording record(const Performance& performance, const NtuCasting& casting, int camera) {
    Random random{casting.seed,
                  0xCA3E7A,
                  static_cast<std::uint64_t>(casting.setup),
                  static_cast<std::uint64_t>(casting.performer),
                  static_cast<std::uint64_t>(casting.replication),
                  static_cast<std::uint64_t>(casting.action),
                  static_cast<std::uint64_t>(camera)};
    const auto truth = viewed(performance, casting.setup, camera);
    const auto frames = truth.size();

    std::vector<Tracker> trackers;
    std::vector<std::vector<Gap>> gaps;
    for (int p = 0; p < performance.persons; ++p) {
        trackers.emplace_back(Random{random.bits()}, truth[0][p][pelvis].z);
        gaps.push_back(gaps_of(frames, random));
    }
    const auto ghost = ghost_of(frames, truth[0][0], random);
    Tracker ghost_tracker(Random{random.bits()}, 1.6 * truth[0][0][pelvis].z);
    const auto id = first_id(random);
    const bool second_first = random.chance(0.5);
    const auto swap_at =
        random.chance(0.3) ? frames * static_cast<std::size_t>(random.below(80) + 10) / 100 : frames;

    Recording out(frames);
    for (std::size_t f = 0; f < frames; ++f) {
        for (int i = 0; i < performance.persons; ++i) {
            const int p = performance.persons == 2 && second_first != (f >= swap_at) ? 1 - i : i;
            SeenBody body;
            body.id = id + static_cast<std::uint64_t>(p);
            trackers[p].spoil(body, truth[f], performance.persons, p);
            if (in_gap(gaps[p], f)) continue;
            orient(body);
            fill_header(body, random);
            out[f].push_back(body);
        }
        if (f >= ghost.from && f < ghost.to) {
            SeenBody body;
            body.id = id + 7;
            ghost_tracker.spoil(body, ghost.at, 1, 0);
            orient(body);
            fill_header(body, random);
            out[f].insert(random.chance(0.5) ? out[f].begin() : out[f].end(), body);
        }
    }
    return out;
}

}  // namespace actformer::ingest::synth
