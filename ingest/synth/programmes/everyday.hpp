// What people do all day and in the gym, one person at a time, by name: the actions of BABEL and HumanAct12 that are none of NTU's.
#pragma once

#include <string_view>
#include <vector>

#include "ingest/synth/performer/programme.hpp"

namespace actformer::ingest::synth {

struct NamedProgramme {
    std::string_view name;
    Programme programme;
};

/// Throws Error for a name that is none.
const Programme& everyday_programme(std::string_view name);

// The tables, a file each.
std::vector<NamedProgramme> locomotion();
std::vector<NamedProgramme> postures();
std::vector<NamedProgramme> handling();

}  // namespace actformer::ingest::synth
