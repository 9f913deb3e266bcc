// Actions 50 to 60 and 106 to 120: what two persons do with or to each other. The first person acts, the
// other answers.
#include "ingest/synth/programmes/ntu.hpp"

namespace actformer::ingest::synth {
namespace {

using enum At;

std::vector<Programme> mutual() {
    return {
        Programme(50, 2.4)  // punch or slap: at the head; the other is thrown back by it
            .facing(0.86)
            .touch_at(0.46)
            .right({{0.28, reach, 0.15, -0.25, 0.15},
                    {0.46, partner_head, 0, 0, -0.08},
                    {0.54, reach, -0.2, 0.0, 0.8},
                    {0.7, reach, 0, -0.4, 0.4},
                    {0.95, rest}})
            .left({{0.28, reach, -0.1, -0.2, 0.4}, {0.65, reach, -0.1, -0.3, 0.35}, {0.95, rest}})
            .move(twist, {{0.1, 0}, {0.28, -28}, {0.46, 26}, {0.6, 20}, {0.9, 0}})
            .move(pz, {{0.28, -0.04}, {0.46, 0.14}, {0.85, 0}})
            .fists(1, 1)
            .other()
            .move(nod, {{0.45, 0}, {0.54, -30}, {0.75, -5}, {1, 0}})
            .move(turn, {{0.45, 0}, {0.54, 24}, {0.8, 0}})
            .move(bend, {{0.45, 0}, {0.58, -20}, {0.8, 6}, {1, 4}})
            .move(wz, {{0.46, 0}, {0.84, -0.34}})
            .both({{0.44, rest}, {0.58, reach, 0.45, -0.35, 0.45}, {0.8, eye, 0.04, -0.06, 0.02}}),
        Programme(51, 2.4)  // kicking: a front kick to the belly; the other folds over it
            .facing(1.12)
            .touch_at(0.46)
            .move(rfz, {{0.14, 0}, {0.3, 0.12}, {0.46, 0.86}, {0.56, 0.8}, {0.72, 0.1}, {0.88, 0}})
            .move(rfy, {{0.14, 0}, {0.3, 0.42}, {0.46, 0.78}, {0.56, 0.72}, {0.72, 0.36}, {0.88, 0}})
            .move(rfp, {{0.14, 0}, {0.3, 20}, {0.46, -10}, {0.88, 0}})
            .move(px, {{0.1, 0}, {0.28, 0.07}, {0.7, 0.07}, {0.9, 0}})
            .move(pz, {{0.2, 0}, {0.46, 0.1}, {0.8, 0}})
            .move(pitch, {{0.25, 0}, {0.46, -18}, {0.6, -16}, {0.85, 0}})
            .both({{0.25, reach, 0, -0.3, 0.4}, {0.5, reach, 0.3, -0.55, 0.15}, {0.95, rest}})
            .fists(1, 1)
            .other()
            .move(bend, {{0.45, 0}, {0.58, 46}, {0.85, 34}, {1, 20}})
            .move(wz, {{0.46, 0}, {0.74, -0.42}})
            .both({{0.43, rest}, {0.6, belly, 0.05, 0, 0.01}, {1, belly, 0.05, 0, 0.01}}),
        Programme(52,
                  2.6)  // pushing: both hands on the chest, then straight arms; the other steps back twice
            .facing(0.74)
            .touch_at(0.40)
            .both({{0.22, reach, -0.05, -0.2, 0.25},
                   {0.40, partner_chest, 0.1, 0, -0.03},
                   {0.5, reach, -0.1, -0.1, 0.96},
                   {0.66, reach, -0.1, -0.2, 0.8},
                   {0.95, rest}})
            .move(bend, {{0.22, -4}, {0.48, 20}, {0.7, 12}, {1, 0}})
            .move(pz, {{0.22, -0.03}, {0.48, 0.12}, {0.9, 0.02}})
            .move(lfz, {{0.2, 0}, {0.38, 0.2}})
            .move(lfy, {{0.2, 0}, {0.28, 0.06}, {0.38, 0}})
            .other()
            .move(wz, {{0.40, 0}, {0.92, -0.7}})
            .move(bend, {{0.40, 0}, {0.54, -18}, {0.75, 14}, {1, 0}})
            .move(nod, {{0.40, 0}, {0.5, 24}, {0.8, 0}})
            .both({{0.40, rest}, {0.56, reach, 0.4, -0.3, 0.6}, {0.8, reach, 0.4, -0.6, 0.3}, {1, rest}}),
        Programme(53, 2.8)  // pat on back, from behind
            .touch_at(0.34)
            .stand(-0.1, -0.29, 0)
            .right({{0.34, partner_back, -0.02, 0.06, 0.0}})
            .right(cycles(3, 0.34, 0.8,
                          {{0.4, partner_back, 0, 0.1, -0.17}, {0.95, partner_back, -0.02, 0.06, 0.0}}))
            .right({{1, rest}})
            .move(bend, {{0.2, 0}, {0.34, 6}, {0.8, 6}, {1, 0}})
            .other()
            .stand(0.05, 0.27, 0)
            .move(turn, {{0.4, 0}, {0.58, 48}, {0.85, 48}, {1, 20}})
            .move(twist, {{0.4, 0}, {0.58, 14}, {0.85, 14}, {1, 6}})
            .move(bend, {{0.33, 0}, {0.37, 5}, {0.45, 2}, {0.7, 4}}),
        Programme(54, 2.8)  // point finger at the other's face; the other shrinks from it
            .facing(1.24)
            .right({{0.26, reach, -0.12, 0.1, 0.95}, {0.8, reach, -0.12, 0.1, 0.95}, {1, rest}})
            .wave(ry, 0.05, 2.1, 0.3, 0.8)
            .move(bend, {{0.15, 0}, {0.3, 10}, {0.8, 10}, {1, 0}})
            .left({{0.3, waist, 0.02, 0, 0}, {0.8, waist, 0.02, 0, 0}, {1, rest}})
            .other()
            .move(bend, {{0.26, 0}, {0.42, -9}, {0.8, -7}, {1, 0}})
            .move(nod, {{0.26, 0}, {0.42, 14}, {0.8, 18}, {1, 8}})
            .move(turn, {{0.4, 0}, {0.55, 16}, {0.8, 16}, {1, 0}}),
        Programme(55, 3.6)  // hugging: both step in, arms around, step apart
            .facing(1.3)
            .touch_at(0.5)
            .move(wz, {{0.06, 0}, {0.36, 0.48}, {0.7, 0.48}, {0.96, 0.1}})
            .both({{0.12, rest}, {0.30, reach, 0.3, 0.0, 0.75}})
            .right({{0.46, partner_back, -0.02, 0.10, 0}, {0.66, partner_back, -0.02, 0.10, 0}})
            .left({{0.46, partner_back, -0.04, -0.08, 0}, {0.66, partner_back, -0.04, -0.08, 0}})
            .both({{0.78, reach, 0.3, -0.2, 0.6}, {1, rest}})
            .move(bend, {{0.3, 0}, {0.46, 9}, {0.66, 9}, {0.8, 0}})
            .move(tilt, {{0.3, 0}, {0.46, -14}, {0.66, -14}, {0.8, 0}})
            .wave(ry, 0.03, 2.0, 0.48, 0.68)
            .other()
            .move(wz, {{0.06, 0}, {0.36, 0.48}, {0.7, 0.48}, {0.96, 0.1}})
            .both({{0.14, rest}, {0.32, reach, 0.3, 0.0, 0.7}})
            .right({{0.48, partner_back, -0.02, 0.04, 0}, {0.66, partner_back, -0.02, 0.04, 0}})
            .left({{0.48, partner_back, -0.04, -0.12, 0}, {0.66, partner_back, -0.04, -0.12, 0}})
            .both({{0.78, reach, 0.3, -0.2, 0.6}, {1, rest}})
            .move(bend, {{0.3, 0}, {0.46, 9}, {0.66, 9}, {0.8, 0}})
            .move(tilt, {{0.3, 0}, {0.46, -14}, {0.66, -14}, {0.8, 0}}),
        Programme(56, 2.8)  // giving object
            .facing(1.12)
            .touch_at(0.5)
            .right({{0, reach, -0.15, -0.5, 0.45},
                    {0.2, reach, -0.15, -0.45, 0.5},
                    {0.46, meet, 0, -0.2, -0.02},
                    {0.56, meet, 0, -0.2, -0.02},
                    {0.85, rest}})
            .move(bend, {{0.25, 0}, {0.48, 8}, {0.75, 0}})
            .move(rgrip, {{0, 0.8}, {0.5, 0.8}, {0.58, 0}})
            .other()
            .right({{0.24, rest},
                    {0.48, meet, 0, -0.2, 0.02},
                    {0.56, meet, 0, -0.2, 0.02},
                    {0.82, reach, -0.2, -0.45, 0.45},
                    {1, reach, -0.2, -0.45, 0.45}})
            .move(bend, {{0.25, 0}, {0.48, 8}, {0.75, 0}})
            .move(nod, {{0.2, 0}, {0.4, 18}, {0.85, 22}, {1, 10}})
            .move(rgrip, {{0.5, 0}, {0.58, 0.8}}),
        Programme(57, 3.0)  // touch pocket: from behind, bent down, quickly away
            .touch_at(0.48)
            .stand(-0.2, -0.34, 0)
            .right({{0.26, reach, 0, -0.5, 0.5},
                    {0.46, partner_pocket, 0.02, -0.02, -0.02},
                    {0.58, partner_pocket, 0.02, -0.02, -0.02},
                    {0.74, reach, 0.1, -0.6, 0.3},
                    {1, rest}})
            .move(bend, {{0.15, 0}, {0.44, 26}, {0.6, 26}, {0.85, 0}})
            .move(py, {{0.15, 0}, {0.44, -0.1}, {0.6, -0.1}, {0.85, 0}})
            .move(wz, {{0.62, 0}, {0.95, -0.4}})
            .move(nod, {{0.15, 0}, {0.44, 10}, {0.6, 10}, {0.85, 0}})
            .other()
            .stand(0.12, 0.2, 0)
            .move(turn, {{0.6, 0}, {0.78, -40}, {1, -45}})
            .move(twist, {{0.6, 0}, {0.78, -16}, {1, -18}})
            .right(
                {{0.64, rest}, {0.82, back_pocket, 0.03, 0.02, -0.02}, {1, back_pocket, 0.03, 0.02, -0.02}}),
        Programme(58, 2.8)  // shaking hands
            .facing(1.08)
            .touch_at(0.5)
            .right({{0.3, meet, 0, -0.18, -0.02}, {0.74, meet, 0, -0.18, -0.02}, {1, rest}})
            .wave(ry, 0.055, 2.0, 0.32, 0.74)
            .move(bend, {{0.15, 0}, {0.32, 7}, {0.74, 7}, {1, 0}})
            .other()
            .right({{0.3, meet, 0, -0.18, 0.02}, {0.74, meet, 0, -0.18, 0.02}, {1, rest}})
            .wave(ry, 0.055, 2.0, 0.32, 0.74)
            .move(bend, {{0.15, 0}, {0.32, 7}, {0.74, 7}, {1, 0}}),
        Programme(59, 3.0)  // walking towards each other
            .facing(3.3)
            .move(wz, {{0.04, 0}, {0.94, 1.2}})
            .other()
            .move(wz, {{0.04, 0}, {0.94, 1.2}}),
        Programme(60, 3.2)  // walking apart: about turn, then away
            .facing(0.8)
            .move(wyaw, {{0.02, 0}, {0.34, 178}})
            .move(wz, {{0.14, 0}, {0.98, -1.25}})
            .other()
            .move(wyaw, {{0.02, 0}, {0.34, -178}})
            .move(wz, {{0.14, 0}, {0.98, -1.25}})};
}

std::vector<Programme> against() {
    return {
        Programme(106, 2.6)  // hit with object: swung down from overhead; the other ducks under the arms
            .facing(1.16)
            .right({{0.3, reach, 0.15, 0.75, -0.35},
                    {0.48, reach, -0.2, 0.25, 0.92},
                    {0.56, reach, -0.25, -0.1, 0.9},
                    {0.72, reach, 0.1, 0.4, 0.1},
                    {1, rest}})
            .move(bend, {{0.1, 0}, {0.3, -12}, {0.5, 20}, {0.62, 16}, {0.95, 0}})
            .move(twist, {{0.1, 0}, {0.3, -18}, {0.5, 16}, {0.9, 0}})
            .move(pz, {{0.3, -0.04}, {0.5, 0.14}, {0.9, 0}})
            .fists(0.3, 1)
            .other()
            .both({{0.3, rest},
                   {0.46, crown, 0.06, 0.04, 0.06},
                   {0.85, crown, 0.06, 0.02, 0.04},
                   {1, ear, 0.04, 0.04, 0.04}})
            .move(py, {{0.34, 0}, {0.52, -0.24}, {0.8, -0.2}, {1, -0.06}})
            .move(bend, {{0.34, 0}, {0.52, 40}, {0.8, 32}, {1, 10}})
            .move(nod, {{0.34, 0}, {0.52, 26}, {0.8, 22}, {1, 8}}),
        Programme(107, 3.0)  // wield knife: three stabs, each a lunge; the other gives ground with hands up
            .facing(1.3)
            .right({{0.12, reach, 0.1, -0.5, 0.2}})
            .right(cycles(3, 0.12, 0.86,
                          {{0.2, reach, 0.1, -0.5, 0.15},
                           {0.55, reach, -0.15, -0.32, 0.95},
                           {0.98, reach, 0.1, -0.5, 0.2}}))
            .right({{1, rest}})
            .move(wz, {{0.2, 0}, {0.85, 0.55}})
            .wave(bend, 7, 1.35, 0.12, 0.88)
            .move(bend, {{0.1, 8}, {0.86, 8}, {1, 0}})
            .move(py, {{0.1, -0.08}, {0.86, -0.08}, {1, 0}})
            .fists(0.9, 1)
            .other()
            .move(wz, {{0.24, 0}, {0.92, -0.7}})
            .both({{0.12, rest},
                   {0.26, reach, 0.1, -0.05, 0.6},
                   {0.9, reach, 0.1, -0.05, 0.6},
                   {1, reach, 0.1, -0.3, 0.5}})
            .wave(bend, 6, 1.35, 0.2, 0.9, 0.5)
            .move(bend, {{0.2, -6}, {0.9, -6}, {1, 0}}),
        Programme(108,
                  3.2)  // knock over: run in with the shoulder and both arms; the other goes to the floor
            .facing(1.4)
            .touch_at(0.36)
            .move(wz, {{0.02, 0}, {0.36, 0.68}})
            .both({{0.18, reach, 0, -0.3, 0.4},
                   {0.36, partner_chest, 0.1, 0, -0.03},
                   {0.48, reach, 0, -0.3, 0.85},
                   {0.8, rest}})
            .move(bend, {{0.05, 0}, {0.3, 18}, {0.46, 26}, {0.8, 4}})
            .move(nod, {{0.5, 0}, {0.8, 26}})
            .other()
            .fall(0.36, 0.82),
        Programme(109, 2.6)  // grab stuff: snatched from both hands of its owner, who reaches after it
            .facing(1.02)
            .touch_at(0.42)
            .right({{0.2, reach, 0, -0.5, 0.4},
                    {0.42, meet, 0, -0.14, 0.06},
                    {0.48, meet, 0, -0.14, 0.06},
                    {0.62, reach, 0.25, -0.45, -0.1},
                    {1, reach, 0.2, -0.5, 0.0}})
            .move(twist, {{0.2, 0}, {0.42, 14}, {0.62, -26}, {1, -20}})
            .move(wz, {{0.5, 0}, {0.8, -0.3}})
            .move(bend, {{0.2, 0}, {0.42, 10}, {0.62, -4}})
            .fists(0.2, 0.9)
            .other()
            .right({{0, meet, 0.1, -0.14, 0.1},
                    {0.45, meet, 0.1, -0.14, 0.1},
                    {0.64, reach, -0.05, -0.2, 0.95},
                    {0.85, reach, 0, -0.3, 0.85},
                    {1, rest}})
            .left({{0, meet, -0.1, -0.14, 0.1},
                   {0.45, meet, -0.1, -0.14, 0.1},
                   {0.64, reach, -0.05, -0.25, 0.9},
                   {0.8, reach, 0, -0.4, 0.7},
                   {1, rest}})
            .move(bend, {{0.44, 0}, {0.64, 18}, {0.9, 4}})
            .move(pz, {{0.44, 0}, {0.64, 0.1}, {0.9, 0}}),
        Programme(
            110,
            3.0)  // shoot with gun: two straight arms, two recoils; the other clutches the chest and sinks
            .facing(1.9)
            .right({{0.22, reach, -0.3, 0.02, 0.88}, {0.84, reach, -0.3, 0.02, 0.88}, {1, rest}})
            .left({{0.22, reach, -0.3, 0.0, 0.86}, {0.84, reach, -0.3, 0.0, 0.86}, {1, rest}})
            .beat(ry, 0.11, 1.3, 0.34, 0.7)
            .beat(ly, 0.11, 1.3, 0.34, 0.7)
            .beat(bend, -5, 1.3, 0.34, 0.7)
            .move(py, {{0.1, 0}, {0.24, -0.07}, {0.84, -0.07}, {1, 0}})
            .fists(0.9, 0.9)
            .other()
            .both({{0.24, rest},
                   {0.36, reach, 0.4, 0.3, 0.2},
                   {0.5, chest, 0.03, -0.04, 0.0},
                   {1, chest, 0.03, -0.06, 0.0}})
            .move(bend, {{0.36, 0}, {0.42, -10}, {0.6, 28}, {1, 46}})
            .move(py, {{0.42, 0}, {0.65, -0.14}, {1, -0.36}})
            .move(nod, {{0.4, 0}, {0.6, 16}, {1, 30}})
            .move(wz, {{0.36, 0}, {0.6, -0.2}}),
        Programme(111, 2.6)  // step on foot: the other pulls the foot up and hops
            .facing(0.66)
            .touch_at(0.42)
            .move(rfz, {{0.12, 0}, {0.28, 0.2}, {0.42, 0.34}, {0.5, 0.34}, {0.72, 0}})
            .move(rfy, {{0.12, 0}, {0.28, 0.24}, {0.42, 0.05}, {0.5, 0.05}, {0.6, 0.12}, {0.72, 0}})
            .move(rfx, {{0.12, 0}, {0.42, 0.02}, {0.5, 0.02}, {0.72, 0}})
            .move(px, {{0.08, 0}, {0.24, 0.05}, {0.42, 0.02}, {0.75, 0}})
            .move(nod, {{0.1, 0}, {0.25, 34}, {0.55, 30}, {0.85, 0}})
            .move(bend, {{0.1, 0}, {0.3, 8}, {0.6, 5}, {0.9, 0}})
            .other()
            .move(lfy, {{0.50, 0}, {0.62, 0.38}, {0.9, 0.36}, {1, 0.3}})
            .move(lfz, {{0.50, 0}, {0.62, 0.08}, {0.9, 0.06}, {1, 0}})
            .move(px, {{0.48, 0}, {0.58, -0.09}, {1, -0.09}})
            .move(bend, {{0.46, 0}, {0.62, 38}, {0.9, 34}, {1, 24}})
            .left({{0.46, rest}, {0.66, foot, 0.02, 0.04, -0.06}, {1, foot, 0.02, 0.06, -0.06}})
            .right({{0.46, rest}, {0.66, reach, 0.4, -0.5, 0.5}, {1, reach, 0.4, -0.55, 0.4}})
            .beat(lift, 0.06, 2.2, 0.62, 1)};
}

std::vector<Programme> with() {
    return {
        Programme(112, 2.4)  // high five
            .facing(0.96)
            .touch_at(0.48)
            .right({{0.3, reach, 0.25, 0.45, 0.05},
                    {0.48, meet, 0, 0.42, -0.015},
                    {0.54, meet, 0, 0.42, -0.015},
                    {0.7, reach, 0.05, 0.2, 0.5},
                    {1, rest}})
            .move(twist, {{0.1, 0}, {0.3, -14}, {0.48, 10}, {0.8, 0}})
            .other()
            .right({{0.3, reach, 0.25, 0.45, 0.05},
                    {0.48, meet, 0, 0.42, 0.015},
                    {0.54, meet, 0, 0.42, 0.015},
                    {0.7, reach, 0.05, 0.2, 0.5},
                    {1, rest}})
            .move(twist, {{0.1, 0}, {0.3, -14}, {0.48, 10}, {0.8, 0}}),
        Programme(113, 3.6)  // cheers and drink
            .facing(1.06)
            .touch_at(0.32)
            .right({{0, reach, -0.1, -0.5, 0.45},
                    {0.30, meet, 0, 0.06, -0.05},
                    {0.36, meet, 0, 0.06, -0.05},
                    {0.55, mouth, 0.02, -0.02, 0.06},
                    {0.8, mouth, 0.02, 0, 0.06},
                    {1, reach, -0.1, -0.5, 0.45}})
            .move(nod, {{0.5, 0}, {0.62, -24}, {0.78, -24}, {0.9, 0}})
            .move(relbow, {{0.5, 0}, {0.62, 26}, {0.78, 26}, {0.95, 0}})
            .fists(0.2, 0.9)
            .other()
            .right({{0, reach, -0.1, -0.5, 0.45},
                    {0.30, meet, 0, 0.06, 0.05},
                    {0.36, meet, 0, 0.06, 0.05},
                    {0.57, mouth, 0.02, -0.02, 0.06},
                    {0.8, mouth, 0.02, 0, 0.06},
                    {1, reach, -0.1, -0.5, 0.45}})
            .move(nod, {{0.52, 0}, {0.64, -24}, {0.78, -24}, {0.9, 0}})
            .move(relbow, {{0.5, 0}, {0.64, 26}, {0.78, 26}, {0.95, 0}})
            .fists(0.2, 0.9),
        Programme(114, 4.2)  // carry object: lifted together, carried sideways
            .facing(1.36)
            .touch_at(0.5)
            .right({{0.14, meet, -0.2, -0.72, -0.26},
                    {0.2, meet, -0.2, -0.72, -0.26},
                    {0.36, meet, -0.2, -0.42, -0.26},
                    {1, meet, -0.2, -0.42, -0.26}})
            .left({{0.14, meet, 0.2, -0.72, -0.26},
                   {0.2, meet, 0.2, -0.72, -0.26},
                   {0.36, meet, 0.2, -0.42, -0.26},
                   {1, meet, 0.2, -0.42, -0.26}})
            .move(bend, {{0.02, 0}, {0.15, 40}, {0.2, 40}, {0.36, 2}})
            .move(py, {{0.02, 0}, {0.15, -0.26}, {0.2, -0.26}, {0.36, -0.02}})
            .move(wx, {{0.34, 0}, {0.96, 0.95}})
            .fists(0.9, 0.9)
            .other()
            .right({{0.14, meet, 0.2, -0.72, 0.26},
                    {0.2, meet, 0.2, -0.72, 0.26},
                    {0.36, meet, 0.2, -0.42, 0.26},
                    {1, meet, 0.2, -0.42, 0.26}})
            .left({{0.14, meet, -0.2, -0.72, 0.26},
                   {0.2, meet, -0.2, -0.72, 0.26},
                   {0.36, meet, -0.2, -0.42, 0.26},
                   {1, meet, -0.2, -0.42, 0.26}})
            .move(bend, {{0.02, 0}, {0.15, 40}, {0.2, 40}, {0.36, 2}})
            .move(py, {{0.02, 0}, {0.15, -0.26}, {0.2, -0.26}, {0.36, -0.02}})
            .move(wx, {{0.34, 0}, {0.96, -0.95}})
            .fists(0.9, 0.9),
        Programme(115, 3.2)  // take a photo: camera at the eyes; the other poses with a raised hand
            .facing(2.1)
            .both({{0.24, eye, 0.05, -0.02, 0.12}, {0.86, eye, 0.05, -0.02, 0.12}, {1, rest}})
            .move(bend, {{0.2, 0}, {0.34, 9}, {0.82, 9}, {1, 0}})
            .move(py, {{0.2, 0}, {0.34, -0.09}, {0.82, -0.09}, {1, 0}})
            .beat(rflex, 20, 1.0, 0.4, 0.8)
            .fists(0.6, 0.6)
            .other()
            .right({{0.14, rest}, {0.32, reach, 0.45, 0.3, 0.3}, {0.84, reach, 0.45, 0.3, 0.3}, {1, rest}})
            .left({{0.14, rest}, {0.32, waist, 0.03, 0, 0}, {0.84, waist, 0.03, 0, 0}, {1, rest}})
            .move(tilt, {{0.2, 0}, {0.36, 12}, {0.82, 12}, {1, 0}})
            .move(px, {{0.2, 0}, {0.36, 0.05}, {0.82, 0.05}, {1, 0}}),
        Programme(116, 3.4)  // follow: one behind the other, the same way
            .stand(0, -1.25, 0)
            .move(wz, {{0.06, 0}, {0.97, 1.6}})
            .move(nod, {{0.1, 10}})
            .other()
            .stand(0, -0.3, 0)
            .move(wz, {{0.0, 0}, {0.94, 1.6}})
            .move(turn, {{0.45, 0}, {0.58, 50}, {0.7, 50}, {0.82, 0}}),
        Programme(117, 3.2)  // whisper: into the ear behind a hand, the other leans to it
            .touch_at(0.5)
            .stand(0.12, -0.27, 0)
            .right({{0.26, mouth, 0.05, -0.01, 0.06}, {0.84, mouth, 0.05, -0.01, 0.06}, {1, rest}})
            .left({{0.3, partner_shoulder, 0.0, 0.04, -0.02},
                   {0.82, partner_shoulder, 0.0, 0.04, -0.02},
                   {1, rest}})
            .move(bend, {{0.12, 0}, {0.32, 17}, {0.82, 17}, {1, 0}})
            .move(side, {{0.12, 0}, {0.32, 7}, {0.82, 7}, {1, 0}})
            .wave(nod, 4, 1.4, 0.32, 0.84)
            .other()
            .stand(-0.12, 0.24, 115)
            .move(tilt, {{0.2, 0}, {0.38, -14}, {0.84, -14}, {1, 0}})
            .move(side, {{0.2, 0}, {0.38, -8}, {0.84, -8}, {1, 0}})
            .move(nod, {{0.3, 0}, {0.6, 8}, {0.84, 12}, {1, 0}}),
        Programme(118, 3.0)  // exchange things: each gives with the right and takes with the left
            .facing(1.0)
            .touch_at(0.5)
            .right({{0, belly, 0.06, 0.05, 0.1},
                    {0.2, belly, 0.06, 0.05, 0.12},
                    {0.46, meet, -0.13, -0.18, -0.02},
                    {0.58, meet, -0.13, -0.18, -0.02},
                    {0.84, rest}})
            .left({{0.2, rest},
                   {0.46, meet, 0.13, -0.18, -0.02},
                   {0.58, meet, 0.13, -0.18, -0.02},
                   {0.84, belly, 0.06, 0.05, 0.1},
                   {1, belly, 0.06, 0.05, 0.1}})
            .move(nod, {{0.2, 6}, {0.4, 20}, {0.9, 18}, {1, 8}})
            .other()
            .right({{0, belly, 0.06, 0.05, 0.1},
                    {0.2, belly, 0.06, 0.05, 0.12},
                    {0.46, meet, 0.13, -0.18, 0.02},
                    {0.58, meet, 0.13, -0.18, 0.02},
                    {0.84, rest}})
            .left({{0.2, rest},
                   {0.46, meet, -0.13, -0.18, 0.02},
                   {0.58, meet, -0.13, -0.18, 0.02},
                   {0.84, belly, 0.06, 0.05, 0.1},
                   {1, belly, 0.06, 0.05, 0.1}})
            .move(nod, {{0.2, 6}, {0.4, 20}, {0.9, 18}, {1, 8}}),
        Programme(119, 3.8)  // support somebody: side by side, an arm about the back, the other limps along
            .touch_at(0.5)
            .stand(0.19, -0.5, 0)
            .right({{0, partner_back, 0.04, -0.1, 0}, {1, partner_back, 0.04, -0.1, 0}})
            .left({{0, belly, 0.02, 0.02, 0.02}, {1, belly, 0.02, 0.02, 0.02}})
            .move(wz, {{0.04, 0}, {0.96, 0.95}})
            .move(side, {{0, 5}})
            .move(turn, {{0, -10}, {0.5, -22}, {1, -10}})
            .other()
            .stand(-0.19, -0.5, 0)
            .left({{0, partner_nape, -0.06, 0.0, 0}, {1, partner_nape, -0.06, 0.0, 0}})
            .right({{0, thigh, 0.02, 0.02, 0.02}, {1, thigh, 0.02, 0.02, 0.02}})
            .move(wz, {{0.04, 0}, {0.96, 0.95}})
            .move(bend, {{0, 16}, {1, 16}})
            .move(nod, {{0, 20}, {1, 20}})
            .move(side, {{0, -9}})
            .wave(py, 0.035, 1.1, 0.05, 0.95)
            .wave(bend, 6, 1.1, 0.05, 0.95),
        Programme(120, 3.4)  // rock paper scissors: three beats of the fist, then the throw
            .facing(1.3)
            .right({{0.14, reach, -0.05, -0.42, 0.5},
                    {0.62, reach, -0.05, -0.42, 0.5},
                    {0.72, reach, -0.05, -0.36, 0.82},
                    {0.9, reach, -0.05, -0.36, 0.82},
                    {1, rest}})
            .beat(ry, 0.16, 1.8, 0.14, 0.64)
            .left({{0.12, low_back, 0, -0.02, -0.02}, {0.9, low_back, 0, -0.02, -0.02}, {1, rest}})
            .move(nod, {{0.1, 8}, {0.7, 20}, {0.9, 20}, {1, 0}})
            .move(rgrip, {{0.1, 1}, {0.64, 1}, {0.7, 0}})
            .other()
            .right({{0.14, reach, -0.05, -0.42, 0.5},
                    {0.62, reach, -0.05, -0.42, 0.5},
                    {0.72, reach, -0.05, -0.36, 0.82},
                    {0.9, reach, -0.05, -0.36, 0.82},
                    {1, rest}})
            .beat(ry, 0.16, 1.8, 0.14, 0.64)
            .move(nod, {{0.1, 8}, {0.7, 20}, {0.9, 20}, {1, 0}})
            .move(rgrip, {{0.1, 1}, {0.64, 1}})};
}

}  // namespace

std::vector<Programme> together_programmes() {
    std::vector<Programme> all;
    for (const auto& table : {mutual(), against(), with()}) all.insert(all.end(), table.begin(), table.end());
    return all;
}

}  // namespace actformer::ingest::synth
