// What people do with trunk, legs and head.
#include "ingest/synth/programmes/everyday.hpp"

namespace actformer::ingest::synth {
namespace {

using enum At;

std::vector<NamedProgramme> of_the_trunk() {
    return {
        {"stand", Programme(0, 3.0).wave(px, 0.03, 0.3, 0, 1).wave(turn, 12, 0.3, 0, 1, 0.3)},
        {"bend", Programme(0, 2.6)
                     .move(bend, {{0.1, 0}, {0.42, 74}, {0.58, 74}, {0.92, 0}})
                     .both({{0.1, rest},
                            {0.42, reach, 0.05, -0.5, 0.85},
                            {0.58, reach, 0.05, -0.5, 0.85},
                            {0.95, rest}})},
        {"touch ground", Programme(0, 3.0)
                             .move(bend, {{0.08, 0}, {0.42, 84}, {0.58, 84}, {0.92, 0}})
                             .move(py, {{0.08, 0}, {0.42, -0.32}, {0.58, -0.32}, {0.92, 0}})
                             .both({{0.1, rest},
                                    {0.42, floor, 0.06, 0.0, 0.08},
                                    {0.58, floor, 0.06, 0.0, 0.08},
                                    {0.95, rest}})},
        {"lean", Programme(0, 2.8)
                     .move(side, {{0.1, 0}, {0.4, 34}, {0.7, 34}, {0.95, 0}})
                     .move(px, {{0.1, 0}, {0.4, -0.06}, {0.7, -0.06}, {0.95, 0}})},
        {"sway", Programme(0, 3.2)
                     .wave(side, 14, 0.7, 0.05, 0.97)
                     .wave(px, 0.06, 0.7, 0.05, 0.97)
                     .wave(tilt, 8, 0.7, 0.05, 0.97, 0.1)},
        {"side to side movement",
         Programme(0, 3.0).wave(px, 0.11, 0.9, 0.05, 0.97).wave(roll, 5, 0.9, 0.05, 0.97)},
        {"twist", Programme(0, 2.8)
                      .wave(twist, 42, 0.8, 0.06, 0.96)
                      .wave(turn, 20, 0.8, 0.06, 0.96)
                      .both({{0.1, reach, 0.1, -0.25, 0.45}, {0.92, reach, 0.1, -0.25, 0.45}, {1, rest}})},
        {"upper body movements", Programme(0, 3.0)
                                     .wave(twist, 22, 0.6, 0.06, 0.96)
                                     .wave(bend, 14, 0.8, 0.06, 0.96)
                                     .wave(side, 12, 0.5, 0.06, 0.96, 0.25)},
        {"waist movements", Programme(0, 3.2)
                                .wave(px, 0.1, 0.7, 0.05, 0.96)
                                .wave(pz, 0.08, 0.7, 0.05, 0.96, 0.25)
                                .wave(side, 10, 0.7, 0.05, 0.96)
                                .both({{0.1, waist, 0.02, 0, 0}, {0.92, waist, 0.02, 0, 0}, {1, rest}})},
        {"dance", Programme(0, 3.6)
                      .wave(px, 0.08, 0.95, 0, 1)
                      .wave(py, 0.035, 1.9, 0, 1)
                      .wave(yaw, 22, 0.48, 0, 1)
                      .wave(side, 10, 0.95, 0, 1, 0.25)
                      .beat(lfy, 0.1, 0.95, 0.03, 0.97)
                      .beat(rfy, 0.1, 0.95, 0.03, 0.97, 0.5)
                      .both({{0.08, reach, 0.45, -0.25, 0.45}, {0.94, reach, 0.45, -0.25, 0.45}, {1, rest}})
                      .wave(ly, 0.2, 0.95, 0.05, 0.97)
                      .wave(ry, 0.2, 0.95, 0.05, 0.97, 0.5)
                      .wave(nod, 8, 1.9, 0, 1)},
        {"sudden movement",
         Programme(0, 2.0)
             .move(bend, {{0.3, 0}, {0.42, -14}, {0.7, 0}})
             .move(wz, {{0.3, 0}, {0.6, -0.3}})
             .both({{0.3, rest}, {0.42, reach, 0.3, -0.2, 0.55}, {0.65, reach, 0.3, -0.2, 0.55}, {1, rest}})},
        {"evade", Programme(0, 2.0)
                      .move(side, {{0.2, 0}, {0.42, 30}, {0.55, 30}, {0.85, 0}})
                      .move(py, {{0.2, 0}, {0.42, -0.22}, {0.55, -0.22}, {0.85, 0}})
                      .move(px, {{0.2, 0}, {0.42, -0.12}, {0.55, -0.12}, {0.85, 0}})
                      .both({{0.2, reach, 0, -0.2, 0.4}, {0.85, reach, 0, -0.2, 0.4}, {1, rest}})},
        {"protect",
         Programme(0, 2.4)
             .both({{0.2, rest}, {0.38, eye, 0.03, 0.02, 0.06}, {0.8, eye, 0.03, 0.0, 0.06}, {1, rest}})
             .move(bend, {{0.2, 0}, {0.4, 24}, {0.8, 20}, {1, 0}})
             .move(py, {{0.2, 0}, {0.4, -0.12}, {0.8, -0.1}, {1, 0}})
             .move(nod, {{0.2, 0}, {0.4, 18}, {0.8, 16}, {1, 0}})},
    };
}

std::vector<NamedProgramme> on_the_legs() {
    return {
        {"squat", Programme(0, 3.2)
                      .beat(py, -0.44, 0.6, 0.06, 0.94)
                      .beat(bend, 28, 0.6, 0.06, 0.94)
                      .both({{0.08, reach, 0, -0.05, 0.9}, {0.92, reach, 0, -0.05, 0.9}, {1, rest}})
                      .hold(lfx, 0.06)
                      .hold(rfx, 0.06)},
        {"crouch",
         Programme(0, 2.8)
             .move(py, {{0.08, 0}, {0.4, -0.44}, {0.7, -0.44}, {0.96, 0}})
             .move(bend, {{0.08, 0}, {0.4, 46}, {0.7, 46}, {0.96, 0}})
             .move(nod, {{0.08, 0}, {0.4, -18}, {0.7, -18}, {0.96, 0}})
             .both({{0.1, rest}, {0.4, knee, 0, 0.02, 0.02}, {0.7, knee, 0, 0.02, 0.02}, {1, rest}})},
        {"kneel", Programme(0, 3.0)
                      .move(rfz, {{0.08, 0}, {0.3, -0.5}, {0.76, -0.5}, {0.96, 0}})
                      .move(rfy, {{0.08, 0}, {0.2, 0.06}, {0.3, 0.0}, {0.76, 0.0}, {0.86, 0.06}, {0.96, 0}})
                      .move(rfp, {{0.1, 0}, {0.3, 62}, {0.76, 62}, {0.92, 0}})
                      .move(lfz, {{0.08, 0}, {0.3, 0.18}, {0.76, 0.18}, {0.96, 0}})
                      .move(py, {{0.15, 0}, {0.42, -0.42}, {0.7, -0.42}, {0.95, 0}})
                      .move(bend, {{0.1, 0}, {0.42, 12}, {0.7, 12}, {0.95, 0}})
                      .left({{0.2, rest}, {0.45, thigh, 0, 0.02, 0}, {0.7, thigh, 0, 0.02, 0}, {1, rest}})},
        {"lunge", Programme(0, 2.8)
                      .move(rfz, {{0.06, 0}, {0.3, 0.6}, {0.62, 0.6}, {0.92, 0}})
                      .move(rfy, {{0.06, 0}, {0.18, 0.1}, {0.3, 0}, {0.62, 0}, {0.78, 0.1}, {0.92, 0}})
                      .move(pz, {{0.06, 0}, {0.32, 0.3}, {0.62, 0.3}, {0.92, 0}})
                      .move(py, {{0.1, 0}, {0.4, -0.3}, {0.6, -0.3}, {0.92, 0}})
                      .move(lfp, {{0.1, 0}, {0.36, 36}, {0.6, 36}, {0.88, 0}})
                      .both({{0.1, waist, 0.02, 0, 0}, {0.9, waist, 0.02, 0, 0}, {1, rest}})},
        {"balance",
         Programme(0, 3.4)
             .move(px, {{0.02, 0}, {0.16, -0.085}, {0.86, -0.085}, {1, 0}})
             .move(lfy, {{0.08, 0}, {0.26, 0.32}, {0.8, 0.32}, {0.96, 0}})
             .move(lfz, {{0.08, 0}, {0.26, 0.12}, {0.8, 0.12}, {0.96, 0}})
             .both(
                 {{0.06, rest}, {0.25, reach, 0.92, 0.05, 0.05}, {0.84, reach, 0.92, 0.05, 0.05}, {1, rest}})
             .wave(ly, 0.1, 0.8, 0.25, 0.85)
             .wave(ry, -0.1, 0.8, 0.25, 0.85)
             .wave(side, 6, 0.8, 0.25, 0.85)},
        {"knee movement", Programme(0, 3.0)
                              .beat(lfy, 0.42, 0.85, 0.06, 0.94)
                              .beat(rfy, 0.42, 0.85, 0.06, 0.94, 0.5)
                              .beat(lfz, 0.2, 0.85, 0.06, 0.94)
                              .beat(rfz, 0.2, 0.85, 0.06, 0.94, 0.5)
                              .wave(px, -0.05, 0.85, 0.04, 0.96)
                              .both({{0.1, waist, 0.02, 0, 0}, {0.92, waist, 0.02, 0, 0}, {1, rest}})},
        {"raise knee", Programme(0, 2.6)
                           .move(px, {{0.05, 0}, {0.2, 0.08}, {0.8, 0.08}, {1, 0}})
                           .move(rfy, {{0.15, 0}, {0.4, 0.5}, {0.65, 0.5}, {0.92, 0}})
                           .move(rfz, {{0.15, 0}, {0.4, 0.26}, {0.65, 0.26}, {0.92, 0}})},
        {"lower knee", Programme(0, 2.6)
                           .move(px, {{0.0, 0}, {0.12, 0.08}, {0.9, 0.08}, {1, 0}})
                           .move(rfy, {{0.06, 0}, {0.24, 0.5}, {0.45, 0.5}, {0.92, 0}})
                           .move(rfz, {{0.06, 0}, {0.24, 0.26}, {0.45, 0.26}, {0.92, 0}})
                           .both({{0.1, reach, 0.4, -0.7, 0.2}, {0.9, reach, 0.4, -0.7, 0.2}, {1, rest}})},
        {"leg movements", Programme(0, 3.0)
                              .move(px, {{0.0, 0}, {0.1, 0.085}, {0.9, 0.085}, {1, 0}})
                              .move(rfy, {{0.06, 0}, {0.16, 0.16}, {0.84, 0.16}, {0.96, 0}})
                              .wave(rfz, 0.34, 0.8, 0.1, 0.92)
                              .both({{0.08, waist, 0.02, 0, 0}, {0.92, waist, 0.02, 0, 0}, {1, rest}})},
        {"foot movements", Programme(0, 3.0)
                               .move(px, {{0.0, 0}, {0.12, 0.07}, {0.9, 0.07}, {1, 0}})
                               .move(rfz, {{0.06, 0}, {0.18, 0.2}, {0.86, 0.2}, {0.98, 0}})
                               .move(rfy, {{0.06, 0}, {0.18, 0.06}, {0.86, 0.06}, {0.98, 0}})
                               .wave(rfp, 26, 1.2, 0.15, 0.9)
                               .wave(rfx, 0.06, 0.9, 0.15, 0.9)},
        {"tap", Programme(0, 2.8)
                    .move(rfz, {{0.0, 0.06}})
                    .beat(rfy, 0.05, 2.2, 0.08, 0.94)
                    .beat(rfp, -20, 2.2, 0.08, 0.94)
                    .both({{0.1, waist, 0.02, 0, 0}, {0.92, waist, 0.02, 0, 0}, {1, rest}})},
        {"stances", Programme(0, 3.0)
                        .hold(lfz, 0.2)
                        .hold(rfz, -0.18)
                        .hold(py, -0.1)
                        .move(bend, {{0, 10}})
                        .both({{0.1, reach, -0.08, -0.1, 0.45}, {0.92, reach, -0.08, -0.1, 0.45}, {1, rest}})
                        .wave(py, 0.02, 1.6, 0, 1)
                        .hold(yaw, -18)
                        .fists(1, 1)},
        {"crawl", Programme(0, 3.2)
                      .hold(py, -0.42)
                      .hold(pitch, 62)
                      .hold(bend, 14)
                      .hold(lfz, -0.5)
                      .hold(rfz, -0.5)
                      .hold(lfp, 58)
                      .hold(rfp, 58)
                      .hold(nod, -26)
                      .both({{0, floor, 0.06, 0.0, 0.05}, {1, floor, 0.06, 0.0, 0.05}})
                      .beat(ly, 0.1, 0.8, 0.02, 0.98)
                      .beat(ry, 0.1, 0.8, 0.02, 0.98, 0.5)
                      .wave(lz, 0.12, 0.8, 0.02, 0.98, 0.25)
                      .wave(rz, 0.12, 0.8, 0.02, 0.98, 0.75)
                      .move(wz, {{0.02, 0}, {0.98, 0.6}})},
        {"cartwheel", Programme(0, 2.6)
                          .both({{0.16, reach, 0.2, 0.95, 0.1},
                                 {0.42, floor, 0.14, 0.0, 0.12},
                                 {0.6, floor, 0.14, 0.0, 0.12},
                                 {0.9, reach, 0.3, 0.9, 0},
                                 {1, rest}})
                          .move(bend, {{0.16, 0}, {0.42, 92}, {0.6, 92}, {0.86, 0}})
                          .move(py, {{0.16, 0}, {0.42, -0.16}, {0.6, -0.16}, {0.86, 0}})
                          .move(rfy, {{0.3, 0}, {0.48, 0.75}, {0.56, 0.75}, {0.78, 0}})
                          .move(rfz, {{0.3, 0}, {0.48, -0.5}, {0.56, -0.5}, {0.78, 0}})
                          .move(wyaw, {{0.62, 0}, {0.95, 120}})},
    };
}

std::vector<NamedProgramme> of_the_head() {
    return {{"look", Programme(0, 2.8)
                         .move(turn, {{0.1, 0}, {0.3, 55}, {0.45, 55}, {0.7, -50}, {0.8, -50}, {1, 0}})
                         .move(twist, {{0.1, 0}, {0.3, 12}, {0.45, 12}, {0.7, -12}, {0.8, -12}, {1, 0}})},
            {"head movements",
             Programme(0, 3.0).wave(tilt, 24, 0.7, 0.06, 0.95).wave(nod, 20, 0.7, 0.06, 0.95, 0.25)}};
}

}  // namespace

std::vector<NamedProgramme> postures() {
    std::vector<NamedProgramme> all;
    for (const auto& table : {of_the_trunk(), on_the_legs(), of_the_head()})
        all.insert(all.end(), table.begin(), table.end());
    return all;
}

}  // namespace actformer::ingest::synth
