#include "ingest/synth/programmes/exercises.hpp"

namespace actformer::ingest::synth {
namespace {

using enum At;

constexpr double from = 0.08, to = 0.94;  // of the exercise: before and after it people stand

Programme exercise() {
    return Programme(0, 3.2);
}

/// Both hands where `key` says, all the while.
Programme& with_hands(Programme& p, HandKey key) {
    auto still = key;
    key.t = from;
    still.t = to - 0.04;
    return p.both({key, still, {1, rest}});
}

Programme hands(const HandKey& key) {
    auto p = exercise();
    return with_hands(p, key);
}

Programme on_hips() {
    return hands({0, waist, 0.02, 0, 0});
}

/// Knees up by turns, `hertz` times a second each.
Programme& marching(Programme& p, double height, double hertz) {
    return p.beat(lfy, height, hertz, from, to)
        .beat(rfy, height, hertz, from, to, 0.5)
        .beat(lfz, 0.45 * height, hertz, from, to)
        .beat(rfz, 0.45 * height, hertz, from, to, 0.5)
        .wave(px, -0.04, hertz, from, to);
}

/// Both hands from one place to another and back, `n` times.
Programme repeated(int n, const HandKey& a, const HandKey& b) {
    auto begin = a, there = b, back = a;
    begin.t = from;
    there.t = 0.5;
    back.t = 0.98;
    return exercise().both({begin}).both(cycles(n, from, to, {there, back})).both({{1, rest}});
}

Programme kneeling_step(Channel x, Channel z, Channel y, double sideways, double ahead) {
    return on_hips()
        .move(x, {{0.08, 0}, {0.3, sideways}, {0.6, sideways}, {0.9, 0}})
        .move(z, {{0.08, 0}, {0.3, ahead}, {0.6, ahead}, {0.9, 0}})
        .move(y, {{0.08, 0}, {0.19, 0.1}, {0.3, 0}, {0.6, 0}, {0.75, 0.1}, {0.9, 0}})
        .move(py, {{0.12, 0}, {0.4, -0.26}, {0.56, -0.26}, {0.9, 0}});
}

std::vector<NamedProgramme> first_ten() {
    auto punching = repeated(3, {0, reach, -0.05, -0.15, 0.35}, {0, reach, -0.12, 0.05, 0.95});
    auto marking = hands({0, reach, 0.05, -0.5, 0.35});
    auto raising = hands({0, reach, 0.2, 0.9, 0.1});
    return {{"punching-and-knee-lifting", marching(punching, 0.4, 0.95)},
            {"marking-time-and-knee-lifting",
             marching(marking, 0.34, 1.1).wave(lz, 0.25, 1.1, from, to, 0.5).wave(rz, 0.25, 1.1, from, to)},
            {"jumping-jack", everyday_programme("jumping jacks")},
            {"squatting", everyday_programme("squat")},
            {"forward-lunging", everyday_programme("lunge")},
            {"left-lunging",
             kneeling_step(lfx, lfz, lfy, 0.5, 0).move(px, {{0.12, 0}, {0.4, 0.2}, {0.56, 0.2}, {0.9, 0}})},
            {"left-stretching",
             exercise()
                 .right({{0.2, reach, -0.35, 0.92, 0.05}, {0.8, reach, -0.35, 0.92, 0.05}, {1, rest}})
                 .left({{0.2, waist, 0.02, 0, 0}, {0.8, waist, 0.02, 0, 0}, {1, rest}})
                 .beat(side, -26, 0.8, 0.16, 0.86)
                 .hold(lfx, 0.08)
                 .hold(rfx, 0.08)},
            {"raising-hand-and-jumping",
             raising.beat(lift, 0.12, 1.3, from, to).beat(py, -0.1, 1.3, from, to, 0.5)},
            {"left-kicking", on_hips()
                                 .move(px, {{0.05, 0}, {0.15, -0.08}, {0.9, -0.08}, {1, 0}})
                                 .beat(lfy, 0.5, 0.8, 0.14, 0.9)
                                 .beat(lfz, 0.62, 0.8, 0.14, 0.9)},
            {"rotation-clapping", hands({0, reach, -0.16, -0.1, 0.75})
                                      .wave(twist, 44, 0.65, from, to)
                                      .beat(lx, 0.16, 1.3, from, to)
                                      .beat(rx, 0.16, 1.3, from, to)
                                      .hold(lfx, 0.06)
                                      .hold(rfx, 0.06)}};
}

std::vector<NamedProgramme> second_ten() {
    return {
        {"front-raising", repeated(3, {0, reach, 0.02, -0.95, 0.12}, {0, reach, -0.02, 0.02, 0.97})},
        {"pulling-chest-expanders",
         repeated(3, {0, reach, -0.12, -0.02, 0.85}, {0, reach, 0.88, -0.02, 0.2})},
        {"punching", everyday_programme("boxing")},
        {"wrist-circling", hands({0, reach, -0.1, -0.2, 0.55})
                               .wave(lflex, 40, 1.5, from, to)
                               .wave(rflex, 40, 1.5, from, to)
                               .wave(lroll, 50, 1.5, from, to, 0.25)
                               .wave(rroll, 50, 1.5, from, to, 0.25)},
        {"single-dumbbell-raising",
         exercise()
             .right({{from, reach, 0.12, -0.9, 0.1}})
             .right(cycles(3, from, to, {{0.5, reach, 0.1, 0.92, 0.05}, {0.98, reach, 0.12, -0.9, 0.1}}))
             .right({{1, rest}})
             .fists(0, 1)},
        {"shoulder-raising", exercise()
                                 .beat(ly, 0.1, 1.0, from, to)
                                 .beat(ry, 0.1, 1.0, from, to)
                                 .beat(lx, 0.05, 1.0, from, to)
                                 .beat(rx, 0.05, 1.0, from, to)
                                 .beat(nod, 10, 1.0, from, to)},
        {"elbow-circling", hands({0, throat, 0.17, 0.02, -0.02})
                               .wave(lelbow, 40, 0.9, from, to)
                               .wave(relbow, 40, 0.9, from, to)
                               .wave(lz, 0.04, 0.9, from, to, 0.25)
                               .wave(rz, 0.04, 0.9, from, to, 0.25)},
        {"dumbbell-one-arm-shoulder-pressing",
         exercise()
             .right({{from, throat, 0.2, 0.04, 0.02}})
             .right(cycles(3, from, to, {{0.5, reach, 0.12, 0.95, 0.02}, {0.98, throat, 0.2, 0.04, 0.02}}))
             .right({{1, rest}})
             .left({{0.1, waist, 0.02, 0, 0}, {0.9, waist, 0.02, 0, 0}, {1, rest}})
             .fists(0, 1)},
        {"arm-circling", hands({0, reach, 0.95, 0.02, 0})
                             .wave(ly, 0.24, 0.9, from, to)
                             .wave(ry, 0.24, 0.9, from, to)
                             .wave(lz, 0.24, 0.9, from, to, 0.25)
                             .wave(rz, 0.24, 0.9, from, to, 0.25)},
        {"dumbbell-shrugging", hands({0, reach, 0.2, -0.92, 0.05})
                                   .beat(ly, 0.12, 0.8, from, to)
                                   .beat(ry, 0.12, 0.8, from, to)
                                   .fists(1, 1)}};
}

std::vector<NamedProgramme> third_ten() {
    return {
        {"pinching-back", hands({0, reach, 0.75, -0.1, -0.1})
                              .beat(lz, -0.2, 1.0, from, to)
                              .beat(rz, -0.2, 1.0, from, to)
                              .beat(bend, -8, 1.0, from, to)},
        {"head-anticlockwise-circling",
         on_hips().wave(tilt, -26, 0.6, from, to).wave(nod, 22, 0.6, from, to, 0.25)},
        {"shoulder-abduction", repeated(3, {0, reach, 0.2, -0.92, 0.02}, {0, reach, 0.97, 0.04, 0})},
        {"deltoid-muscle-stretching",
         exercise()
             .right({{0.2, reach, -0.7, -0.1, 0.5}, {0.85, reach, -0.7, -0.1, 0.5}, {1, rest}})
             .left({{0.22, elbow, 0.02, 0.02, 0.05}, {0.84, elbow, 0.02, 0.02, 0.05}, {1, rest}})
             .move(turn, {{0.15, 0}, {0.35, 22}, {0.8, 22}, {1, 0}})},
        {"straight-forward-flexion", repeated(2, {0, reach, 0.1, 0.92, 0.1}, {0, floor, 0.02, 0.12, 0.02})
                                         .beat(bend, 84, 0.62, from, to)},
        {"spinal-stretching", hands({0, reach, 0.05, 0.2, 0.9})
                                  .move(bend, {{0.1, 0}, {0.4, 66}, {0.75, 66}, {0.97, 0}})
                                  .move(nod, {{0.1, 0}, {0.4, -20}, {0.75, -20}, {0.97, 0}})},
        {"dumbbell-side-bend",
         exercise()
             .left({{0.1, ear, 0.02, 0.02, -0.04}, {0.9, ear, 0.02, 0.02, -0.04}, {1, rest}})
             .right({{0.1, reach, 0.2, -0.9, 0.02}, {0.9, reach, 0.2, -0.9, 0.02}, {1, rest}})
             .beat(side, 28, 0.8, from, to)
             .fists(0, 1)},
        {"standing-opposite-elbow-to-knee-crunch", hands({0, ear, 0.02, 0.02, -0.03})
                                                       .beat(lfy, 0.48, 0.75, from, to)
                                                       .beat(rfy, 0.48, 0.75, from, to, 0.5)
                                                       .beat(lfz, 0.22, 0.75, from, to)
                                                       .beat(rfz, 0.22, 0.75, from, to, 0.5)
                                                       .wave(twist, 34, 0.75, from, to)
                                                       .beat(bend, 26, 1.5, from, to)
                                                       .wave(px, -0.05, 0.75, from, to)},
        {"standing-rotation",
         hands({0, reach, -0.2, -0.15, 0.5}).wave(twist, 52, 0.6, from, to).wave(turn, 20, 0.6, from, to)},
        {"overhead-stretching", hands({0, reach, -0.1, 0.95, 0.02})
                                    .wave(side, 18, 0.5, 0.15, 0.9)
                                    .move(lfp, {{0.2, 0}, {0.4, 22}, {0.7, 22}, {0.9, 0}})
                                    .move(rfp, {{0.2, 0}, {0.4, 22}, {0.7, 22}, {0.9, 0}})}};
}

std::vector<NamedProgramme> last_ten() {
    auto lifting = on_hips();
    auto running = hands({0, reach, 0.05, -0.5, 0.35});
    return {
        {"upper-back-stretching", hands({0, reach, -0.16, -0.05, 0.92})
                                      .move(bend, {{0.15, 0}, {0.4, 26}, {0.75, 26}, {0.95, 0}})
                                      .move(nod, {{0.15, 0}, {0.4, 26}, {0.75, 26}, {0.95, 0}})},
        {"knee-to-chest",
         exercise()
             .move(px, {{0.04, 0}, {0.16, 0.085}, {0.88, 0.085}, {1, 0}})
             .move(rfy, {{0.1, 0}, {0.34, 0.56}, {0.74, 0.56}, {0.95, 0}})
             .move(rfz, {{0.1, 0}, {0.34, 0.24}, {0.74, 0.24}, {0.95, 0}})
             .both(
                 {{0.12, rest}, {0.36, knee, -0.02, 0.02, 0.0}, {0.72, knee, -0.02, 0.02, 0.0}, {0.96, rest}})
             .move(bend, {{0.1, 0}, {0.36, 12}, {0.72, 12}, {0.95, 0}})},
        {"knee-circling", hands({0, knee, 0, 0.02, 0})
                              .move(bend, {{0.04, 0}, {0.14, 44}, {0.88, 44}, {1, 0}})
                              .move(py, {{0.04, 0}, {0.14, -0.16}, {0.88, -0.16}, {1, 0}})
                              .wave(px, 0.09, 0.8, 0.14, 0.9)
                              .wave(pz, 0.05, 0.8, 0.14, 0.9, 0.25)},
        {"alternate-knee-lifting", marching(lifting, 0.46, 0.75)},
        {"bent-over-twist", hands({0, reach, 0.95, 0.0, 0.1})
                                .move(bend, {{0.04, 0}, {0.16, 66}, {0.86, 66}, {1, 0}})
                                .wave(twist, 46, 0.7, 0.14, 0.9)
                                .hold(lfx, 0.14)
                                .hold(rfx, 0.14)},
        {"rope-skipping", everyday_programme("jump rope")},
        {"standing-toe-touches", repeated(3, {0, reach, 0.05, -0.6, 0.6}, {0, foot, 0, 0.04, 0.02})
                                     .beat(bend, 88, 0.94, from, to)
                                     .beat(py, -0.04, 0.94, from, to)},
        {"standing-gastrocnemius-calf",
         on_hips().beat(lfp, 30, 0.9, from, to).beat(rfp, 30, 0.9, from, to).beat(lift, 0.05, 0.9, from, to)},
        {"single-leg-lateral-hopping", on_hips()
                                           .move(px, {{0.03, 0}, {0.12, -0.08}, {0.9, -0.08}, {1, 0}})
                                           .move(lfy, {{0.03, 0}, {0.14, 0.26}, {0.88, 0.26}, {1, 0}})
                                           .move(lfz, {{0.03, 0}, {0.14, -0.18}, {0.88, -0.18}, {1, 0}})
                                           .beat(lift, 0.1, 1.5, 0.14, 0.88)
                                           .wave(wx, 0.1, 0.75, 0.14, 0.88)},
        {"high-knees-running", marching(running, 0.44, 1.7)
                                   .wave(lz, 0.26, 1.7, from, to, 0.5)
                                   .wave(rz, 0.26, 1.7, from, to)
                                   .beat(lift, 0.03, 3.4, from, to)
                                   .fists(0.9, 0.9)}};
}

}  // namespace

const std::vector<NamedProgramme>& exercises() {
    static const auto all = [] {
        std::vector<NamedProgramme> out;
        for (const auto& table : {first_ten(), second_ten(), third_ten(), last_ten()})
            out.insert(out.end(), table.begin(), table.end());
        return out;
    }();
    return all;
}

}  // namespace actformer::ingest::synth
