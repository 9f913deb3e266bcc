// Actions 61 to 105: what NTU RGB+D 120 added for one person. The right hand acts; clips are mirrored for the
// left.
#include "ingest/synth/programmes/ntu.hpp"

namespace actformer::ingest::synth {
namespace {

using enum At;

std::vector<Programme> head_and_sports() {
    return {Programme(61, 3.0)  // put on headphone: from the belly wide over the head onto the ears
                .both({{0.12, belly, 0.12, 0.05, 0.12},
                       {0.36, crown, 0.2, 0.10, 0.02},
                       {0.55, ear, 0.1, 0.03, 0},
                       {0.68, ear, 0.03, -0.02, 0},
                       {0.82, ear, 0.03, -0.02, 0},
                       {1, rest}})
                .move(lelbow, {{0.2, 0}, {0.4, 22}, {0.8, 22}, {1, 0}})
                .move(relbow, {{0.2, 0}, {0.4, 22}, {0.8, 22}, {1, 0}}),
            Programme(62, 3.0)  // take off headphone: off the ears, up wide, and down around the neck
                .both({{0.2, ear, 0.03, -0.02, 0},
                       {0.32, ear, 0.03, -0.02, 0},
                       {0.46, ear, 0.14, 0.02, 0.02},
                       {0.58, crown, 0.2, 0.06, 0.1},
                       {0.76, throat, 0.14, 0, 0.05},
                       {0.84, throat, 0.14, 0, 0.05},
                       {1, rest}})
                .move(nod, {{0.4, 0}, {0.58, 16}, {0.8, 8}, {1, 0}})
                .move(lelbow, {{0.1, 0}, {0.3, 22}, {0.7, 22}, {1, 0}})
                .move(relbow, {{0.1, 0}, {0.3, 22}, {0.7, 22}, {1, 0}}),
            Programme(63, 2.6)  // shoot at basket: a dip, both hands up, a small jump
                .both({{0.14, reach, -0.22, -0.35, 0.5}, {0.36, reach, -0.22, -0.2, 0.45}})
                .right({{0.5, crown, 0.04, 0.12, 0.14},
                        {0.6, reach, -0.2, 0.85, 0.42},
                        {0.74, reach, -0.2, 0.8, 0.5},
                        {1, rest}})
                .left({{0.5, crown, 0.08, 0.1, 0.12},
                       {0.6, reach, 0.05, 0.75, 0.35},
                       {0.74, reach, 0.1, 0.4, 0.5},
                       {1, rest}})
                .move(py, {{0.2, 0}, {0.42, -0.18}, {0.54, 0}, {0.66, 0}, {0.74, -0.12}, {0.95, 0}})
                .move(lift, {{0.52, 0}, {0.6, 0.18}, {0.68, 0}})
                .move(rflex, {{0.5, -50}, {0.58, -50}, {0.64, 55}, {0.8, 40}, {1, 0}})
                .move(nod, {{0.3, 0}, {0.5, -20}, {0.8, -20}, {1, 0}})
                .move(lfp, {{0.5, 0}, {0.6, 40}, {0.69, 0}})
                .move(rfp, {{0.5, 0}, {0.6, 40}, {0.69, 0}}),
            Programme(64, 3.2)  // bounce ball
                .right({{0.12, reach, 0.05, -0.55, 0.55}, {0.9, reach, 0.05, -0.55, 0.55}, {1, rest}})
                .wave(ry, 0.13, 1.6, 0.12, 0.9)
                .wave(rflex, 25, 1.6, 0.12, 0.9, 0.3)
                .move(bend, {{0.1, 18}, {0.9, 18}, {1, 0}})
                .move(py, {{0.1, -0.1}, {0.9, -0.1}, {1, 0}})
                .wave(py, 0.025, 1.6, 0.12, 0.9)
                .left({{0.12, reach, 0.25, -0.6, 0.35}, {0.9, reach, 0.25, -0.6, 0.35}, {1, rest}})
                .move(nod, {{0.1, 10}, {0.9, 10}, {1, 0}}),
            Programme(65, 2.6)  // tennis bat swing: far back at the side, then across the body
                .right({{0.14, reach, 0.1, -0.5, 0.55},
                        {0.40, reach, 0.75, -0.25, -0.5},
                        {0.56, reach, 0.2, -0.2, 0.9},
                        {0.70, reach, -0.85, 0.25, 0.35},
                        {0.78, reach, -0.85, 0.25, 0.35},
                        {1, rest}})
                .left({{0.40, reach, 0.35, -0.2, 0.7}, {0.6, reach, 0.5, -0.5, 0.1}, {1, rest}})
                .move(twist, {{0.14, 0}, {0.40, -42}, {0.56, 10}, {0.72, 38}, {0.8, 36}, {1, 0}})
                .move(yaw, {{0.14, 0}, {0.40, -22}, {0.7, 22}, {1, 0}})
                .move(py, {{0.1, 0}, {0.35, -0.1}, {0.75, -0.06}, {1, 0}})
                .move(lfz, {{0.3, 0}, {0.5, 0.24}})
                .move(lfy, {{0.3, 0}, {0.39, 0.07}, {0.5, 0}})
                .move(pz, {{0.3, 0}, {0.6, 0.1}})
                .fists(0.2, 1),
            Programme(66, 3.4)  // juggle table tennis ball: small quick lifts of a bat held level, eyes on it
                .right({{0.14, reach, -0.12, -0.36, 0.6}, {0.9, reach, -0.12, -0.36, 0.6}, {1, rest}})
                .wave(ry, 0.05, 2.3, 0.14, 0.9)
                .wave(rx, 0.03, 0.6, 0.14, 0.9)
                .move(rroll, {{0.14, 85}, {0.9, 85}, {1, 0}})
                .wave(nod, 5, 2.3, 0.14, 0.9, 0.3)
                .move(nod, {{0.14, 14}, {0.9, 14}, {1, 0}})
                .left({{0.14, reach, 0.3, -0.7, 0.3}, {0.9, reach, 0.3, -0.7, 0.3}, {1, rest}})
                .fists(0.2, 1),
            Programme(67, 2.4)  // hush: a finger to the lips, leaning in
                .right({{0.3, mouth, 0, 0.0, 0.05}, {0.76, mouth, 0, 0.0, 0.05}, {1, rest}})
                .move(bend, {{0.2, 0}, {0.35, 11}, {0.74, 11}, {1, 0}})
                .move(pz, {{0.2, 0}, {0.35, 0.05}, {0.74, 0.05}, {1, 0}})
                .move(rflex, {{0.2, 0}, {0.32, -30}, {0.75, -30}, {1, 0}})
                .move(relbow, {{0.2, 0}, {0.32, -22}, {0.75, -22}, {1, 0}}),
            Programme(68, 2.6)  // flick hair: along the temple, then thrown outwards
                .right({{0.28, brow, 0.07, 0.03, 0.0},
                        {0.46, ear, 0.04, 0.05, 0},
                        {0.56, ear, 0.24, 0.0, -0.06},
                        {0.68, ear, 0.3, -0.14, 0.02},
                        {1, rest}})
                .move(tilt, {{0.25, 0}, {0.4, 17}, {0.54, -17}, {0.7, -6}, {0.9, 0}})
                .move(turn, {{0.25, 0}, {0.4, -18}, {0.54, 26}, {0.75, 6}, {0.95, 0}})
                .move(relbow, {{0.1, 0}, {0.3, 35}, {0.6, 35}, {0.9, 0}}),
            Programme(69, 2.4)  // thumb up: a fist thrust out, thumb to the sky
                .right({{0.32, reach, -0.05, -0.16, 0.78}, {0.74, reach, -0.05, -0.16, 0.78}, {1, rest}})
                .wave(ry, 0.025, 1.5, 0.34, 0.74)
                .move(rroll, {{0.15, 0}, {0.3, -25}, {0.74, -25}, {1, 0}})
                .move(nod, {{0.3, 0}, {0.45, 10}, {0.6, 0}})
                .fists(0.2, 1),
            Programme(70, 2.4)  // thumb down: the elbow out, the thumb to the floor
                .right({{0.32, reach, 0.05, -0.2, 0.7},
                        {0.46, reach, 0.05, -0.3, 0.7},
                        {0.74, reach, 0.05, -0.3, 0.7},
                        {1, rest}})
                .wave(ry, 0.035, 1.3, 0.4, 0.76, 0.5)
                .move(relbow, {{0.15, 0}, {0.35, 58}, {0.74, 58}, {1, 0}})
                .move(rroll, {{0.15, 0}, {0.35, 150}, {0.74, 150}, {1, 0}})
                .wave(turn, 12, 1.2, 0.35, 0.8)
                .fists(0.2, 1),
            Programme(71, 2.6)  // make OK sign: beside the face, small
                .right({{0.32, reach, 0.1, 0.12, 0.52}, {0.76, reach, 0.1, 0.12, 0.52}, {1, rest}})
                .move(rgrip, {{0.2, 0.2}, {0.36, 0.55}, {0.76, 0.55}, {1, 0.2}})
                .move(rroll, {{0.2, 0}, {0.34, -70}, {0.76, -70}, {1, 0}})
                .move(nod, {{0.35, 0}, {0.42, 14}, {0.5, 0}, {0.57, 14}, {0.66, 0}}),
            Programme(72, 2.6)  // make victory sign: out to the side at the cheek, the head leans to it
                .right({{0.32, reach, 0.48, 0.30, 0.30}, {0.78, reach, 0.48, 0.30, 0.30}, {1, rest}})
                .move(rroll, {{0.2, 0}, {0.34, -60}, {0.76, -60}, {1, 0}})
                .move(tilt, {{0.25, 0}, {0.4, 15}, {0.76, 15}, {0.95, 0}})
                .move(side, {{0.25, 0}, {0.4, 6}, {0.76, 6}, {0.95, 0}})
                .move(rgrip, {{0.2, 0.2}, {0.36, 0}})};
}

std::vector<Programme> handiwork() {
    return {
        Programme(73, 3.0)  // staple book: the right hand presses down on the left, three times
            .left({{0.14, reach, -0.3, -0.6, 0.5}, {0.88, reach, -0.3, -0.6, 0.5}, {1, rest}})
            .right({{0.14, reach, -0.25, -0.35, 0.5}})
            .right(cycles(3, 0.16, 0.86,
                          {{0.25, reach, -0.25, -0.32, 0.5},
                           {0.55, reach, -0.27, -0.52, 0.5},
                           {0.7, reach, -0.27, -0.52, 0.5},
                           {0.98, reach, -0.25, -0.32, 0.5}}))
            .right({{1, rest}})
            .move(nod, {{0.14, 24}, {0.88, 24}, {1, 0}})
            .move(bend, {{0.14, 8}, {0.88, 8}, {1, 0}})
            .fists(0.5, 0.8),
        Programme(74, 3.2)  // counting money: high, the thumb pushes notes aside
            .left({{0.14, reach, -0.28, -0.22, 0.42}, {0.9, reach, -0.28, -0.22, 0.42}, {1, rest}})
            .right({{0.14, reach, -0.22, -0.2, 0.44}, {0.9, reach, -0.22, -0.2, 0.44}, {1, rest}})
            .beat(rx, 0.09, 2.2, 0.15, 0.9)
            .wave(ry, 0.025, 2.2, 0.15, 0.9, 0.25)
            .move(nod, {{0.14, 22}, {0.9, 22}, {1, 0}})
            .wave(nod, 3, 2.2, 0.15, 0.9)
            .fists(0.6, 0.5),
        Programme(75, 3.4)  // cutting nails: hands close to the face, hunched
            .left({{0.15, chest, 0.03, 0.09, 0.12}, {0.9, chest, 0.03, 0.09, 0.12}, {1, rest}})
            .right({{0.15, chest, 0.0, 0.11, 0.15}, {0.9, chest, 0.06, 0.11, 0.15}, {1, rest}})
            .beat(rz, 0.035, 1.4, 0.16, 0.9)
            .move(nod, {{0.15, 38}, {0.9, 38}, {1, 0}})
            .move(bend, {{0.15, 12}, {0.9, 12}, {1, 0}})
            .fists(0.6, 0.9),
        Programme(76, 3.4)  // cutting paper: the left holds it up in front, the scissors travel towards it
            .left({{0.14, reach, 0.0, -0.22, 0.68}, {0.9, reach, 0.05, -0.22, 0.6}, {1, rest}})
            .right({{0.14, reach, 0.05, -0.48, 0.36},
                    {0.82, reach, -0.3, -0.28, 0.62},
                    {0.9, reach, -0.3, -0.28, 0.62},
                    {1, rest}})
            .wave(rgrip, 0.35, 2.0, 0.16, 0.88)
            .wave(rz, 0.025, 2.0, 0.16, 0.88)
            .move(nod, {{0.14, 18}, {0.9, 18}, {1, 0}})
            .fists(0.6, 0.5),
        Programme(77, 2.4)  // snap fingers: up beside the shoulder, a flick of the wrist twice
            .right({{0.26, reach, 0.32, 0.02, 0.42}, {0.82, reach, 0.32, 0.02, 0.42}, {1, rest}})
            .beat(ry, -0.10, 1.9, 0.3, 0.85)
            .beat(rflex, 60, 1.9, 0.3, 0.85)
            .beat(rgrip, 0.8, 1.9, 0.3, 0.85)
            .wave(side, 4, 0.95, 0.3, 0.85),
        Programme(78, 3.0)  // open bottle: one hand low, the other twists on top of it
            .left({{0.14, reach, -0.28, -0.6, 0.45}, {0.88, reach, -0.28, -0.6, 0.45}, {1, rest}})
            .right({{0.14, reach, -0.25, -0.3, 0.45},
                    {0.74, reach, -0.25, -0.3, 0.45},
                    {0.84, reach, 0.1, -0.1, 0.5},
                    {1, rest}})
            .wave(rroll, 55, 1.4, 0.16, 0.74)
            .wave(relbow, 16, 1.4, 0.16, 0.74)
            .wave(rx, 0.03, 1.4, 0.16, 0.74, 0.25)
            .move(relbow, {{0.14, 28}, {0.74, 28}, {0.95, 0}})
            .move(nod, {{0.14, 16}, {0.88, 16}, {1, 0}})
            .fists(0.8, 0.8),
        Programme(79, 2.8)  // sniff or smell: both hands bring it under the nose, a deep breath
            .both({{0.12, belly, 0.04, 0.05, 0.1},
                   {0.34, nose, 0.05, -0.06, 0.05},
                   {0.78, nose, 0.05, -0.06, 0.05},
                   {1, rest}})
            .move(bend, {{0.2, 0}, {0.36, 8}, {0.58, -7}, {0.74, 4}, {0.95, 0}})
            .move(nod, {{0.2, 0}, {0.36, 16}, {0.58, -12}, {0.74, 6}, {0.95, 0}})
            .fists(0.6, 0.6),
        Programme(80, 2.8)  // squat down
            .move(py, {{0.1, 0}, {0.45, -0.52}, {0.62, -0.52}, {0.95, 0}})
            .move(pz, {{0.1, 0}, {0.45, -0.1}, {0.62, -0.1}, {0.95, 0}})
            .move(bend, {{0.1, 0}, {0.45, 34}, {0.62, 34}, {0.95, 0}})
            .move(nod, {{0.1, 0}, {0.45, -14}, {0.62, -14}, {0.95, 0}})
            .both({{0.08, rest},
                   {0.42, reach, -0.05, -0.1, 0.9},
                   {0.64, reach, -0.05, -0.1, 0.9},
                   {0.95, rest}})
            .move(lfx, {{0.0, 0.06}})
            .move(rfx, {{0.0, 0.06}}),
        Programme(81, 2.8)  // toss a coin: a flick upwards, eyes follow, catch on the other hand
            .right({{0.2, reach, -0.1, -0.55, 0.5},
                    {0.32, reach, -0.1, -0.62, 0.5},
                    {0.4, reach, -0.1, -0.1, 0.55},
                    {0.54, reach, -0.1, -0.05, 0.55},
                    {0.68, reach, -0.25, -0.5, 0.5},
                    {0.86, reach, -0.25, -0.5, 0.5},
                    {1, rest}})
            .left(
                {{0.56, rest}, {0.7, reach, -0.28, -0.56, 0.5}, {0.86, reach, -0.28, -0.56, 0.5}, {1, rest}})
            .move(nod, {{0.2, 16}, {0.34, 14}, {0.46, -24}, {0.58, -10}, {0.7, 26}, {0.86, 26}, {1, 0}})
            .fists(0.2, 0.8),
        Programme(82, 3.4)  // fold paper: lay over and press along, twice
            .both({{0.12, reach, -0.05, -0.5, 0.55}})
            .right(cycles(2, 0.14, 0.88,
                          {{0.15, reach, 0.0, -0.5, 0.55},
                           {0.45, reach, -0.42, -0.42, 0.55},
                           {0.62, reach, -0.42, -0.5, 0.5},
                           {0.85, reach, -0.2, -0.5, 0.62},
                           {0.99, reach, 0.0, -0.5, 0.55}}))
            .left({{0.88, reach, -0.05, -0.5, 0.55}})
            .both({{1, rest}})
            .move(nod, {{0.12, 26}, {0.88, 26}, {1, 0}})
            .move(bend, {{0.12, 8}, {0.88, 8}, {1, 0}})
            .fists(0.4, 0.4),
        Programme(83, 3.0)  // ball up paper: hands roll about each other
            .both({{0.14, reach, -0.24, -0.34, 0.46}, {0.88, reach, -0.24, -0.34, 0.46}, {1, rest}})
            .wave(ly, 0.05, 1.7, 0.14, 0.88)
            .wave(ry, 0.05, 1.7, 0.14, 0.88, 0.5)
            .wave(lz, 0.05, 1.7, 0.14, 0.88, 0.25)
            .wave(rz, 0.05, 1.7, 0.14, 0.88, 0.75)
            .wave(lelbow, 10, 1.7, 0.14, 0.88)
            .wave(relbow, 10, 1.7, 0.14, 0.88, 0.5)
            .fists(0.9, 0.9),
        Programme(84, 3.6)  // play magic cube: both wrists twist in turn, the cube held to the chest
            .both({{0.14, chest, 0.06, -0.04, 0.14}, {0.9, chest, 0.06, -0.04, 0.14}, {1, rest}})
            .wave(lroll, 50, 1.3, 0.15, 0.9)
            .wave(rroll, 50, 1.0, 0.15, 0.9, 0.3)
            .wave(lx, 0.025, 1.3, 0.15, 0.9)
            .wave(ry, 0.04, 1.0, 0.15, 0.9, 0.3)
            .wave(lelbow, 14, 1.3, 0.15, 0.9)
            .wave(relbow, 14, 1.0, 0.15, 0.9, 0.3)
            .move(nod, {{0.14, 30}, {0.9, 30}, {1, 0}})
            .fists(0.7, 0.7)};
}

std::vector<Programme> care_and_bags() {
    return {
        Programme(85, 3.4)  // apply cream on face: both hands circle on the cheeks
            .both({{0.1, chest, 0.04, 0, 0.1},
                   {0.28, eye, 0.04, -0.06, 0.0},
                   {0.88, eye, 0.04, -0.06, 0.0},
                   {1, rest}})
            .wave(ly, 0.045, 1.5, 0.27, 0.88)
            .wave(ry, 0.045, 1.5, 0.27, 0.88)
            .wave(lx, 0.03, 1.5, 0.27, 0.88, 0.25)
            .wave(rx, 0.03, 1.5, 0.27, 0.88, 0.25)
            .move(nod, {{0.25, -4}, {0.88, -6}, {1, 0}}),
        Programme(86, 3.4)  // apply cream on hand: one strokes the back of the other towards the elbow
            .left({{0.14, reach, -0.15, -0.46, 0.62}, {0.9, reach, -0.15, -0.46, 0.62}, {1, rest}})
            .right({{0.14, reach, -0.45, -0.42, 0.62}})
            .right(cycles(4, 0.16, 0.88,
                          {{0.1, reach, -0.45, -0.42, 0.62},
                           {0.55, reach, -0.62, -0.44, 0.3},
                           {0.95, reach, -0.45, -0.42, 0.62}}))
            .right({{1, rest}})
            .move(nod, {{0.14, 22}, {0.9, 22}, {1, 0}}),
        Programme(87, 4.0)  // put on bag: swung to one shoulder, then the other arm through
            .right({{0.14, reach, 0.0, -0.6, 0.55},
                    {0.34, reach, 0.5, -0.1, 0.3},
                    {0.46, shoulder, 0.28, 0, 0.0},
                    {0.6, reach, 0.15, -0.3, 0.25},
                    {0.86, reach, 0.1, -0.25, 0.25},
                    {1, rest}})
            .left({{0.14, reach, -0.3, -0.6, 0.55},
                   {0.36, reach, -0.5, -0.1, 0.4},
                   {0.5, reach, 0.2, -0.5, 0.2},
                   {0.62, reach, 0.4, -0.65, -0.35},
                   {0.76, reach, 0.35, -0.1, -0.1},
                   {0.86, reach, 0.1, -0.25, 0.25},
                   {1, rest}})
            .move(side, {{0.2, 0}, {0.36, -10}, {0.5, 4}, {0.64, 14}, {0.84, 0}})
            .move(twist, {{0.2, 0}, {0.36, -20}, {0.64, 26}, {0.84, 0}})
            .move(bend, {{0, 14}, {0.14, 16}, {0.4, 6}, {0.86, 10}, {1, 0}}),
        Programme(88, 3.8)  // take off bag: thumbs under the straps, one shoulder out, swung down in front
            .both({{0.16, throat, 0.13, -0.06, 0.04}, {0.26, throat, 0.15, -0.06, 0.05}})
            .left({{0.42, reach, 0.38, -0.15, -0.1},
                   {0.54, reach, 0.3, -0.75, -0.3},
                   {0.7, reach, 0.0, -0.5, 0.5},
                   {0.84, reach, -0.2, -0.85, 0.45},
                   {1, reach, -0.15, -0.85, 0.4}})
            .right({{0.5, throat, 0.16, -0.06, 0.05},
                    {0.66, reach, 0.3, -0.4, 0.4},
                    {0.84, reach, -0.1, -0.85, 0.45},
                    {1, reach, -0.05, -0.85, 0.4}})
            .move(side, {{0.26, 0}, {0.46, -14}, {0.62, 8}, {0.84, 0}})
            .move(twist, {{0.26, 0}, {0.5, 24}, {0.7, -10}, {0.9, 0}})
            .move(bend, {{0.6, 0}, {0.84, 26}, {1, 24}}),
        Programme(89,
                  3.4)  // put object into bag: the left holds it open, the right comes from high and goes in
            .left({{0.14, reach, 0.05, -0.62, 0.42}, {0.9, reach, 0.05, -0.62, 0.42}, {1, rest}})
            .right({{0.2, reach, 0.25, -0.05, 0.7},
                    {0.36, reach, 0.0, -0.1, 0.6},
                    {0.6, reach, -0.5, -0.8, 0.36},
                    {0.72, reach, -0.5, -0.84, 0.36},
                    {0.86, reach, 0, -0.6, 0.4},
                    {1, rest}})
            .move(nod, {{0.2, 0}, {0.5, 30}, {0.8, 30}, {1, 0}})
            .move(bend, {{0.3, 0}, {0.6, 22}, {0.75, 22}, {0.95, 0}})
            .move(rgrip, {{0, 0.9}, {0.6, 0.9}, {0.68, 0}}),
        Programme(90, 3.4)  // take object out of bag: the right goes in low first and comes out high
            .left({{0.1, reach, 0.05, -0.62, 0.42}, {0.9, reach, 0.05, -0.62, 0.42}, {1, rest}})
            .right({{0.12, reach, 0, -0.6, 0.4},
                    {0.28, reach, -0.5, -0.84, 0.36},
                    {0.45, reach, -0.5, -0.8, 0.36},
                    {0.68, reach, 0.0, -0.1, 0.6},
                    {0.9, reach, 0.1, 0.0, 0.66}})
            .wave(rx, 0.03, 2.0, 0.28, 0.46)
            .move(nod, {{0.1, 0}, {0.25, 30}, {0.5, 30}, {0.75, 0}})
            .move(bend, {{0.05, 0}, {0.28, 22}, {0.44, 22}, {0.7, 0}})
            .move(rgrip, {{0.28, 0}, {0.4, 0.9}, {1, 0.9}}),
        Programme(91, 3.2)  // open a box: flaps swung up and out
            .both({{0.14, reach, -0.2, -0.62, 0.55},
                   {0.3, reach, -0.26, -0.6, 0.55},
                   {0.48, reach, -0.05, -0.3, 0.6},
                   {0.64, reach, 0.32, -0.5, 0.55},
                   {0.8, reach, 0.35, -0.6, 0.5},
                   {1, rest}})
            .move(bend, {{0.12, 20}, {0.8, 22}, {1, 0}})
            .move(nod, {{0.12, 18}, {0.8, 22}, {1, 0}}),
        Programme(92, 4.4)  // move heavy objects: down, up with a round back, three steps, down again
            .move(bend,
                  {{0.02, 0}, {0.16, 62}, {0.24, 62}, {0.38, -4}, {0.7, -4}, {0.86, 60}, {0.92, 60}, {1, 30}})
            .move(py, {{0.02, 0},
                       {0.16, -0.34},
                       {0.24, -0.34},
                       {0.38, -0.04},
                       {0.7, -0.04},
                       {0.86, -0.34},
                       {0.92, -0.34},
                       {1, -0.1}})
            .both({{0.16, floor, 0.1, 0.22, 0.0},
                   {0.24, floor, 0.1, 0.22, 0.0},
                   {0.38, belly, 0.16, 0.0, 0.2},
                   {0.7, belly, 0.16, 0.0, 0.2},
                   {0.86, floor, 0.1, 0.22, 0.0},
                   {0.92, floor, 0.1, 0.22, 0.0},
                   {1, reach, 0, -0.8, 0.4}})
            .move(wx, {{0.38, 0}, {0.72, 0.75}})
            .move(wyaw, {{0.38, 0}, {0.55, 40}, {0.72, 30}})
            .fists(0.8, 0.8)};
}

std::vector<Programme> fitness() {
    return {Programme(93, 2.6)  // shake fist: raised at the side of the head, angrily to and fro
                .right({{0.22, reach, 0.18, 0.28, 0.46}, {0.86, reach, 0.18, 0.28, 0.46}, {1, rest}})
                .wave(rz, 0.10, 2.7, 0.22, 0.86)
                .wave(ry, 0.04, 2.7, 0.22, 0.86, 0.5)
                .wave(twist, 4, 2.7, 0.22, 0.86)
                .move(bend, {{0.2, 0}, {0.3, 10}, {0.84, 10}, {1, 0}})
                .fists(0.9, 1),
            Programme(94, 2.6)  // throw up cap: from the head, a swing up, eyes follow it
                .right({{0.22, crown, 0.05, 0.02, 0.08},
                        {0.32, crown, 0.05, 0.02, 0.08},
                        {0.46, reach, 0.1, -0.45, 0.5},
                        {0.58, reach, 0.15, 0.95, 0.2},
                        {0.74, reach, 0.15, 0.9, 0.2},
                        {1, rest}})
                .left({{0.5, rest}, {0.62, reach, 0.3, 0.7, 0.3}, {0.74, reach, 0.3, 0.7, 0.3}, {1, rest}})
                .move(nod, {{0.4, 10}, {0.58, -30}, {0.8, -30}, {1, 0}})
                .move(py, {{0.34, 0}, {0.46, -0.1}, {0.58, 0.01}, {0.8, 0}})
                .move(bend, {{0.34, 0}, {0.46, 14}, {0.58, -6}, {0.9, 0}}),
            Programme(95, 3.0)  // capitulate: open hands beside the head, a step back
                .both({{0.3, reach, 0.42, 0.42, 0.18},
                       {0.9, reach, 0.42, 0.42, 0.18},
                       {1, reach, 0.42, 0.38, 0.18}})
                .move(wz, {{0.3, 0}, {0.62, -0.3}})
                .move(nod, {{0.2, 0}, {0.4, 12}})
                .hold(lroll, -50)
                .hold(rroll, -50),
            Programme(96, 3.0)  // cross arms
                .right({{0.22, reach, -0.2, -0.35, 0.5},
                        {0.4, elbow, 0, -0.03, 0.0},
                        {0.88, elbow, 0, -0.03, 0.0},
                        {1, rest}})
                .left({{0.26, reach, -0.2, -0.45, 0.4},
                       {0.44, elbow, 0.02, -0.1, 0.03},
                       {0.88, elbow, 0.02, -0.1, 0.03},
                       {1, rest}})
                .move(bend, {{0.3, 0}, {0.5, -5}, {0.85, -5}, {1, 0}})
                .move(px, {{0.4, 0}, {0.6, 0.05}, {0.85, 0.05}, {1, 0}})
                .fists(0.6, 0.6),
            Programme(97, 3.4)  // arm circles: both stretched sideways, drawing wheels
                .both({{0.16, reach, 0.95, 0.0, 0.0}, {0.86, reach, 0.95, 0.0, 0.0}, {1, rest}})
                .wave(ly, 0.2, 1.1, 0.16, 0.86)
                .wave(ry, 0.2, 1.1, 0.16, 0.86)
                .wave(lz, 0.2, 1.1, 0.16, 0.86, 0.25)
                .wave(rz, 0.2, 1.1, 0.16, 0.86, 0.25),
            Programme(98, 3.4)  // arm swings: straight arms fore and aft, against each other, with a bob
                .both({{0.1, reach, 0.1, -0.9, 0.1}, {0.9, reach, 0.1, -0.9, 0.1}, {1, rest}})
                .wave(lz, 0.5, 1.0, 0.1, 0.92)
                .wave(rz, 0.5, 1.0, 0.1, 0.92, 0.5)
                .beat(ly, 0.35, 1.0, 0.1, 0.92)
                .beat(ry, 0.35, 1.0, 0.1, 0.92, 0.5)
                .wave(twist, 14, 1.0, 0.1, 0.92, 0.5)
                .wave(py, 0.03, 2.0, 0.1, 0.92),
            Programme(99, 2.8)  // run on the spot
                .both({{0.08, reach, 0.05, -0.5, 0.35}, {0.92, reach, 0.05, -0.5, 0.35}, {1, rest}})
                .wave(lz, 0.24, 1.9, 0.08, 0.94, 0.5)
                .wave(rz, 0.24, 1.9, 0.08, 0.94)
                .wave(ly, 0.1, 1.9, 0.08, 0.94, 0.5)
                .wave(ry, 0.1, 1.9, 0.08, 0.94)
                .beat(lfy, 0.36, 1.9, 0.06, 0.94)
                .beat(rfy, 0.36, 1.9, 0.06, 0.94, 0.5)
                .beat(lfz, 0.14, 1.9, 0.06, 0.94)
                .beat(rfz, 0.14, 1.9, 0.06, 0.94, 0.5)
                .wave(twist, 9, 1.9, 0.08, 0.94, 0.5)
                .wave(px, 0.025, 1.9, 0.06, 0.94, 0.5)
                .beat(lift, 0.03, 3.8, 0.06, 0.94)
                .move(bend, {{0.08, 7}, {0.92, 7}, {1, 0}})
                .fists(0.9, 0.9),
            Programme(100, 3.0)  // butt kicks: heels up behind, hands at the hips
                .both({{0.1, waist, 0.02, 0, -0.02}, {0.92, waist, 0.02, 0, -0.02}, {1, rest}})
                .beat(lfy, 0.44, 1.5, 0.06, 0.94)
                .beat(rfy, 0.44, 1.5, 0.06, 0.94, 0.5)
                .beat(lfz, -0.36, 1.5, 0.06, 0.94)
                .beat(rfz, -0.36, 1.5, 0.06, 0.94, 0.5)
                .beat(lfp, 60, 1.5, 0.06, 0.94)
                .beat(rfp, 60, 1.5, 0.06, 0.94, 0.5)
                .wave(px, 0.035, 1.5, 0.06, 0.94, 0.5)
                .move(bend, {{0.08, 9}, {0.92, 9}, {1, 0}}),
            Programme(101, 4.0)  // cross toe touch: legs apart, each hand to the other foot
                .hold(lfx, 0.2)
                .hold(rfx, 0.2)
                .both({{0.06, reach, 0.85, 0, 0}})
                .right({{0.14, reach, 0.9, 0.02, 0},
                        {0.34, other_foot, 0, 0.02, 0.0},
                        {0.5, reach, 0.9, 0.02, 0},
                        {0.72, reach, 0.5, 0.85, 0},
                        {0.88, reach, 0.9, 0.02, 0},
                        {1, rest}})
                .left({{0.14, reach, 0.9, 0.02, 0},
                       {0.34, reach, 0.5, 0.85, 0},
                       {0.5, reach, 0.9, 0.02, 0},
                       {0.72, other_foot, 0, 0.02, 0.0},
                       {0.88, reach, 0.9, 0.02, 0},
                       {1, rest}})
                .move(bend, {{0.12, 0}, {0.34, 88}, {0.5, 8}, {0.72, 88}, {0.9, 0}})
                .move(twist, {{0.12, 0}, {0.34, 42}, {0.5, 0}, {0.72, -42}, {0.9, 0}})
                .move(py, {{0.12, 0}, {0.34, -0.08}, {0.5, 0}, {0.72, -0.08}, {0.9, 0}}),
            Programme(102, 2.6)  // side kick: the knee comes up, the leg shoots out sideways
                .move(px, {{0.1, 0}, {0.28, 0.10}, {0.74, 0.10}, {0.95, 0}})
                .move(rfy, {{0.14, 0}, {0.34, 0.45}, {0.5, 0.72}, {0.58, 0.72}, {0.72, 0.4}, {0.92, 0}})
                .move(rfx, {{0.14, 0}, {0.34, 0.05}, {0.5, 0.72}, {0.58, 0.72}, {0.72, 0.1}, {0.92, 0}})
                .move(rfz, {{0.14, 0}, {0.34, 0.15}, {0.5, 0}, {0.72, 0.05}, {0.92, 0}})
                .move(side, {{0.14, 0}, {0.34, -8}, {0.5, -24}, {0.6, -24}, {0.9, 0}})
                .move(roll, {{0.14, 0}, {0.5, -20}, {0.6, -20}, {0.9, 0}})
                .both({{0.2, reach, -0.1, -0.15, 0.45}, {0.82, reach, -0.1, -0.2, 0.45}, {1, rest}})
                .move(turn, {{0.14, 0}, {0.4, -35}, {0.62, -35}, {0.9, 0}})
                .fists(1, 1),
            Programme(103,
                      3.0)  // yawn: one hand before the open mouth, the other arm stretched up, the head back
                .right({{0.25, mouth, 0.02, 0.01, 0.05}, {0.75, mouth, 0.02, 0.01, 0.05}, {1, rest}})
                .left({{0.26, reach, 0.3, 0.15, 0.25},
                       {0.5, reach, 0.35, 0.8, 0.02},
                       {0.66, reach, 0.4, 0.78, 0.0},
                       {1, rest}})
                .move(nod, {{0.2, 0}, {0.5, -24}, {0.68, -24}, {0.9, 0}})
                .move(bend, {{0.2, 0}, {0.5, -11}, {0.68, -11}, {0.95, 0}}),
            Programme(104, 3.4)  // stretch oneself: both arms high and wide, on tiptoe, arched
                .both({{0.14, reach, 0.1, 0.1, 0.3},
                       {0.4, reach, 0.12, 0.98, 0.0},
                       {0.6, reach, 0.25, 0.96, -0.05},
                       {0.8, reach, 0.9, 0.2, -0.15},
                       {1, rest}})
                .move(bend, {{0.2, 0}, {0.45, -14}, {0.65, -14}, {0.9, 0}})
                .move(nod, {{0.2, 0}, {0.45, -18}, {0.65, -18}, {0.9, 0}})
                .move(lift, {{0.3, 0}, {0.48, 0.05}, {0.62, 0.05}, {0.76, 0}})
                .move(lfp, {{0.3, 0}, {0.48, 28}, {0.62, 28}, {0.76, 0}})
                .move(rfp, {{0.3, 0}, {0.48, 28}, {0.62, 28}, {0.76, 0}})
                .wave(side, 8, 0.6, 0.35, 0.8),
            Programme(105, 2.8)  // blow nose: both hands at the nose, short jerks forward
                .both({{0.22, nose, 0.035, -0.03, 0.02}, {0.84, nose, 0.035, -0.03, 0.02}, {1, rest}})
                .move(nod, {{0.2, 0}, {0.3, 20}, {0.8, 20}, {1, 0}})
                .beat(nod, 14, 1.4, 0.28, 0.82)
                .beat(bend, 7, 1.4, 0.28, 0.82)
                .move(bend, {{0.2, 0}, {0.3, 10}, {0.8, 10}, {1, 0}})
                .fists(0.7, 0.7)};
}

}  // namespace

std::vector<Programme> further_programmes() {
    std::vector<Programme> all;
    for (const auto& table : {head_and_sports(), handiwork(), care_and_bags(), fitness()})
        all.insert(all.end(), table.begin(), table.end());
    return all;
}

}  // namespace actformer::ingest::synth
