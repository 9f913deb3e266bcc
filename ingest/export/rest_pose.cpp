#include "ingest/export/rest_pose.hpp"

#include <algorithm>

#include "ingest/dataset/known_topologies.hpp"

namespace actformer::ingest {
namespace {

constexpr Point none{0, 0, 0}, up{0, 1, 0}, down{0, -1, 0}, left{1, 0, 0}, right{-1, 0, 0};
constexpr Point left_hip{1, -0.7, 0}, right_hip{-1, -0.7, 0}, toes{0, -0.3, 1};
constexpr Point left_thumb{0.6, 0, 0.8}, right_thumb{-0.6, 0, 0.8};
constexpr Point left_collar{0.8, 0.6, 0}, right_collar{-0.8, 0.6, 0};

struct Known {
    std::vector<int> parents;
    std::vector<Point> pose;
};

const std::vector<Known>& known() {
    static const std::vector<Known> poses{
        // NTU RGB+D, limbs as ntu25()
        {{ntu25_parents.begin(), ntu25_parents.end()},
         {none, up,   up,   up,        left, left, left, left, right, right,      right, right,      left_hip,
          down, down, toes, right_hip, down, down, toes, up,   left,  left_thumb, right, right_thumb}},
        // SMPL
        {{smpl24_parents.begin(), smpl24_parents.end()},
         {none, left_hip,    right_hip,    up, down, down,  up,   down,  down, up,    toes, toes,
          up,   left_collar, right_collar, up, left, right, left, right, left, right, left, right}},
        // GTA Combat
        {{gta22_parents.begin(), gta22_parents.end()},
         {none, up, up, right, right, right,     right, left, left,     left, left,
          up,   up, up, up,    up,    right_hip, down,  down, left_hip, down, down}}};
    return poses;
}

}  // namespace

std::vector<Point> t_pose(const Topology& topology) {
    const auto found = std::ranges::find(known(), topology.parents, &Known::parents);
    return found == known().end() ? std::vector<Point>{} : found->pose;
}

}  // namespace actformer::ingest
