// What people do with arms and hands.
#include "ingest/synth/programmes/everyday.hpp"

namespace actformer::ingest::synth {
namespace {

using enum At;

/// Both hands at one place and back.
Programme held(double seconds, const HandKey& key) {
    auto there = key, still = key;
    there.t = 0.22;
    still.t = 0.82;
    return Programme(0, seconds).both({{0.04, rest}, there, still, {1, rest}});
}

/// The right hand at one place and back.
Programme right_held(double seconds, const HandKey& key) {
    auto there = key, still = key;
    there.t = 0.24;
    still.t = 0.8;
    return Programme(0, seconds).right({{0.04, rest}, there, still, {1, rest}});
}

std::vector<NamedProgramme> held_poses() {
    return {
        {"t pose", held(2.8, {0, reach, 0.98, 0.02, 0})},
        {"a pose", held(2.8, {0, reach, 0.62, -0.72, 0.02})},
        {"poses", held(2.8, {0, waist, 0.03, 0, 0})
                      .move(px, {{0.1, 0}, {0.3, 0.07}, {0.8, 0.07}, {1, 0}})
                      .move(turn, {{0.1, 0}, {0.35, 30}, {0.8, 30}, {1, 0}})},
        {"spread", held(2.8, {0, reach, 0.9, 0.2, 0.1}).hold(lfx, 0.1).hold(rfx, 0.1)},
        {"raise arms",
         Programme(0, 2.6).both(
             {{0.12, rest}, {0.5, reach, 0.15, 0.95, 0.05}, {0.7, reach, 0.15, 0.95, 0.05}, {1, rest}})},
        {"lower arms",
         Programme(0, 2.6).both(
             {{0.02, rest}, {0.2, reach, 0.4, 0.8, 0.15}, {0.4, reach, 0.4, 0.8, 0.15}, {0.9, rest}})},
        {"arm movements",
         Programme(0, 3.0)
             .left(cycles(
                 2, 0.05, 0.9,
                 {{0.3, reach, 0.3, 0.3, 0.7}, {0.7, reach, 0.7, -0.4, 0.2}, {0.98, reach, 0.2, -0.7, 0.4}}))
             .right(cycles(
                 2, 0.05, 0.9,
                 {{0.3, reach, 0.7, -0.4, 0.2}, {0.7, reach, 0.3, 0.3, 0.7}, {0.98, reach, 0.2, -0.7, 0.4}}))
             .both({{1, rest}})},
        {"shoulder movements",
         Programme(0, 3.0)
             .both({{0.1, At::throat, 0.17, 0.02, -0.04}, {0.9, At::throat, 0.17, 0.02, -0.04}, {1, rest}})
             .wave(lelbow, 26, 0.9, 0.12, 0.9)
             .wave(relbow, 26, 0.9, 0.12, 0.9)},
        {"shrug", held(2.4, {0, reach, 0.4, -0.42, 0.4})
                      .move(tilt, {{0.2, 0}, {0.4, 9}, {0.75, 9}, {1, 0}})
                      .move(lroll, {{0.2, 0}, {0.4, 80}, {0.8, 80}, {1, 0}})
                      .move(rroll, {{0.2, 0}, {0.4, 80}, {0.8, 80}, {1, 0}})}};
}

std::vector<NamedProgramme> at_things() {
    return {
        {"touch object", right_held(2.6, {0, reach, -0.05, -0.15, 0.92})},
        {"use object", held(3.2, {0, reach, -0.15, -0.35, 0.55})
                           .wave(rx, 0.06, 1.4, 0.2, 0.84)
                           .wave(ry, 0.05, 1.1, 0.2, 0.84)
                           .move(nod, {{0.15, 20}, {0.85, 20}, {1, 0}})},
        {"touching body part", right_held(2.8, {0, shoulder, 0, 0.02, 0.02})},
        {"move something", held(3.0, {0, reach, -0.05, -0.3, 0.6})
                               .move(wz, {{0.25, 0}, {0.85, 0.8}})
                               .move(bend, {{0.15, 0}, {0.3, 18}, {0.8, 18}, {1, 0}})
                               .hold(py, -0.04)},
        {"catch", Programme(0, 2.2)
                      .both({{0.15, rest},
                             {0.4, reach, 0.05, 0.1, 0.8},
                             {0.52, reach, -0.12, -0.1, 0.55},
                             {0.75, chest, 0.06, -0.06, 0.08},
                             {1, reach, -0.1, -0.45, 0.5}})
                      .move(bend, {{0.2, 0}, {0.4, 8}, {0.6, 0}})
                      .move(py, {{0.2, 0}, {0.5, -0.08}, {0.8, 0}})},
        {"clean something", right_held(3.2, {0, reach, -0.05, -0.35, 0.72})
                                .wave(rx, 0.2, 1.0, 0.22, 0.82)
                                .wave(rz, 0.1, 1.0, 0.22, 0.82, 0.25)
                                .move(bend, {{0.1, 0}, {0.25, 22}, {0.8, 22}, {1, 0}})
                                .move(nod, {{0.1, 12}, {0.9, 12}, {1, 0}})},
        {"grab person", held(2.6, {0, reach, 0.0, 0.0, 0.82})
                            .wave(lz, 0.12, 1.6, 0.25, 0.8)
                            .wave(rz, 0.12, 1.6, 0.25, 0.8)
                            .move(bend, {{0.1, 0}, {0.25, 8}, {0.8, 8}, {1, 0}})
                            .fists(0.9, 0.9)},
        {"play instrument",
         Programme(0, 3.4)
             .left({{0.1, reach, 0.35, -0.2, 0.55}, {0.92, reach, 0.35, -0.2, 0.55}, {1, rest}})
             .right({{0.1, belly, 0.04, 0.05, 0.06}, {0.92, belly, 0.04, 0.05, 0.06}, {1, rest}})
             .wave(ry, 0.08, 2.4, 0.12, 0.92)
             .wave(lx, 0.06, 0.6, 0.12, 0.92)
             .wave(py, 0.015, 1.2, 0.1, 0.95)
             .move(nod, {{0.1, 14}, {0.9, 14}, {1, 0}})},
        {"stir", right_held(3.2, {0, reach, -0.1, -0.45, 0.55})
                     .wave(rx, 0.09, 1.3, 0.22, 0.82)
                     .wave(rz, 0.09, 1.3, 0.22, 0.82, 0.25)
                     .left({{0.15, reach, -0.1, -0.5, 0.55}, {0.85, reach, -0.1, -0.5, 0.55}, {1, rest}})
                     .move(nod, {{0.1, 22}, {0.9, 22}, {1, 0}})},
        {"press something", right_held(2.6, {0, reach, -0.1, -0.05, 0.7})
                                .beat(rz, 0.16, 0.9, 0.26, 0.8)
                                .move(rgrip, {{0.1, 0.6}, {0.9, 0.6}, {1, 0}})},
        {"knock",
         right_held(2.6, {0, reach, -0.05, 0.15, 0.65}).beat(rz, 0.14, 2.6, 0.28, 0.78).fists(0.1, 1)},
        {"support", right_held(3.0, {0, reach, 0.75, 0.2, 0.4})
                        .move(side, {{0.15, 0}, {0.3, 14}, {0.8, 14}, {1, 0}})
                        .move(px, {{0.15, 0}, {0.3, -0.07}, {0.8, -0.07}, {1, 0}})
                        .left({{0.2, waist, 0.02, 0, 0}, {0.85, waist, 0.02, 0, 0}, {1, rest}})},
        {"golf", Programme(0, 2.8)
                     .both({{0.12, reach, -0.25, -0.8, 0.45}})
                     .right({{0.4, reach, 0.45, 0.3, 0.2},
                             {0.55, reach, -0.25, -0.82, 0.42},
                             {0.7, reach, -0.75, 0.35, 0.3},
                             {1, rest}})
                     .left({{0.4, reach, -0.75, 0.3, 0.3},
                            {0.55, reach, -0.25, -0.82, 0.42},
                            {0.7, reach, 0.45, 0.35, 0.2},
                            {1, rest}})
                     .move(bend, {{0.08, 0}, {0.15, 26}, {0.58, 26}, {0.8, 4}, {1, 0}})
                     .move(twist, {{0.12, 0}, {0.4, -40}, {0.55, 0}, {0.7, 44}, {1, 0}})
                     .move(nod, {{0.1, 14}, {0.6, 14}, {0.75, 0}})
                     .fists(0.9, 0.9)},
        {"lift_dumbbell", Programme(0, 3.4)
                              .both({{0.08, reach, 0.05, -0.9, 0.15}})
                              .both(cycles(3, 0.1, 0.92,
                                           {{0.45, reach, 0.0, -0.28, 0.3},
                                            {0.6, reach, 0.0, -0.26, 0.28},
                                            {0.98, reach, 0.05, -0.9, 0.15}}))
                              .fists(1, 1)},
        {"turn steering wheel", Programme(0, 3.4)
                                    .seated()
                                    .both({{0.0, reach, -0.02, -0.3, 0.72}, {1, reach, -0.02, -0.3, 0.72}})
                                    .wave(ly, 0.16, 0.55, 0.05, 0.97)
                                    .wave(ry, -0.16, 0.55, 0.05, 0.97)
                                    .wave(lx, 0.04, 0.55, 0.05, 0.97)
                                    .wave(rx, -0.04, 0.55, 0.05, 0.97)
                                    .wave(turn, 14, 0.4, 0.05, 0.97)
                                    .fists(0.9, 0.9)},
        {"boxing", Programme(0, 3.0)
                       .both({{0.05, reach, -0.05, -0.1, 0.4}})
                       .right(cycles(2, 0.08, 0.92,
                                     {{0.12, reach, -0.05, -0.1, 0.4},
                                      {0.3, reach, -0.2, 0.05, 0.96},
                                      {0.5, reach, -0.05, -0.1, 0.4},
                                      {0.98, reach, -0.05, -0.1, 0.4}}))
                       .left(cycles(2, 0.08, 0.92,
                                    {{0.5, reach, -0.05, -0.1, 0.4},
                                     {0.68, reach, -0.2, 0.05, 0.96},
                                     {0.92, reach, -0.05, -0.1, 0.4}}))
                       .both({{1, rest}})
                       .wave(twist, 20, 0.62, 0.08, 0.92)
                       .hold(lfz, 0.16)
                       .hold(rfz, -0.14)
                       .hold(py, -0.06)
                       .wave(py, 0.015, 2, 0, 1)
                       .move(bend, {{0, 8}})
                       .fists(1, 1)},
        {"swim", Programme(0, 3.6)
                     .left(cycles(3, 0.06, 0.94,
                                  {{0.25, reach, 0.15, 0.75, 0.5},
                                   {0.5, reach, 0, 0.1, 0.95},
                                   {0.8, reach, 0.1, -0.85, 0.1},
                                   {0.98, reach, 0.4, -0.4, -0.35}}))
                     .right({{0.1, reach, 0.1, -0.85, 0.1}})
                     .right(cycles(3, 0.2, 0.94,
                                   {{0.25, reach, 0.15, 0.75, 0.5},
                                    {0.5, reach, 0, 0.1, 0.95},
                                    {0.8, reach, 0.1, -0.85, 0.1},
                                    {0.98, reach, 0.4, -0.4, -0.35}}))
                     .both({{1, rest}})
                     .move(bend, {{0.02, 0}, {0.12, 34}, {0.9, 34}, {1, 0}})
                     .wave(twist, 20, 0.83, 0.06, 0.94)},
    };
}

std::vector<NamedProgramme> with_the_hands() {
    return {
        {"scratch", right_held(2.8, {0, crown, 0.05, -0.02, -0.02})
                        .wave(ry, 0.03, 3.0, 0.26, 0.78)
                        .move(relbow, {{0.1, 0}, {0.3, 24}, {0.8, 24}, {1, 0}})},
        {"communicate", held(3.2, {0, reach, 0.02, -0.42, 0.45})
                            .wave(ry, 0.09, 1.1, 0.2, 0.84)
                            .wave(ly, 0.07, 0.9, 0.2, 0.84, 0.3)
                            .wave(rx, 0.07, 0.8, 0.2, 0.84)
                            .wave(nod, 7, 1.2, 0.1, 0.9)},
        {"wrist movements", held(3.0, {0, reach, 0.0, -0.3, 0.6})
                                .wave(lflex, 45, 1.2, 0.22, 0.84)
                                .wave(rflex, 45, 1.2, 0.22, 0.84)
                                .wave(lx, 0.03, 1.2, 0.22, 0.84, 0.25)
                                .wave(rx, 0.03, 1.2, 0.22, 0.84, 0.25)},
        {"rolling movement", held(3.0, {0, reach, -0.18, -0.32, 0.5})
                                 .wave(ly, 0.1, 1.3, 0.2, 0.84)
                                 .wave(ry, 0.1, 1.3, 0.2, 0.84, 0.5)
                                 .wave(lz, 0.1, 1.3, 0.2, 0.84, 0.25)
                                 .wave(rz, 0.1, 1.3, 0.2, 0.84, 0.75)},
        {"hit", Programme(0, 2.2)
                    .right({{0.15, reach, 0.1, -0.3, 0.2},
                            {0.38, reach, 0.65, 0.1, 0.1},
                            {0.55, reach, -0.35, 0.05, 0.85},
                            {0.7, reach, -0.5, -0.1, 0.5},
                            {1, rest}})
                    .left({{0.2, reach, -0.05, -0.15, 0.4}, {0.7, reach, -0.05, -0.15, 0.4}, {1, rest}})
                    .move(twist, {{0.15, 0}, {0.38, -30}, {0.56, 30}, {0.75, 22}, {1, 0}})
                    .move(pz, {{0.3, -0.03}, {0.55, 0.1}, {0.9, 0}})
                    .fists(1, 1)},
        {"exercise", Programme(0, 3.4)
                         .beat(py, -0.26, 0.7, 0.06, 0.94)
                         .both({{0.08, reach, 0.3, 0.4, 0.3}, {0.92, reach, 0.3, 0.4, 0.3}, {1, rest}})
                         .wave(ly, 0.32, 0.7, 0.08, 0.92)
                         .wave(ry, 0.32, 0.7, 0.08, 0.92)
                         .hold(lfx, 0.06)
                         .hold(rfx, 0.06)},
        {"abstract action", held(3.0, {0, reach, 0.3, 0.05, 0.55})
                                .wave(lx, 0.16, 0.6, 0.2, 0.84)
                                .wave(ry, 0.16, 0.7, 0.2, 0.84)
                                .wave(bend, 9, 0.5, 0.1, 0.9)
                                .wave(yaw, 12, 0.4, 0.1, 0.9)},
        {"misc body part",
         Programme(0, 3.0)
             .wave(lflex, 30, 0.9, 0.1, 0.9)
             .wave(rroll, 40, 0.8, 0.1, 0.9)
             .wave(tilt, 12, 0.6, 0.1, 0.9)
             .both({{0.15, reach, 0.25, -0.6, 0.35}, {0.85, reach, 0.25, -0.6, 0.35}, {1, rest}})},
    };
}

}  // namespace

std::vector<NamedProgramme> handling() {
    std::vector<NamedProgramme> all;
    for (const auto& table : {held_poses(), at_things(), with_the_hands()})
        all.insert(all.end(), table.begin(), table.end());
    return all;
}

}  // namespace actformer::ingest::synth
