// Getting about on foot, and otherwise.
#include "ingest/synth/programmes/everyday.hpp"

namespace actformer::ingest::synth {
namespace {

using enum At;

/// Forward (or, with a negative `metres`, backward), from nearly standing to nearly standing.
Programme walking(double seconds, double metres) {
    return Programme(0, seconds).move(wz, {{-0.08, 0}, {1.08, metres}});
}

/// At `speed` metres a second all along, but for a slower start and end: the clip is cut out of a longer run.
Programme running(double seconds, double speed) {
    const double metres = 1.18 * speed * seconds;
    const double strides = speed / 0.96;  // a second: as footsteps have them, two steps of 0.48 m
    return Programme(0, seconds)
        .move(wz, {{-0.4, 0}, {1.4, metres}})
        .steps_a_second(3.6)
        .both({{0.06, reach, 0.02, -0.5, 0.3}, {0.94, reach, 0.02, -0.5, 0.3}, {1, rest}})
        .wave(lz, 0.22, strides, 0.06, 0.96, 0.5)
        .wave(rz, 0.22, strides, 0.06, 0.96)
        .wave(py, 0.025, 2 * strides, 0.06, 0.96)
        .move(bend, {{0.08, 9}, {0.9, 9}, {1, 0}})
        .wave(twist, 6, strides, 0.06, 0.96)
        .fists(0.8, 0.8);
}

std::vector<NamedProgramme> on_foot() {
    return {
        {"walk", walking(3.2, 3.3)},
        {"step", Programme(0, 1.8).move(wz, {{0.15, 0}, {0.8, 0.55}})},
        {"forward movement", walking(2.6, 2.1).move(nod, {{0, 10}})},
        {"backwards movement", walking(2.8, -1.7).move(turn, {{0.1, 0}, {0.35, 30}, {0.8, 30}, {1, 0}})},
        {"move back", walking(2.2, -1.0)},
        {"sideways movement", Programme(0, 2.8).move(wx, {{0.04, 0}, {0.96, 1.3}})},
        {"shuffle", Programme(0, 2.6)
                        .move(wx, {{0.05, 0}, {0.28, 0.25}, {0.5, 0.5}, {0.75, 0.25}, {0.96, 0}})
                        .hold(py, -0.06)
                        .move(bend, {{0, 8}})},
        {"slide", Programme(0, 2.6)
                      .move(wx, {{0.05, 0}, {0.48, 1.0}, {0.56, 1.0}, {0.96, 0.05}})
                      .hold(py, -0.14)
                      .move(bend, {{0, 14}})
                      .both({{0.1, reach, 0.4, -0.35, 0.5}, {0.92, reach, 0.4, -0.35, 0.5}, {1, rest}})},
        {"turn", Programme(0, 2.2)
                     .move(wyaw, {{0.08, 0}, {0.85, 150}})
                     .move(turn, {{0, 0}, {0.2, 24}, {0.7, 8}, {1, 0}})},
        {"spin", Programme(0, 2.4)
                     .move(wyaw, {{0.05, 0}, {0.92, 360}})
                     .both({{0.2, reach, 0.55, -0.45, 0.2}, {0.85, reach, 0.55, -0.45, 0.2}, {1, rest}})},
        {"circular movement", Programme(0, 4.4)
                                  .move(wyaw, {{0.0, 0}, {0.5, 130}, {1, 260}})
                                  .move(wx, {{0.0, 0}, {0.25, 0.28}, {0.5, 1.0}, {0.75, 1.5}, {1, 1.35}})
                                  .move(wz, {{0.0, 0}, {0.25, 0.75}, {0.5, 0.95}, {0.75, 0.4}, {1, -0.3}})},
        {"incline", walking(3.4, 2.3).move(bend, {{0, 13}}).wave(py, 0.03, 2.0, 0.0, 1).move(nod, {{0, 12}})},
        {"run", running(2.8, 1.7)},
        {"jog", running(3.2, 1.25).move(bend, {{0, 4}})},
        {"sneak", walking(3.6, 1.9)
                      .hold(py, -0.15)
                      .move(bend, {{0, 26}})
                      .move(nod, {{0, -16}})
                      .both({{0.08, reach, 0.05, -0.4, 0.5}, {0.94, reach, 0.05, -0.4, 0.5}, {1, rest}})
                      .wave(turn, 24, 0.5, 0.1, 0.9)},
        {"limp", walking(3.4, 1.9)
                     .wave(roll, 6, 0.9, 0.02, 1)
                     .wave(side, -9, 0.9, 0.02, 1)
                     .beat(py, -0.07, 0.9, 0.02, 1)
                     .right({{0.1, thigh, 0.02, 0.05, 0.02}, {0.95, thigh, 0.02, 0.05, 0.02}})
                     .move(nod, {{0, 16}})},
        {"stop",
         Programme(0, 2.6)
             .move(wz, {{-0.3, -0.5}, {0.5, 1.1}})
             .move(bend, {{0.4, 0}, {0.52, -8}, {0.7, 0}})
             .right({{0.45, rest}, {0.62, reach, 0.05, 0.1, 0.9}, {0.9, reach, 0.05, 0.1, 0.9}, {1, rest}})},
        {"wait", Programme(0, 3.4)
                     .wave(px, 0.05, 0.35, 0.0, 1)
                     .wave(turn, 26, 0.3, 0.05, 0.95)
                     .both({{0.2, waist, 0.02, 0, 0}, {0.85, waist, 0.02, 0, 0}, {1, rest}})}};
}

std::vector<NamedProgramme> in_the_air() {
    return {
        {"jump", Programme(0, 2.2)
                     .move(py, {{0.1, 0}, {0.36, -0.26}, {0.46, 0.04}, {0.6, 0.03}, {0.70, -0.2}, {0.95, 0}})
                     .move(lift, {{0.43, 0}, {0.54, 0.34}, {0.65, 0}})
                     .move(bend, {{0.1, 0}, {0.36, 36}, {0.48, -4}, {0.62, 4}, {0.72, 24}, {0.95, 0}})
                     .both({{0.12, rest},
                            {0.36, reach, 0.12, -0.75, -0.5},
                            {0.5, reach, 0.12, 0.9, 0.25},
                            {0.76, reach, 0.2, -0.7, 0.4},
                            {1, rest}})
                     .move(lfp, {{0.4, 0}, {0.5, 45}, {0.62, 20}, {0.66, 0}})
                     .move(rfp, {{0.4, 0}, {0.5, 45}, {0.62, 20}, {0.66, 0}})},
        {"leap",
         Programme(0, 2.0)
             .move(wz, {{0.0, 0}, {0.95, 1.5}})
             .move(lift, {{0.44, 0}, {0.56, 0.26}, {0.68, 0}})
             .move(py, {{0.2, 0}, {0.4, -0.12}, {0.52, 0.02}, {0.74, -0.16}, {1, 0}})
             .move(bend, {{0.2, 0}, {0.42, 18}, {0.7, 22}, {1, 0}})
             .both({{0.2, rest}, {0.5, reach, 0.6, 0.15, 0.35}, {0.75, reach, 0.4, -0.5, 0.3}, {1, rest}})},
        {"skip", Programme(0, 2.8)
                     .move(wz, {{0.02, 0}, {0.98, 2.5}})
                     .beat(lift, 0.1, 1.7, 0.05, 0.95)
                     .wave(lz, 0.3, 0.85, 0.05, 0.95)
                     .wave(rz, 0.3, 0.85, 0.05, 0.95, 0.5)},
        {"jump rope", Programme(0, 3.0)
                          .beat(lift, 0.09, 2.1, 0.08, 0.94)
                          .beat(py, -0.06, 2.1, 0.08, 0.94, 0.5)
                          .both({{0.06, reach, 0.35, -0.6, 0.25}, {0.94, reach, 0.35, -0.6, 0.25}, {1, rest}})
                          .wave(ly, 0.06, 2.1, 0.08, 0.94)
                          .wave(ry, 0.06, 2.1, 0.08, 0.94)
                          .wave(lz, 0.06, 2.1, 0.08, 0.94, 0.25)
                          .wave(rz, 0.06, 2.1, 0.08, 0.94, 0.25)
                          .fists(0.9, 0.9)},
        {"jumping jacks", Programme(0, 3.0)
                              .both({{0.05, reach, 0.3, -0.9, 0.02}})
                              .both(cycles(3, 0.08, 0.92,
                                           {{0.08, reach, 0.3, -0.9, 0.02},
                                            {0.3, reach, 0.98, 0, 0.02},
                                            {0.5, reach, 0.3, 0.9, 0.02},
                                            {0.75, reach, 0.98, 0, 0.02},
                                            {0.98, reach, 0.3, -0.9, 0.02}}))
                              .beat(lfx, 0.3, 0.6, 0.08, 0.36)
                              .beat(rfx, 0.3, 0.6, 0.08, 0.36)
                              .beat(lfx, 0.3, 0.6, 0.36, 0.64)
                              .beat(rfx, 0.3, 0.6, 0.36, 0.64)
                              .beat(lfx, 0.3, 0.6, 0.64, 0.92)
                              .beat(rfx, 0.3, 0.6, 0.64, 0.92)
                              .beat(lift, 0.07, 2.1, 0.08, 0.92)}};
}

}  // namespace

std::vector<NamedProgramme> locomotion() {
    auto all = on_foot();
    for (auto& one : in_the_air()) all.push_back(std::move(one));
    return all;
}

}  // namespace actformer::ingest::synth
