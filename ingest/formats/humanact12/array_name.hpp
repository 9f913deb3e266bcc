// Names of HumanAct12's arrays: PssGggRrrFffffTttttAcccc, for subject, group, repetition, first and last frame of the recording, and
// class: two digits of 12 coarse ones, two more of 34 fine ones.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace actformer::ingest {

struct ArrayName {
    std::uint32_t label = 0;          ///< of the coarse class, from 0
    std::vector<std::string> fields;  ///< as array_fields names them
};

/// subject, group, repetition, first, last, action, fine
std::vector<std::string> array_fields();

/// Nothing where `stem` is not spelt so or the coarse class is not one of 01 to 12.
std::optional<ArrayName> parse_array_name(std::string_view stem);

}  // namespace actformer::ingest
