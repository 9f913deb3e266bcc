// Logs: JSON objects, one a line, each with its number, `line`, from 1, and a checksum of its own (checked_json.hpp). A reader of one can
// tell which lines are as this program wrote them, and which are not there; those of earlier versions and of others, which have no
// checksum or number, are taken as they are.
#pragma once

#include <cstddef>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

namespace actformer {

/// The object, its number and its checksum as a line, with its end.
std::string checked_line(nlohmann::ordered_json object, std::size_t number);

struct CheckedLines {
    std::vector<nlohmann::ordered_json>
        objects;  ///< of the lines that are whole, in their order, without their numbers and checksums
    std::vector<std::size_t> damaged;  ///< where the others stand, from 1
    std::vector<std::size_t> missing;  ///< where lines stand before which others are missing
    bool cut_short =
        false;  ///< the last line has no end, and is no object: its writer was stopped, or is still at it

    /// "FILE: line 3: damaged", that lines are missing, or that the last one is cut short; empty where nothing is.
    std::string fault(const std::filesystem::path& file) const;
};

/// No lines where there is no file. Throws Error where it cannot be read.
CheckedLines read_checked_lines(const std::filesystem::path& path);

}  // namespace actformer
