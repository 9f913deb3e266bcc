#include "model/generators/action2motion/chains.hpp"

#include <utility>

namespace actformer::model::action2motion {
namespace {

using Direction = std::array<float, 3>;

constexpr Direction none{}, right{1, 0, 0}, left{-1, 0, 0}, up{0, 1, 0}, down{0, -1, 0}, front{0, 0, 1},
    back{0, 0, -1};

Chains chains(std::vector<std::vector<int>> joints, std::vector<Direction> directions) {
    Chains out{std::move(joints), std::move(directions), {}};
    out.parents.assign(out.directions.size(), -1);
    for (const auto& chain : out.joints)
        for (std::size_t i = 1; i < chain.size(); ++i)
            out.parents[static_cast<std::size_t>(chain[i])] = chain[i - 1];
    return out;
}

/// SMPL's as published.
Chains smpl() {
    return chains({{0, 1, 4, 7, 10},
                   {0, 2, 5, 8, 11},
                   {0, 3, 6, 9, 12, 15},
                   {9, 13, 16, 18, 20, 22},
                   {9, 14, 17, 19, 21, 23}},
                  {none, right, left, up,    down, down, up,   down, down, up,   front, front,
                   up,   right, left, front, down, down, down, down, down, down, down,  down});
}

/// NTU-13's as published.
Chains ntu13() {
    return chains(
        {{0, 12, 13, 14, 15}, {0, 9, 10, 11, 16}, {0, 1, 8, 17}, {1, 5, 6, 7}, {1, 2, 3, 4}},
        {none, down, down, left, back, down, down, back, down, up, up, up, up, up, up, up, up, down});
}

/// NTU RGB+D's: ours, for nobody published any.
Chains ntu() {
    std::vector<Direction> directions(25, up);
    directions[0] = none;
    return chains({{0, 1, 20, 2, 3},
                   {20, 4, 5, 6, 7, 21},
                   {7, 22},
                   {20, 8, 9, 10, 11, 23},
                   {11, 24},
                   {0, 12, 13, 14, 15},
                   {0, 16, 17, 18, 19}},
                  std::move(directions));
}

}  // namespace

std::optional<Chains> chains_of(const std::vector<int>& parents) {
    static const std::vector<Chains> known{ntu(), smpl(), ntu13()};
    for (const auto& one : known)
        if (one.parents == parents) return one;
    return std::nullopt;
}

}  // namespace actformer::model::action2motion
