// Actions 1 to 49: what one person does at home, and at the doctor's. The right hand acts; clips are mirrored
// for the left.
#include "ingest/synth/programmes/ntu.hpp"

namespace actformer::ingest::synth {
namespace {

using enum At;

std::vector<Programme> at_the_table() {
    return {Programme(1, 3.4)  // drink water
                .right({{0.16, reach, 0, -0.6, 0.55},
                        {0.34, mouth, 0.02, -0.03, 0.05},
                        {0.70, mouth, 0.02, -0.01, 0.06},
                        {0.95, rest}})
                .move(nod, {{0.34, 0}, {0.46, -24}, {0.64, -26}, {0.76, 0}})
                .move(relbow, {{0.34, 0}, {0.48, 28}, {0.64, 28}, {0.76, 0}})
                .fists(0.2, 0.8),
            Programme(2, 4.6)  // eat meal: a bowl in the left hand, the right goes to and fro
                .left({{0.1, reach, -0.3, -0.42, 0.5}, {0.92, reach, -0.3, -0.42, 0.5}, {1, rest}})
                .right({{0.1, reach, -0.25, -0.45, 0.62}})
                .right(cycles(4, 0.1, 0.9,
                              {{0.15, reach, -0.25, -0.5, 0.62},
                               {0.5, mouth, 0.01, -0.01, 0.04},
                               {0.68, mouth, 0.01, -0.01, 0.04},
                               {0.98, reach, -0.25, -0.5, 0.62}}))
                .right({{1, rest}})
                .move(nod, {{0.1, 14}, {0.92, 14}, {1, 0}})
                .fists(0.6, 0.7),
            Programme(3, 3.6)  // brush teeth
                .right({{0.18, mouth, 0.09, -0.02, 0.05}, {0.84, mouth, 0.09, -0.02, 0.05}, {1, rest}})
                .wave(rx, 0.05, 2.9, 0.18, 0.84)
                .wave(relbow, 9, 2.9, 0.18, 0.84)
                .move(relbow, {{0.18, 42}, {0.84, 42}, {1, 0}})
                .move(nod, {{0.2, 8}, {0.84, 8}, {1, 0}})
                .fists(0.2, 0.9),
            Programme(4, 3.6)  // brush hair
                .right({{0.15, crown, 0.02, 0.03, 0.07}})
                .right(cycles(4, 0.15, 0.88,
                              {{0.1, crown, 0.02, 0.04, 0.07},
                               {0.6, nape, 0.1, 0.06, 0.0},
                               {0.75, nape, 0.14, 0.08, 0.03},
                               {0.98, crown, 0.02, 0.06, 0.08}}))
                .right({{1, rest}})
                .move(relbow, {{0.15, 25}, {0.88, 25}, {1, 0}})
                .move(tilt, {{0.2, -10}, {0.85, -10}, {1, 0}})
                .fists(0.2, 0.8),
            Programme(5, 2.4)  // drop
                .right({{0, reach, -0.1, -0.42, 0.62},
                        {0.35, reach, -0.1, -0.38, 0.7},
                        {0.6, reach, -0.1, -0.4, 0.72},
                        {0.95, rest}})
                .move(rgrip, {{0, 0.9}, {0.36, 0.9}, {0.42, 0}})
                .move(rroll, {{0.3, 0}, {0.4, 60}, {0.6, 60}, {0.8, 0}})
                .move(nod, {{0.36, 8}, {0.5, 36}, {0.75, 36}, {1, 8}})
                .move(bend, {{0.36, 0}, {0.5, 10}, {0.75, 10}, {1, 0}}),
            Programme(6, 3.0)  // pick up
                .right({{0.42, floor, 0, 0.03, 0.05},
                        {0.52, floor, 0, 0.03, 0.05},
                        {0.85, reach, 0, -0.55, 0.5},
                        {1, reach, 0, -0.6, 0.45}})
                .left({{0.4, knee, 0.02, 0.02, 0.02}, {0.55, knee, 0.02, 0.02, 0.02}, {0.9, rest}})
                .move(bend, {{0.05, 0}, {0.42, 82}, {0.52, 82}, {0.88, 0}})
                .move(py, {{0.05, 0}, {0.42, -0.26}, {0.52, -0.26}, {0.88, 0}})
                .move(nod, {{0.3, -18}, {0.6, -18}, {0.9, 0}})
                .move(rgrip, {{0.44, 0}, {0.52, 0.9}, {1, 0.9}}),
            Programme(7, 2.4)  // throw, overarm
                .right({{0.12, reach, -0.1, -0.5, 0.5},
                        {0.40, reach, 0.45, 0.62, -0.42},
                        {0.56, reach, -0.1, 0.55, 0.85},
                        {0.70, reach, -0.55, -0.5, 0.6},
                        {1, rest}})
                .left({{0.4, reach, 0.1, -0.1, 0.8}, {0.6, reach, 0.3, -0.8, 0.1}, {1, rest}})
                .move(twist, {{0.12, 0}, {0.40, -32}, {0.58, 24}, {0.7, 26}, {1, 0}})
                .move(bend, {{0.2, 0}, {0.4, -10}, {0.6, 18}, {0.75, 16}, {1, 0}})
                .move(pz, {{0.2, 0}, {0.4, -0.08}, {0.6, 0.12}, {1, 0.02}})
                .move(lfz, {{0.25, 0}, {0.45, 0.28}, {0.8, 0.28}, {1, 0.28}})
                .move(lfy, {{0.25, 0}, {0.34, 0.08}, {0.45, 0}})
                .move(rgrip, {{0.1, 0.9}, {0.52, 0.9}, {0.57, 0}})};
}

std::vector<Programme> seats_and_papers() {
    return {
        Programme(8, 2.6)  // sit down
            .move(py, {{0.15, 0}, {0.72, -0.42}})
            .move(pz, {{0.15, 0}, {0.72, -0.42}})
            .move(bend, {{0.1, 0}, {0.42, 42}, {0.85, 4}})
            .move(nod, {{0.1, 0}, {0.4, -18}, {0.8, 0}})
            .both({{0.1, rest}, {0.45, reach, 0.1, -0.75, 0.45}, {0.82, thigh}, {1, thigh}}),
        Programme(9, 2.5)  // stand up
            .both({{0, thigh}, {0.15, thigh, 0, 0, 0.05}, {0.45, reach, 0.05, -0.72, 0.45}, {0.85, rest}})
            .move(py, {{0, -0.42}, {0.25, -0.42}, {0.82, 0}})
            .move(pz, {{0, -0.42}, {0.2, -0.42}, {0.75, 0}})
            .move(bend, {{0, 4}, {0.1, 4}, {0.38, 46}, {0.82, 0}})
            .move(nod, {{0.1, 0}, {0.4, -20}, {0.8, 0}}),
        Programme(10, 3.0)  // clapping
            .both({{0.14, reach, -0.18, -0.32, 0.55}, {0.86, reach, -0.18, -0.32, 0.55}, {1, rest}})
            .wave(lx, 0.075, 2.6, 0.13, 0.87)
            .wave(rx, 0.075, 2.6, 0.13, 0.87),
        Programme(11, 4.0)  // reading: a book in both hands, a page is turned
            .left({{0.12, reach, -0.12, -0.34, 0.56}, {0.9, reach, -0.12, -0.34, 0.56}, {1, rest}})
            .right({{0.12, reach, -0.12, -0.34, 0.56},
                    {0.5, reach, -0.12, -0.34, 0.56},
                    {0.58, reach, -0.2, -0.26, 0.6},
                    {0.68, reach, -0.55, -0.3, 0.58},
                    {0.8, reach, -0.12, -0.34, 0.56},
                    {0.9, reach, -0.12, -0.34, 0.56},
                    {1, rest}})
            .move(nod, {{0.12, 26}, {0.9, 26}, {1, 0}})
            .wave(turn, 7, 0.5, 0.12, 0.9)
            .hold(lroll, -40)
            .hold(rroll, -40),
        Programme(12, 4.0)  // writing, seated
            .seated()
            .left({{0.15, reach, -0.3, -0.66, 0.55}, {1, reach, -0.3, -0.66, 0.55}})
            .right({{0.15, reach, -0.2, -0.66, 0.6}, {0.9, reach, -0.05, -0.66, 0.6}})
            .wave(rz, 0.02, 2.6, 0.16, 0.95)
            .wave(rx, 0.03, 1.1, 0.16, 0.95)
            .move(bend, {{0.1, 22}})
            .move(nod, {{0.12, 26}})
            .fists(0.1, 0.8),
        Programme(13, 3.0)  // tear up paper
            .both({{0.14, reach, -0.2, -0.42, 0.52}})
            .left(cycles(2, 0.16, 0.86,
                         {{0.2, reach, -0.25, -0.4, 0.5},
                          {0.6, reach, 0.12, -0.5, 0.42},
                          {0.95, reach, -0.25, -0.4, 0.5}}))
            .right(cycles(2, 0.16, 0.86,
                          {{0.2, reach, -0.25, -0.4, 0.5},
                           {0.6, reach, 0.16, -0.26, 0.52},
                           {0.95, reach, -0.25, -0.4, 0.5}}))
            .both({{1, rest}})
            .move(nod, {{0.12, 20}, {0.86, 20}, {1, 0}})
            .fists(0.9, 0.9),
        Programme(14, 4.6)  // put on jacket: one sleeve, over the back, the other sleeve, pull together
            .right({{0.10, reach, -0.1, -0.3, 0.6},
                    {0.26, reach, 0.75, -0.3, 0.2},
                    {0.36, shoulder, 0, -0.02, 0.04},
                    {0.52, nape, 0.05, 0, 0.02},
                    {0.64, reach, 0.2, -0.5, 0.3},
                    {0.8, chest, 0.08, 0, 0.02},
                    {0.9, belly, 0.05, 0, 0.02},
                    {1, rest}})
            .left({{0.10, reach, 0, -0.5, 0.5},
                   {0.3, reach, -0.45, -0.1, 0.45},
                   {0.40, reach, 0.3, -0.6, -0.3},
                   {0.56, reach, 0.65, -0.55, -0.42},
                   {0.70, reach, 0.75, -0.2, 0.3},
                   {0.8, chest, 0.08, 0, 0.02},
                   {0.9, belly, 0.05, 0, 0.02},
                   {1, rest}})
            .move(twist, {{0.1, 0}, {0.3, -18}, {0.52, 24}, {0.72, 0}})
            .move(nod, {{0.7, 0}, {0.8, 18}, {0.95, 0}}),
        Programme(15, 4.2)  // take off jacket: open at the chest, off both shoulders, arms drawn out behind
            .both({{0.10, belly, 0.04, 0, 0.03},
                   {0.20, chest, 0.06, 0, 0.03},
                   {0.32, reach, 0.28, -0.1, 0.3},
                   {0.46, reach, 0.34, -0.78, -0.32},
                   {0.56, low_back, 0.02, -0.08, -0.06}})
            .right({{0.70, reach, 0.3, -0.6, 0.4}, {0.84, reach, -0.2, -0.5, 0.6}, {1, rest}})
            .left({{0.64, low_back, 0, -0.08, -0.06}, {0.84, reach, -0.2, -0.5, 0.6}, {1, rest}})
            .move(bend, {{0.2, 0}, {0.34, -8}, {0.5, 14}, {0.8, 0}})
            .move(twist, {{0.46, 0}, {0.6, -22}, {0.75, 16}, {0.95, 0}})};
}

std::vector<Programme> dressing() {
    return {
        Programme(16, 4.0)  // put on a shoe, seated: the foot comes up, the hands pull the heel on
            .seated()
            .move(rfy, {{0.1, 0}, {0.3, 0.22}, {0.75, 0.22}, {0.95, 0}})
            .move(rfz, {{0.1, 0}, {0.3, -0.06}, {0.75, -0.06}, {0.95, 0}})
            .move(rfp, {{0.15, 0}, {0.3, 25}, {0.75, 25}, {0.95, 0}})
            .right({{0.12, thigh},
                    {0.34, foot, 0.05, 0, 0.06},
                    {0.55, foot, 0.05, 0.06, -0.1},
                    {0.74, foot, 0.05, 0.16, -0.13},
                    {0.92, thigh}})
            .left({{0.12, thigh},
                   {0.34, other_foot, 0, 0.02, 0.08},
                   {0.55, other_foot, 0, 0.06, 0.03},
                   {0.74, other_foot, 0, 0.14, -0.02},
                   {0.92, thigh}})
            .move(bend, {{0.1, 6}, {0.34, 60}, {0.72, 56}, {0.95, 6}})
            .wave(ry, 0.02, 2.2, 0.5, 0.75),
        Programme(17, 3.6)  // take off a shoe, standing on one leg, a hand at the heel
            .move(px, {{0.08, 0}, {0.25, 0.09}, {0.8, 0.09}, {1, 0}})
            .move(rfy, {{0.1, 0}, {0.35, 0.42}, {0.72, 0.42}, {0.95, 0}})
            .move(rfz, {{0.1, 0}, {0.35, 0.22}, {0.72, 0.22}, {0.95, 0}})
            .move(rfx, {{0.1, 0}, {0.35, -0.1}, {0.72, -0.1}, {0.95, 0}})
            .move(rfp, {{0.1, 0}, {0.35, 15}, {0.72, 35}, {0.95, 0}})
            .right({{0.36, foot, 0.03, -0.02, -0.12},
                    {0.52, foot, 0.03, -0.04, -0.08},
                    {0.72, foot, 0.08, -0.06, 0.12},
                    {0.95, rest}})
            .left({{0.36, other_foot, 0.02, 0.02, 0.02}, {0.6, other_foot, 0.02, 0.02, 0.06}, {0.9, rest}})
            .move(bend, {{0.08, 0}, {0.36, 52}, {0.72, 50}, {0.95, 0}})
            .move(py, {{0.1, 0}, {0.35, -0.12}, {0.72, -0.12}, {0.95, 0}}),
        Programme(18, 2.8)  // put on glasses
            .both({{0.15, belly, 0.05, 0.05, 0.12},
                   {0.3, chest, 0.06, 0.05, 0.16},
                   {0.52, eye, 0.06, 0, 0.05},
                   {0.66, ear, 0.03, 0, 0.03},
                   {0.74, ear, 0.03, 0, 0.02},
                   {1, rest}})
            .move(nod, {{0.15, 18}, {0.35, 14}, {0.6, 4}, {1, 0}})
            .fists(0.7, 0.7),
        Programme(19, 2.8)  // take off glasses
            .both({{0.24, ear, 0.03, 0, 0.02},
                   {0.34, ear, 0.03, 0, 0.03},
                   {0.5, eye, 0.06, -0.02, 0.14},
                   {0.68, chest, 0.05, 0, 0.18},
                   {0.82, belly, 0.03, 0.03, 0.12},
                   {1, rest}})
            .move(nod, {{0.3, 0}, {0.6, 16}, {0.85, 20}, {1, 0}})
            .fists(0.7, 0.7),
        Programme(20, 2.8)  // put on a hat, both hands
            .both({{0.14, belly, 0.1, 0.1, 0.12},
                   {0.4, crown, 0.12, 0.14, 0.06},
                   {0.55, crown, 0.12, 0.0, 0.03},
                   {0.7, crown, 0.12, -0.03, 0.03},
                   {1, rest}})
            .move(nod, {{0.15, 12}, {0.45, 8}, {0.6, 8}, {0.8, 0}})
            .fists(0.8, 0.8),
        Programme(21, 2.6)  // take off a hat, one hand, down to the waist
            .right({{0.3, crown, 0.05, 0.02, 0.09},
                    {0.4, crown, 0.05, 0.02, 0.09},
                    {0.55, crown, 0.16, 0.16, 0.16},
                    {0.78, reach, 0.05, -0.62, 0.4},
                    {1, reach, 0, -0.75, 0.3}})
            .move(nod, {{0.2, 0}, {0.35, 14}, {0.55, 0}})
            .fists(0.2, 0.8),
        Programme(22, 2.8)  // cheer up: fists up and pumping
            .both({{0.15, reach, 0.1, -0.3, 0.4},
                   {0.3, reach, 0.25, 0.85, 0.15},
                   {0.82, reach, 0.25, 0.85, 0.15},
                   {1, rest}})
            .wave(ly, 0.10, 1.7, 0.28, 0.85)
            .wave(ry, 0.10, 1.7, 0.28, 0.85)
            .wave(py, 0.03, 1.7, 0.25, 0.85)
            .move(nod, {{0.2, 0}, {0.35, -14}, {0.8, -14}, {1, 0}})
            .fists(1, 1),
        Programme(23, 3.0)  // hand waving, beside the head
            .right({{0.18, reach, 0.22, 0.45, 0.38}, {0.84, reach, 0.22, 0.45, 0.38}, {1, rest}})
            .wave(rx, 0.14, 1.9, 0.18, 0.84)
            .hold(rroll, -60),
        Programme(24, 2.4)  // kicking something, low, as a ball
            .move(rfz, {{0.15, 0}, {0.38, -0.38}, {0.54, 0.48}, {0.65, 0.46}, {0.92, 0}})
            .move(rfy, {{0.15, 0}, {0.38, 0.2}, {0.49, 0.04}, {0.58, 0.26}, {0.75, 0.14}, {0.92, 0}})
            .move(rfp, {{0.15, 0}, {0.38, 40}, {0.55, 15}, {0.92, 0}})
            .move(px, {{0.1, 0}, {0.25, 0.06}, {0.75, 0.06}, {0.95, 0}})
            .move(bend, {{0.2, 0}, {0.38, 8}, {0.55, -8}, {0.8, 0}})
            .move(nod, {{0.1, 0}, {0.3, 22}, {0.6, 20}, {0.9, 0}})
            .left({{0.38, reach, 0.3, -0.75, 0.45}, {0.56, reach, 0.3, -0.8, -0.3}, {0.95, rest}})
            .right({{0.38, reach, 0.3, -0.8, -0.3}, {0.56, reach, 0.3, -0.75, 0.45}, {0.95, rest}})};
}

std::vector<Programme> around_the_house() {
    return {Programme(25, 2.6)  // reach into pocket
                .right({{0.18, waist, 0.03, 0, 0.06},
                        {0.36, pocket, 0, -0.04, 0.02},
                        {0.68, pocket, 0, -0.06, 0.02},
                        {0.82, waist, 0.02, 0, 0.06},
                        {1, rest}})
                .wave(ry, 0.02, 2.0, 0.36, 0.7)
                .move(relbow, {{0.15, 0}, {0.3, 30}, {0.7, 30}, {0.9, 0}})
                .move(side, {{0.2, 0}, {0.4, 9}, {0.7, 9}, {0.95, 0}})
                .move(nod, {{0.2, 0}, {0.35, 24}, {0.7, 24}, {0.9, 0}})
                .move(tilt, {{0.2, 0}, {0.35, 10}, {0.7, 10}, {0.9, 0}}),
            Programme(26, 3.0)  // hopping on one leg
                .move(px, {{0.0, 0}, {0.12, -0.08}, {0.9, -0.08}, {1, 0}})
                .move(lfy, {{0.02, 0}, {0.14, 0.3}, {0.88, 0.3}, {1, 0}})
                .move(lfz, {{0.02, 0}, {0.14, -0.22}, {0.88, -0.22}, {1, 0}})
                .move(lfp, {{0.02, 0}, {0.14, 40}, {0.88, 40}, {1, 0}})
                .beat(lift, 0.16, 1.7, 0.16, 0.86)
                .beat(py, -0.08, 1.7, 0.16, 0.86, 0.5)
                .both({{0.12, reach, 0.4, -0.55, 0.3}, {0.88, reach, 0.4, -0.55, 0.3}, {1, rest}})
                .wave(ly, 0.06, 1.7, 0.16, 0.86, 0.5)
                .wave(ry, 0.06, 1.7, 0.16, 0.86, 0.5),
            Programme(27, 2.4)  // jump up, two feet, arms thrown up
                .move(py, {{0.1, 0}, {0.36, -0.28}, {0.46, 0.06}, {0.6, 0.05}, {0.70, -0.2}, {0.95, 0}})
                .move(lift, {{0.43, 0}, {0.54, 0.38}, {0.65, 0}})
                .move(bend, {{0.1, 0}, {0.36, 38}, {0.48, -4}, {0.62, 4}, {0.72, 24}, {0.95, 0}})
                .both({{0.12, rest},
                       {0.36, reach, 0.12, -0.75, -0.5},
                       {0.5, reach, 0.12, 0.9, 0.25},
                       {0.62, reach, 0.2, 0.4, 0.5},
                       {0.76, reach, 0.2, -0.7, 0.4},
                       {1, rest}})
                .move(lfp, {{0.4, 0}, {0.5, 45}, {0.62, 20}, {0.66, 0}})
                .move(rfp, {{0.4, 0}, {0.5, 45}, {0.62, 20}, {0.66, 0}}),
            Programme(28, 3.6)  // phone call
                .right({{0.1, pocket, 0, 0, 0.05},
                        {0.32, ear, 0.04, -0.01, 0.01},
                        {0.9, ear, 0.04, -0.01, 0.01},
                        {1, reach, 0.1, -0.5, 0.4}})
                .move(tilt, {{0.25, 0}, {0.35, 10}, {0.9, 10}, {1, 0}})
                .wave(yaw, 5, 0.3, 0.3, 0.95)
                .wave(nod, 4, 0.8, 0.35, 0.9)
                .fists(0.2, 0.9),
            Programme(29, 3.8)  // play with phone: close before the chest, the thumb at work
                .right({{0.12, reach, -0.2, -0.30, 0.45}, {0.92, reach, -0.2, -0.30, 0.45}, {1, rest}})
                .left({{0.2, reach, -0.33, -0.36, 0.44}, {0.92, reach, -0.33, -0.36, 0.44}, {1, rest}})
                .beat(lx, 0.05, 1.5, 0.22, 0.9)
                .wave(ly, 0.025, 2.3, 0.22, 0.9)
                .move(nod, {{0.12, 34}, {0.92, 34}, {1, 0}})
                .fists(0.3, 0.7),
            Programme(30, 3.6)  // type on a keyboard, seated
                .seated()
                .both({{0.15, reach, -0.12, -0.62, 0.58}, {1, reach, -0.12, -0.62, 0.58}})
                .wave(ly, 0.022, 3.3, 0.15, 1)
                .wave(ry, 0.022, 3.3, 0.15, 1, 0.5)
                .wave(lx, 0.03, 0.9, 0.15, 1)
                .wave(rx, 0.03, 0.7, 0.15, 1, 0.3)
                .move(bend, {{0.1, 3}})
                .move(nod, {{0.15, 10}}),
            Programme(31, 2.6)  // point to something
                .right({{0.34, reach, 0.42, 0.12, 0.88}, {0.72, reach, 0.42, 0.12, 0.88}, {1, rest}})
                .move(turn, {{0.15, 0}, {0.34, -22}, {0.72, -22}, {0.95, 0}})
                .move(twist, {{0.15, 0}, {0.34, -12}, {0.72, -12}, {0.95, 0}}),
            Programme(32, 3.0)  // taking a selfie: high, at arm's length, the head to one side
                .right({{0.28, reach, 0.12, 0.42, 0.88}, {0.84, reach, 0.12, 0.42, 0.88}, {1, rest}})
                .move(tilt, {{0.25, 0}, {0.4, -15}, {0.82, -15}, {1, 0}})
                .move(nod, {{0.2, 0}, {0.35, -14}, {0.82, -14}, {1, 0}})
                .move(bend, {{0.2, 0}, {0.35, -7}, {0.82, -7}, {1, 0}})
                .left({{0.45, reach, 0.2, 0.0, 0.35}, {0.82, reach, 0.2, 0.0, 0.35}, {1, rest}})
                .fists(0.3, 0.9),
            Programme(
                33, 2.6)  // check time from watch: the left forearm comes level, the right hand to its wrist
                .left({{0.3, reach, -0.42, -0.22, 0.46}, {0.75, reach, -0.42, -0.22, 0.46}, {1, rest}})
                .right({{0.4, reach, -0.05, -0.34, 0.44}, {0.72, reach, -0.05, -0.34, 0.44}, {0.95, rest}})
                .move(lelbow, {{0.15, 0}, {0.3, 45}, {0.75, 45}, {0.95, 0}})
                .move(nod, {{0.2, 0}, {0.35, 30}, {0.75, 30}, {0.95, 0}})
                .move(turn, {{0.2, 0}, {0.35, 14}, {0.75, 14}, {0.95, 0}}),
            Programme(34, 3.0)  // rub two hands
                .both({{0.14, reach, -0.26, -0.45, 0.5}, {0.86, reach, -0.26, -0.45, 0.5}, {1, rest}})
                .wave(lz, 0.055, 2.6, 0.14, 0.86)
                .wave(rz, 0.055, 2.6, 0.14, 0.86, 0.5)
                .wave(ly, 0.03, 2.6, 0.14, 0.86)
                .wave(ry, 0.03, 2.6, 0.14, 0.86, 0.5),
            Programme(35, 2.8)  // nod head or bow
                .move(nod, {{0.1, 0}, {0.35, 30}, {0.6, 30}, {0.85, 0}})
                .move(bend, {{0.1, 0}, {0.4, 42}, {0.6, 42}, {0.9, 0}})
                .both({{0.12, rest},
                       {0.4, thigh, -0.02, 0.03, 0.02},
                       {0.6, thigh, -0.02, 0.03, 0.02},
                       {0.9, rest}}),
            Programme(36, 2.8)  // shake head
                .wave(turn, 36, 1.25, 0.12, 0.88)
                .wave(twist, 6, 1.25, 0.12, 0.88)
                .wave(yaw, 4, 1.25, 0.12, 0.88)
                .move(nod, {{0.1, 0}, {0.2, 8}, {0.85, 8}, {1, 0}})};
}

std::vector<Programme> gestures() {
    return {
        Programme(37, 2.8)  // wipe face
            .right({{0.2, brow, 0.05, 0.02, 0.02}})
            .right(cycles(2, 0.2, 0.82,
                          {{0.1, brow, 0.06, 0.03, 0.02},
                           {0.45, brow, -0.07, 0.01, 0.02},
                           {0.75, mouth, 0.05, 0.01, 0.03},
                           {0.95, brow, 0.06, 0.02, 0.02}}))
            .right({{1, rest}})
            .move(nod, {{0.2, 12}, {0.8, 12}, {1, 0}})
            .move(relbow, {{0.2, 25}, {0.8, 25}, {1, 0}}),
        Programme(38, 2.4)  // salute
            .right({{0.32, brow, 0.11, 0.03, 0.0}, {0.7, brow, 0.11, 0.03, 0.0}, {0.92, rest}})
            .move(relbow, {{0.1, 0}, {0.32, 62}, {0.7, 62}, {0.9, 0}})
            .move(bend, {{0.1, 0}, {0.3, -6}, {0.7, -6}, {0.9, 0}}),
        Programme(39, 3.0)  // put palms together before the chest, head low
            .both({{0.25, chest, 0.025, 0, 0.12}, {0.78, chest, 0.025, 0, 0.12}, {1, rest}})
            .move(nod, {{0.25, 0}, {0.45, 22}, {0.7, 22}, {0.9, 0}})
            .move(bend, {{0.25, 0}, {0.45, 14}, {0.7, 14}, {0.9, 0}})
            .move(lelbow, {{0.1, 0}, {0.3, 25}, {0.75, 25}, {1, 0}})
            .move(relbow, {{0.1, 0}, {0.3, 25}, {0.75, 25}, {1, 0}})
            .move(lflex, {{0.25, -45}, {0.78, -45}, {1, 0}})
            .move(rflex, {{0.25, -45}, {0.78, -45}, {1, 0}}),
        Programme(40, 3.0)  // cross hands in front, to say stop: out and over each other
            .both({{0.18, reach, 0.25, -0.05, 0.75},
                   {0.34, reach, -0.5, 0.0, 0.72},
                   {0.5, reach, 0.3, -0.05, 0.75},
                   {0.66, reach, -0.5, 0.0, 0.72},
                   {0.82, reach, -0.5, 0, 0.72},
                   {1, rest}})
            .hold(lroll, 40)
            .hold(rroll, 40),
        Programme(41, 2.6)  // sneeze or cough
            .right({{0.26, mouth, 0.02, -0.01, 0.02}, {0.82, mouth, 0.02, -0.01, 0.02}, {1, rest}})
            .move(bend, {{0.2, 0}, {0.34, -6}, {0.42, 26}, {0.52, 10}, {0.6, 28}, {0.75, 12}, {0.95, 0}})
            .move(nod, {{0.2, 0}, {0.34, -10}, {0.42, 30}, {0.52, 10}, {0.6, 30}, {0.75, 14}, {0.95, 0}})
            .move(relbow, {{0.2, 0}, {0.3, 12}, {0.8, 12}, {1, 0}})
            .fists(0.3, 0.8),
        Programme(42, 3.6)  // staggering: steps to all sides, the trunk lags behind
            .move(wx, {{0.05, 0}, {0.28, 0.38}, {0.52, -0.2}, {0.75, 0.3}, {0.95, 0.1}})
            .move(wz, {{0.05, 0}, {0.28, 0.15}, {0.52, 0.38}, {0.75, 0.5}, {0.95, 0.7}})
            .move(wyaw, {{0.05, 0}, {0.3, 20}, {0.55, -25}, {0.8, 15}, {1, 0}})
            .wave(side, 17, 0.62, 0.05, 1)
            .wave(bend, 12, 0.8, 0.05, 1, 0.2)
            .wave(tilt, 12, 0.62, 0.05, 1, 0.15)
            .move(nod, {{0.1, 14}, {0.9, 14}, {1, 0}})
            .both({{0.15, reach, 0.5, -0.6, 0.3}, {0.9, reach, 0.5, -0.6, 0.3}, {1, rest}})
            .wave(ly, 0.14, 0.75, 0.1, 0.95)
            .wave(ry, 0.14, 0.75, 0.1, 0.95, 0.45),
        Programme(43, 2.8).fall(0.15, 0.72),  // falling down
        Programme(44, 3.4)                    // headache: both hands to the temples, swaying
            .both({{0.22, ear, 0.01, 0.06, 0.05}, {0.85, ear, 0.01, 0.06, 0.05}, {1, rest}})
            .move(nod, {{0.2, 0}, {0.35, 24}, {0.82, 24}, {1, 0}})
            .wave(tilt, 9, 0.8, 0.25, 0.88)
            .wave(turn, 8, 0.6, 0.25, 0.88)
            .move(bend, {{0.2, 0}, {0.4, 14}, {0.82, 14}, {1, 0}}),
        Programme(45, 3.2)  // chest pain: a hand clutched to the heart, shrinking together
            .right({{0.2, chest, -0.07, 0, 0.0}, {0.85, chest, -0.07, 0, 0.0}, {1, rest}})
            .left({{0.4, rest}, {0.5, chest, 0.06, -0.05, 0.01}, {0.85, chest, 0.06, -0.05, 0.01}, {1, rest}})
            .move(bend, {{0.18, 0}, {0.4, 26}, {0.55, 18}, {0.7, 30}, {1, 8}})
            .move(nod, {{0.18, 0}, {0.4, 12}, {0.8, 14}, {1, 0}})
            .move(py, {{0.2, 0}, {0.45, -0.07}, {0.85, -0.08}, {1, 0}})
            .fists(0.9, 0.9),
        Programme(46, 3.2)  // back pain: hands to the loins, leaning back
            .both({{0.28, low_back, 0.05, -0.02, -0.02}, {0.85, low_back, 0.05, -0.02, -0.02}, {1, rest}})
            .move(bend, {{0.25, 10}, {0.48, -16}, {0.65, -10}, {0.8, -18}, {1, 0}})
            .move(pz, {{0.25, 0}, {0.48, 0.05}, {0.8, 0.05}, {1, 0}})
            .wave(twist, 8, 0.6, 0.4, 0.88)
            .move(nod, {{0.3, 0}, {0.5, -16}, {0.8, -16}, {1, 0}}),
        Programme(47, 3.2)  // neck pain: a hand on the nape, the head rolls
            .right({{0.26, nape, 0.03, 0.01, 0.0}, {0.86, nape, 0.03, 0.01, 0.0}, {1, rest}})
            .wave(tilt, 17, 0.65, 0.28, 0.88)
            .wave(turn, 12, 0.65, 0.28, 0.88, 0.25)
            .move(relbow, {{0.1, 0}, {0.26, 32}, {0.84, 32}, {1, 0}})
            .move(nod, {{0.2, 0}, {0.35, 18}, {0.84, 14}, {1, 0}}),
        Programme(48, 3.2)  // nausea or vomiting: bent low, hands on the belly
            .both({{0.2, belly, 0.05, 0, 0.0}, {0.85, belly, 0.05, 0, 0.0}, {1, rest}})
            .move(bend, {{0.12, 0}, {0.35, 48}, {0.45, 60}, {0.55, 46}, {0.65, 62}, {0.8, 44}, {1, 8}})
            .move(nod, {{0.12, 0}, {0.35, 10}, {0.45, 24}, {0.55, 6}, {0.65, 24}, {0.85, 8}, {1, 0}})
            .move(py, {{0.12, 0}, {0.4, -0.12}, {0.8, -0.12}, {1, 0}}),
        Programme(49, 3.2)  // fan self
            .right({{0.18, reach, -0.1, 0.02, 0.42}, {0.86, reach, -0.1, 0.02, 0.42}, {1, rest}})
            .wave(rz, 0.06, 2.7, 0.18, 0.86)
            .wave(rflex, 35, 2.7, 0.18, 0.86)
            .wave(rx, 0.05, 2.7, 0.18, 0.86, 0.2)
            .move(nod, {{0.2, -10}, {0.85, -10}, {1, 0}})};
}

}  // namespace

std::vector<Programme> daily_programmes() {
    std::vector<Programme> all;
    for (const auto& table : {at_the_table(), seats_and_papers(), dressing(), around_the_house(), gestures()})
        all.insert(all.end(), table.begin(), table.end());
    return all;
}

}  // namespace actformer::ingest::synth
