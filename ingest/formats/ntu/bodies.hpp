// Which of the bodies that a file shows are the persons of the clip. The Kinect takes chairs and tables for bodies too.
#pragma once

#include <vector>

#include "ingest/formats/ntu/skeleton_file.hpp"

namespace actformer::ingest {

enum class BodyRule {
    frames,  ///< those seen in most frames, as ActFormer's published tools choose
    motion   ///< those that move most, as NTU RGB+D's authors recommend (Shahroudy et al. 2016)
};

/// How much a body moves: the variance of its joints' positions over the frames that show it, in square metres, summed over joints and
/// axes.
double motion_of(const Body& body);

/// True where no number changes over the frames that show the body.
bool stands_still(const Body& body);

/// Indices of the `persons` bodies that the rule prefers, the best first; all where there are fewer. Ties go to the body that appears
/// first. By motion, a body seen in fewer than `fleeting` frames comes after all others: noise of a few frames varies most.
std::vector<std::size_t> preferred(const std::vector<Body>& bodies, std::size_t persons, BodyRule rule);

constexpr std::size_t fleeting = 12;

}  // namespace actformer::ingest
