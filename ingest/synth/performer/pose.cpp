#include "ingest/synth/performer/pose.hpp"

#include <algorithm>
#include <cmath>

namespace actformer::ingest::synth {
namespace {

constexpr std::array<Joint, 2> shoulder_of{left_shoulder, right_shoulder}, elbow_of{left_elbow, right_elbow},
    wrist_of{left_wrist, right_wrist}, hand_of{left_hand, right_hand}, tip_of{left_tip, right_tip},
    thumb_of{left_thumb, right_thumb}, hip_of{left_hip, right_hip}, knee_of{left_knee, right_knee},
    ankle_of{left_ankle, right_ankle}, foot_of{left_foot, right_foot};

/// Left is +x: what lies outwards on side `s`.
constexpr double outwards(int s) {
    return s == 0 ? 1 : -1;
}

struct Limb {
    Vec middle, end;
};

/// Two bones from `root` towards `target`, bent towards `pole`, the inner angle at least `least` degrees.
Limb two_bones(const Vec& root, const Vec& target, double upper, double lower, const Vec& pole,
               double least) {
    const double shortest =
        std::sqrt(upper * upper + lower * lower - 2 * upper * lower * std::cos(radians(least)));
    const double d = std::clamp(length(target - root), shortest, 0.9985 * (upper + lower));
    const Vec axis = normalised(target - root);
    const double along = (upper * upper - lower * lower + d * d) / (2 * d);
    const double off = std::sqrt(std::max(0.0, upper * upper - along * along));
    return {root + axis * along + normalised(reject(pole, axis)) * off, root + axis * d};
}

void legs(Figure& f, const Body& body, const std::array<Foot, 2>& feet) {
    for (int s = 0; s < 2; ++s) {
        const Vec hip = f.at[pelvis] + f.hips * Vec{outwards(s) * body.hip, -body.hip_drop, body.hip_ahead};
        const Rotation foot = about_y(feet[s].heading);
        Vec target = feet[s].place;
        target.y += body.ankle;

        // Heels rise with pointed toes: the ankle turns about the ball of the foot, which stays where it was.
        const double down = std::clamp(feet[s].toes_down, -35.0, 70.0);
        const Vec sole{0, -body.ball * body.ankle,
                       std::sqrt(std::pow(body.foot, 2) - std::pow(body.ball * body.ankle, 2))};
        const Vec toes = foot * (about_x(down) * sole);
        target += foot * sole - toes;

        const Vec to = target - hip;
        const Vec forward = normalised(foot.z + f.upright.z);
        const double ahead = std::clamp(dot(to, forward) / body.leg(), 0.0, 1.0);
        const Vec pole = forward + foot.x * (0.12 * outwards(s)) + Vec{0, ahead, 0};
        const Limb leg = two_bones(hip, target, body.thigh, body.shin, pole, 32);
        f.at[hip_of[s]] = hip;
        f.at[knee_of[s]] = leg.middle;
        f.at[ankle_of[s]] = leg.end;
        f.at[foot_of[s]] = leg.end + toes;
    }
}

/// The goal of one key in metres on the stage.
Vec goal(const HandKey& key, int s, const Figure& f, const Body& body, const Bearing& bearing,
         const Place& place, const Others& others) {
    const double o = outwards(s), size = body.scale();
    const Vec offset{o * key.x * size, key.y * size, key.z * size};
    const auto on_ribs = [&](Joint j, Vec v) { return f.at[j] + f.ribs * (v * size + offset); };
    const auto on_hips = [&](Joint j, Vec v) { return f.at[j] + f.hips * (v * size + offset); };
    const auto on_skull = [&](Vec v) { return f.at[head] + f.skull * (v * size + offset); };
    const auto aside = [&](Vec v) { return Vec{o * v.x, v.y, v.z}; };
    const Vec own_shoulder = f.at[shoulder_of[s]];
    const Rotation heading = about_y(place.heading);
    const auto on_partner = [&](const Vec& at) { return at + heading * offset; };
    const Figure& p = others.partner ? *others.partner : f;

    switch (key.at) {
        case At::rest:
            return own_shoulder +
                   f.upright * Vec{o * bearing.arms_out, -bearing.elbow_bend * body.arm(), 0.05};
        case At::reach:
            return own_shoulder + f.upright * (Vec{o * key.x, key.y, key.z} * body.arm());
        case At::chest:
            return on_ribs(chest, {0, -0.10, 0.13});
        case At::belly:
            return on_ribs(spine, {0, -0.06, 0.16});
        case At::low_back:
            return on_hips(spine, {0, -0.15, -0.15});
        case At::shoulder:
            return on_ribs(shoulder_of[1 - s], {0, 0.04, 0.07});
        case At::elbow:
            return lerp(f.at[shoulder_of[1 - s]], f.at[pelvis], 0.42) +
                   f.upright * (aside({-0.10, 0, 0.13}) * size + offset);
        case At::throat:
            return on_ribs(neck, {0, -0.04, 0.09});
        case At::nape:
            return on_ribs(neck, {0, 0.05, -0.09});
        case At::mouth:
            return on_skull({0, -0.06, 0.13});
        case At::nose:
            return on_skull({0, -0.02, 0.15});
        case At::brow:
            return on_skull(aside({0.02, 0.07, 0.14}));
        case At::eye:
            return on_skull(aside({0.035, 0.02, 0.14}));
        case At::ear:
            return on_skull(aside({0.10, 0.0, 0.03}));
        case At::crown:
            return on_skull({0, 0.13, 0});
        case At::pocket:
            return on_hips(hip_of[s], aside({0.10, -0.04, 0.06}));
        case At::back_pocket:
            return on_hips(hip_of[s], aside({0.05, -0.03, -0.14}));
        case At::waist:
            return on_hips(pelvis, aside({0.19, 0.10, 0.02}));
        case At::thigh:
            return lerp(f.at[hip_of[s]], f.at[knee_of[s]], 0.72) +
                   heading * (Vec{0, 0.06, 0.07} * size + offset);
        case At::knee:
            return f.at[knee_of[s]] + heading * (Vec{0, 0.05, 0.07} * size + offset);
        case At::foot:
            return f.at[foot_of[s]] + heading * (Vec{0, 0.06, 0} * size + offset);
        case At::other_foot:
            return f.at[foot_of[1 - s]] + heading * (Vec{0, 0.06, 0} * size + offset);
        case At::floor:
            return place.position + heading * (aside({0.08, 0.05, 0.36}) * size + offset);
        case At::meet:
            return others.meeting + others.stage * (Vec{key.x, key.y, key.z} * size);
        case At::partner_head:
            return on_partner(p.at[head]);
        case At::partner_ear:
            return on_partner(p.at[head]);
        case At::partner_chest:
            return on_partner(p.at[chest] + p.ribs * Vec{0, -0.06, 0.12});
        case At::partner_belly:
            return on_partner(p.at[spine] + p.ribs * Vec{0, -0.05, 0.13});
        case At::partner_back:
            return on_partner(p.at[chest] + p.ribs * Vec{0, -0.08, -0.12});
        case At::partner_nape:
            return on_partner(p.at[neck] + p.ribs * Vec{0, 0, -0.07});
        case At::partner_shoulder:
            return on_partner(p.at[shoulder_of[1 - s]] + Vec{0, 0.03, 0});
        case At::partner_pocket:
            return on_partner(p.at[hip_of[s]] + p.hips * aside({0.10, -0.04, -0.04}));
    }
    return own_shoulder;
}

/// Where a point lies against the trunk, seen as an elliptic cylinder: 0 on its axis, 1 on the skin.
struct Girth {
    Vec centre, local;
    double depth;
};

Girth girth_at(const Vec& point, const Figure& f, const Body& body) {
    const Vec axis = f.at[neck] - f.at[pelvis];
    const double along = dot(point - f.at[pelvis], axis) / dot(axis, axis);
    Girth g;
    g.centre = f.at[pelvis] + axis * along;
    g.local = f.ribs.into(point - g.centre);
    g.depth = std::hypot(g.local.x / (0.165 * body.scale()), g.local.z / (0.115 * body.scale()));
    if (along < -0.25 || along > 1) g.depth = 9;  // below or above it
    return g;
}

/// Pushes a point out of trunk and head, so that hands go around them.
Vec outside(const Vec& point, const Figure& f, const Body& body) {
    Vec p = point;
    if (const auto g = girth_at(p, f, body); g.depth < 1) {
        const double out = 1 / std::max(g.depth, 0.2);
        p = g.centre + f.ribs * Vec{g.local.x * out, g.local.y, g.local.z * out};
    }
    const Vec from_head = p - f.at[head];
    const double r = 0.105 * body.scale(), d = length(from_head);
    if (d < r) p = f.at[head] + from_head * (r / std::max(d, 0.02));
    return p;
}

/// Between low and high goals a hand swings out to the front, and does not slip past the armpit.
Vec on_its_way(const Vec& a, const Vec& b, double weight, const Figure& f, const Body& body) {
    const double climb = std::clamp(std::abs(b.y - a.y) / (0.5 * body.scale()), 0.0, 1.0);
    return lerp(a, b, weight) + f.upright.z * (0.17 * body.scale() * climb * 4 * weight * (1 - weight));
}

/// The collarbone follows the arm a little: up with a raised hand, forward with one that reaches out.
Vec shoulder_at(const Figure& f, const Body& body, int s, const Vec& target) {
    const Vec base{outwards(s) * body.shoulder, -body.shoulder_drop, 0};
    const Vec way = f.ribs.into(target - (f.at[chest] + f.ribs * base)) * (1 / body.arm());
    const double far = std::clamp(length(way), 0.3, 1.0);
    const Vec lean{0, 0.30 * std::max(0.0, way.y + 0.25) * far, 0.28 * std::clamp(way.z, -0.5, 1.0) * far};
    return f.at[chest] + f.ribs * (normalised(base + lean * body.shoulder) * length(base));
}

double rise(double from, double to, double at) {
    return ease((at - from) / (to - from));
}

/// Down, outwards and back, as elbows hang; below a hand before the face; outwards when it is overhead or
/// behind.
Vec elbow_pole(const Figure& f, const Vec& way, int s, double raised) {
    const Vec local = normalised(f.upright.into(way));
    const double behind = std::max(0.0, -local.z), high = rise(-0.5, 0.6, local.y),
                 overhead = rise(0.5, 1.05, local.y);
    const Vec pole{outwards(s) * (0.42 - 0.05 * high + 1.3 * overhead + 0.8 * behind), -1 + 0.8 * overhead,
                   -0.55 + 0.8 * high};
    return turned(f.upright * pole, f.upright * local, outwards(s) * raised);
}

void hand(Figure& f, const Body& body, const Posture& posture, int s) {
    const double grip = std::clamp(posture.c[lgrip + s], 0.0, 1.0), o = outwards(s);
    const Vec along = normalised(f.at[wrist_of[s]] - f.at[elbow_of[s]]);
    Vec thumb = normalised(reject(f.upright * Vec{-0.5 * o, 0.6, 0.6}, along));
    thumb = turned(thumb, along, -o * posture.c[lroll + s]);
    const Vec fingers = turned(along, thumb, o * std::clamp(posture.c[lflex + s], -60.0, 65.0));
    f.at[hand_of[s]] = f.at[wrist_of[s]] + fingers * body.hand;
    f.at[tip_of[s]] = f.at[hand_of[s]] + turned(fingers, thumb, o * (12 + 105 * grip)) * body.tip;
    f.at[thumb_of[s]] = f.at[hand_of[s]] + normalised(thumb + fingers * 0.35) * body.thumb;
}

struct Trunk {
    Vec pelvis;
    Rotation hips;
    double spine_bend;
};

/// The pelvis before the legs have their say. A bend is shared between hips and spine.
Trunk trunk_of(const Body& body, const Bearing& bearing, const Place& place, const Posture& posture) {
    const auto& c = posture.c;
    const Rotation heading = about_y(place.heading);
    Trunk t;
    const double hip_bend = c[pitch] + (c[bend] > 0 ? 0.42 : 0.3) * c[bend];
    t.spine_bend = c[bend] + bearing.slouch - (hip_bend - c[pitch]);
    t.hips = heading * about_y(c[yaw]) * about_x(hip_bend) * about_z(c[roll] + 0.25 * c[side]);

    // Weight stays above the feet: the seat goes back when the trunk goes forward or the knees bend, unless
    // in the air or on a chair, where the programme says where the seat is.
    const double lean = std::clamp(hip_bend + 0.5 * t.spine_bend, -20.0, 90.0);
    const double back = 0.20 * std::sin(radians(lean)) + 0.10 * std::clamp(-c[py], 0.0, 0.4);
    const double free =
        (1 - 0.7 * std::clamp(c[lift] * 10, 0.0, 1.0)) * (1 - std::clamp(-4 * c[pz], 0.0, 1.0));
    t.pelvis = place.position + heading * (Vec{c[px], 0, c[pz] - back * free} * body.scale());
    t.pelvis.y = body.standing() + c[lift] + c[py] * body.scale();
    return t;
}

}  // namespace

double sink_needed(const Body& body, const Bearing& bearing, const Place& place, const Posture& posture,
                   const std::array<Foot, 2>& feet) {
    const Trunk t = trunk_of(body, bearing, place, posture);
    double sink = 0;
    for (int s = 0; s < 2; ++s) {
        const Vec hip = t.pelvis + t.hips * Vec{outwards(s) * body.hip, -body.hip_drop, body.hip_ahead};
        const double dx = hip.x - feet[s].place.x, dz = hip.z - feet[s].place.z;
        const double reach2 = std::pow(0.994 * body.leg(), 2) - dx * dx - dz * dz;
        const double top = body.ankle + feet[s].place.y + feet[s].slack + std::sqrt(std::max(0.04, reach2));
        sink = std::max(sink, hip.y - top);
    }
    return sink;
}

Figure stand(const Body& body, const Bearing& bearing, const Place& place, const Posture& posture,
             const std::array<Foot, 2>& feet, double sink) {
    const auto& c = posture.c;
    const Trunk t = trunk_of(body, bearing, place, posture);
    const double spine_bend = t.spine_bend;
    Figure f;
    f.hips = t.hips;
    f.at[pelvis] = t.pelvis - Vec{0, sink, 0};

    const auto spine_frame = [&](double part) {
        return f.hips * about_y(part * c[twist]) * about_x(part * spine_bend) *
               about_z(part * 0.75 * c[side]);
    };
    f.at[spine] = f.at[pelvis] + spine_frame(0.2) * Vec{0, body.lower_spine, 0};
    f.ribs = spine_frame(0.9);
    f.at[chest] = f.at[spine] + spine_frame(0.75) * Vec{0, body.upper_spine, 0};
    f.at[neck] = f.at[chest] + spine_frame(1) * about_x(0.25 * c[nod]) * Vec{0, body.neck, 0};
    f.skull = f.ribs * about_x(-0.6 * bearing.slouch) * about_y(c[turn]) * about_x(c[nod] + bearing.chin) *
              about_z(c[tilt]);
    f.at[head] = f.at[neck] + f.skull * (normalised(Vec{0, 1, 0.12}) * body.head);

    const Vec flat{f.ribs.x.x, 0, f.ribs.x.z};
    f.upright.x = normalised(flat);
    f.upright.z = cross(f.upright.x, f.upright.y);
    legs(f, body, feet);
    for (int s = 0; s < 2; ++s)
        f.at[shoulder_of[s]] =
            f.at[chest] + f.ribs * Vec{outwards(s) * body.shoulder, -body.shoulder_drop, 0};
    return f;
}

void reach(Figure& f, const Body& body, const Bearing& bearing, const Place& place, const Posture& posture,
           const Others& others, const std::array<Vec, 2>& shift, Elbows& elbows) {
    for (int s = 0; s < 2; ++s) {
        const auto& h = posture.hands[s];
        const Vec a = goal(*h.from, s, f, body, bearing, place, others);
        const Vec b = goal(*h.to, s, f, body, bearing, place, others);
        const Channel first = s == 0 ? lx : rx;
        const Vec wave{outwards(s) * posture.c[first], posture.c[first + 1], posture.c[first + 2]};
        Vec target = on_its_way(a, b, h.weight, f, body) + f.upright * (wave * body.scale()) + shift[s];
        target = outside(target, f, body);

        const Vec root = shoulder_at(f, body, s, target);
        const Vec axis = normalised(target - root);
        const double lower = body.forearm + body.hand;
        const auto towards = [&](const Vec& pole) {
            return two_bones(root, target, body.upper_arm, lower, pole, 26);
        };

        // An elbow that would sink into the trunk is raised.
        const Limb close = towards(elbow_pole(f, target - root, s, posture.c[lelbow + s]));
        const double depth = std::min(girth_at(close.middle, f, body).depth,
                                      girth_at(lerp(close.middle, close.end, 0.3), f, body).depth);
        const double raised = posture.c[lelbow + s] + 80 * std::clamp(1.1 - depth, 0.0, 1.0);
        const Vec wanted = normalised(reject(elbow_pole(f, target - root, s, raised), axis));
        const Vec before = reject(elbows[s], axis);
        const Vec pole = normalised(lerp(wanted, before, length(before) > 1e-6 ? 0.75 : 0.0));
        elbows[s] = pole;
        const Limb arm = towards(pole);
        f.at[shoulder_of[s]] = root;
        f.at[elbow_of[s]] = arm.middle;
        f.at[wrist_of[s]] = lerp(arm.middle, arm.end, body.forearm / lower);
        hand(f, body, posture, s);
    }
}

}  // namespace actformer::ingest::synth
