// Names as what is written can carry them.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace actformer::ingest {

/// What a name may consist of.
enum class NameFor : std::uint8_t {
    bvh,   ///< printable ASCII without blanks and braces
    file,  ///< printable UTF-8 that every file system takes, at most 200 bytes
    text   ///< printable UTF-8
};

/// `name` with one underscore in place of every character that it may not have, a character of several bytes being one. Never
/// empty.
std::string fit_name(std::string_view name, NameFor use);

/// All of them, those alike told apart by a number: neck, neck_2.
std::vector<std::string> fit_names(const std::vector<std::string>& names, NameFor use);

/// How many names were changed and the first of them, for a note to the user; empty where none was.
std::string names_changed(const std::vector<std::string>& before, const std::vector<std::string>& after,
                          std::string_view what);

}  // namespace actformer::ingest
