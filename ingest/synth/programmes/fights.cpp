#include "ingest/synth/programmes/fights.hpp"

namespace actformer::ingest::synth {
namespace {

using enum At;

constexpr HandKey guard{0, reach, -0.08, -0.08, 0.42};

HandKey at(double t, HandKey key) {
    key.t = t;
    return key;
}

/// Both feet apart, fists up: how both stand who fight.
Programme& ready(Programme& p) {
    return p.both({at(0, guard)})
        .hold(lfz, 0.14)
        .hold(rfz, -0.14)
        .hold(py, -0.06)
        .hold(bend, 7)
        .wave(py, 0.012, 1.8, 0, 1)
        .fists(1, 1);
}

Programme fight(double seconds, double distance) {
    auto p = Programme(0, seconds).facing(distance);
    ready(p);
    ready(p.other());
    return p.first();
}

/// The head is thrown back, and the body gives way by `back` metres.
Programme& hit_at(Programme& p, double t, double back) {
    return p.move(nod, {{t, 0}, {t + 0.06, -28}, {t + 0.2, 0}})
        .move(turn, {{t, 0}, {t + 0.06, 22}, {t + 0.22, 0}})
        .move(twist, {{t, 0}, {t + 0.08, 14}, {t + 0.24, 0}})
        .move(wz, {{t, 0}, {t + 0.3, -back}});
}

std::vector<Programme> with_fists() {
    return {// Left, right: two blows to the head, the second knocks back.
            hit_at(fight(3.0, 0.9)
                       .touch_at(0.62)
                       .left({{0.2, reach, -0.08, -0.08, 0.42},
                              {0.32, partner_head, 0, -0.02, -0.1},
                              {0.44, reach, -0.08, -0.08, 0.42}})
                       .right({{0.46, reach, 0.05, -0.12, 0.25},
                               {0.62, partner_head, 0, -0.02, -0.09},
                               {0.72, reach, -0.1, -0.05, 0.6},
                               {0.85, reach, -0.08, -0.08, 0.42}})
                       .move(twist, {{0.2, 0}, {0.32, -20}, {0.48, -26}, {0.62, 28}, {0.85, 0}})
                       .move(pz, {{0.2, 0}, {0.32, 0.08}, {0.46, 0}, {0.62, 0.14}, {0.85, 0}})
                       .other()
                       .move(nod, {{0.31, 0}, {0.37, -16}, {0.46, 0}})
                       .both({at(0.6, guard), {0.74, reach, 0.35, -0.3, 0.4}, at(0.95, guard)}),
                   0.62, 0.5),
            // A hook to the body; the other folds over it.
            fight(2.8, 0.84)
                .touch_at(0.5)
                .right({{0.3, reach, 0.4, -0.35, 0.05},
                        {0.5, partner_belly, 0.06, 0.02, 0.0},
                        {0.58, partner_belly, 0.06, 0.02, 0.0},
                        {0.8, reach, -0.08, -0.08, 0.42}})
                .move(twist, {{0.12, 0}, {0.32, -34}, {0.5, 30}, {0.6, 28}, {0.85, 0}})
                .move(py, {{0.2, 0}, {0.5, -0.1}, {0.85, 0}})
                .move(pz, {{0.3, 0}, {0.5, 0.14}, {0.85, 0}})
                .other()
                .move(bend, {{0.48, 0}, {0.62, 44}, {0.85, 30}, {1, 22}})
                .move(wz, {{0.52, 0}, {0.85, -0.35}})
                .both({at(0.48, guard), {0.64, belly, 0.05, 0, 0.02}, {1, belly, 0.05, 0, 0.02}}),
            // A swing that misses: the other ducks under it and strikes back.
            fight(3.2, 0.92)
                .touch_at(0.68)
                .right({{0.22, reach, 0.6, 0.1, 0.0},
                        {0.4, reach, -0.3, 0.1, 0.88},
                        {0.5, reach, -0.6, 0, 0.4},
                        at(0.66, guard)})
                .move(twist, {{0.1, 0}, {0.22, -34}, {0.42, 38}, {0.7, 0}})
                .move(nod, {{0.67, 0}, {0.73, -26}, {0.9, 0}})
                .move(wz, {{0.68, 0}, {0.98, -0.45}})
                .other()
                .move(py, {{0.24, 0}, {0.38, -0.3}, {0.5, -0.26}, {0.64, 0}})
                .move(bend, {{0.24, 0}, {0.38, 34}, {0.5, 28}, {0.64, 0}})
                .right({at(0.5, guard),
                        {0.68, partner_head, 0, -0.03, -0.09},
                        {0.76, reach, -0.1, 0, 0.7},
                        at(0.92, guard)})
                .move(twist, {{0.5, 0}, {0.56, -22}, {0.68, 26}, {0.9, 0}})
                .move(pz, {{0.54, 0}, {0.68, 0.13}, {0.9, 0}}),
            // A blow that is caught with both arms.
            fight(2.6, 0.9)
                .touch_at(0.46)
                .right({{0.26, reach, 0.3, 0.55, 0.0},
                        {0.46, partner_head, 0, 0.1, -0.2},
                        {0.6, reach, 0.1, 0.2, 0.5},
                        at(0.85, guard)})
                .move(twist, {{0.1, 0}, {0.26, -20}, {0.46, 20}, {0.85, 0}})
                .move(pz, {{0.26, 0}, {0.46, 0.12}, {0.85, 0}})
                .other()
                .both({at(0.3, guard),
                       {0.44, brow, 0.05, 0.08, 0.14},
                       {0.6, brow, 0.05, 0.08, 0.14},
                       at(0.85, guard)})
                .move(bend, {{0.4, 0}, {0.5, -10}, {0.75, 0}})
                .move(wz, {{0.48, 0}, {0.85, -0.22}})};
}

std::vector<Programme> with_feet() {
    return {
        // A front kick to the belly; the other staggers back.
        fight(2.8, 1.16)
            .touch_at(0.46)
            .move(rfz, {{0.16, 0}, {0.3, 0.24}, {0.46, 0.98}, {0.56, 0.9}, {0.72, 0.2}, {0.88, 0}})
            .move(rfy, {{0.16, 0}, {0.3, 0.42}, {0.46, 0.8}, {0.56, 0.72}, {0.72, 0.36}, {0.88, 0}})
            .move(rfp, {{0.16, 0}, {0.3, 20}, {0.46, -10}, {0.88, 0}})
            .move(px, {{0.1, 0}, {0.28, 0.07}, {0.7, 0.07}, {0.9, 0}})
            .move(pz, {{0.2, 0}, {0.46, 0.12}, {0.8, 0}})
            .move(pitch, {{0.25, 0}, {0.46, -16}, {0.6, -14}, {0.85, 0}})
            .other()
            .move(bend, {{0.45, 0}, {0.58, 38}, {0.85, 16}, {1, 10}})
            .move(wz, {{0.46, 0}, {0.9, -0.75}})
            .both(
                {at(0.44, guard), {0.58, belly, 0.06, 0, 0.03}, {0.8, reach, 0.4, -0.5, 0.3}, at(1, guard)}),
        // A low kick at the thigh.
        fight(2.6, 0.98)
            .touch_at(0.46)
            .move(rfz, {{0.16, 0}, {0.3, -0.1}, {0.46, 0.72}, {0.54, 0.7}, {0.75, 0.1}, {0.9, 0}})
            .move(rfy, {{0.16, 0}, {0.3, 0.24}, {0.46, 0.5}, {0.54, 0.48}, {0.75, 0.2}, {0.9, 0}})
            .move(rfx, {{0.16, 0}, {0.34, 0.24}, {0.46, -0.06}, {0.6, -0.1}, {0.9, 0}})
            .move(px, {{0.1, 0}, {0.28, 0.07}, {0.7, 0.07}, {0.9, 0}})
            .move(yaw, {{0.16, 0}, {0.3, -16}, {0.46, 24}, {0.9, 0}})
            .other()
            .move(side, {{0.45, 0}, {0.56, -18}, {0.8, 0}})
            .move(py, {{0.45, 0}, {0.56, -0.14}, {0.8, 0}})
            .move(wx, {{0.48, 0}, {0.85, 0.25}})};
}

/// What knocks somebody down; who falls lies there to the end.
std::vector<Programme> to_the_floor() {
    return {fight(3.4, 0.76)  // a push with both hands
                .touch_at(0.34)
                .both({{0.2, reach, -0.05, -0.2, 0.25},
                       {0.34, partner_chest, 0.1, 0, -0.04},
                       {0.44, reach, -0.1, -0.1, 0.96},
                       at(0.7, guard)})
                .move(bend, {{0.2, 0}, {0.42, 14}, {0.7, 0}})
                .move(pz, {{0.2, 0}, {0.42, 0.14}, {0.8, 0}})
                .other()
                .move(wz, {{0.34, 0}, {0.52, -0.3}})
                .fall(0.4, 0.86),
            fight(3.4, 0.9)  // an uppercut
                .touch_at(0.36)
                .right({{0.2, reach, 0.05, -0.6, 0.25},
                        {0.36, partner_head, 0, -0.08, -0.07},
                        {0.46, reach, 0.05, 0.6, 0.5},
                        at(0.74, guard)})
                .move(py, {{0.08, 0}, {0.22, -0.14}, {0.38, 0.02}, {0.7, 0}})
                .move(twist, {{0.1, 0}, {0.22, -24}, {0.38, 24}, {0.7, 0}})
                .move(pz, {{0.22, 0}, {0.36, 0.12}, {0.7, 0}})
                .other()
                .move(nod, {{0.35, 0}, {0.4, -30}})
                .move(wz, {{0.36, 0}, {0.52, -0.25}})
                .fall(0.42, 0.86),
            fight(3.6, 1.16)  // a front kick
                .touch_at(0.36)
                .move(rfz, {{0.1, 0}, {0.22, 0.24}, {0.36, 0.98}, {0.44, 0.9}, {0.58, 0.2}, {0.7, 0}})
                .move(rfy, {{0.1, 0}, {0.22, 0.42}, {0.36, 0.82}, {0.44, 0.74}, {0.58, 0.36}, {0.7, 0}})
                .move(rfp, {{0.1, 0}, {0.22, 20}, {0.36, -10}, {0.7, 0}})
                .move(px, {{0.06, 0}, {0.2, 0.07}, {0.55, 0.07}, {0.72, 0}})
                .move(pz, {{0.14, 0}, {0.36, 0.12}, {0.7, 0}})
                .move(pitch, {{0.18, 0}, {0.36, -16}, {0.46, -14}, {0.7, 0}})
                .other()
                .move(wz, {{0.36, 0}, {0.54, -0.4}})
                .fall(0.42, 0.84)};
}

}  // namespace

const std::vector<Programme>& fights() {
    static const auto all = [] {
        std::vector<Programme> out;
        for (const auto& table : {with_fists(), with_feet(), to_the_floor()})
            out.insert(out.end(), table.begin(), table.end());
        return out;
    }();
    return all;
}

const std::vector<Programme>& onlookers() {
    static const auto all = [] {
        Programme still(0, 3.4), circling(0, 3.4), stepping_in(0, 3.4);
        ready(still).wave(px, 0.05, 0.7, 0.05, 0.97).wave(yaw, 8, 0.4, 0, 1);
        ready(circling).move(wx, {{0.05, 0}, {0.95, 0.8}}).move(wyaw, {{0.05, 0}, {0.95, 24}});
        ready(stepping_in)
            .move(wz, {{0.2, 0}, {0.45, 0.4}, {0.6, 0.4}, {0.9, 0.05}})
            .right({at(0.4, guard), {0.5, reach, -0.2, 0.05, 0.95}, at(0.62, guard)});
        return std::vector<Programme>{still, circling, stepping_in};
    }();
    return all;
}

}  // namespace actformer::ingest::synth
