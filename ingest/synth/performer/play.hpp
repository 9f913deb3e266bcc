// A programme played once by persons of given bodies, on the stage, before any camera sees them.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "ingest/synth/performer/pose.hpp"
#include "ingest/synth/performer/programme.hpp"
#include "ingest/synth/random.hpp"

namespace actformer::ingest::synth {

struct Performer {
    Body body;
    std::uint64_t habits = 0;  ///< tells the bearings of two performers apart
};

/// What makes a performance the one it is.
struct Casting {
    std::vector<std::uint64_t> key;  ///< of its random numbers
    std::vector<Performer> cast;     ///< as many as the programme has persons

    /// Numbers for one purpose: 1 and from 10 on are the play's own.
    Random stream(std::uint64_t purpose) const;
};

struct Play {
    int persons = 1;
    std::vector<std::array<Figure, 2>> frames;  ///< as the programme has it, the right hand acting
    int contact = -1;                           ///< the frame at which two persons touch, if they do
    bool mirrored = false;                      ///< the left hand is to act: sides are to be exchanged
    double facing = 180, x = 0, z = 0;          ///< how the scene is to be turned, and where it stands
};

/// At 30 frames a second, 40 to 180 of them.
Play play(const Programme& programme, const Casting& casting);

}  // namespace actformer::ingest::synth
