// Logs: JSON objects, one a line, each with a checksum of its own (checked_json.hpp). Whoever reads one can tell which lines are as this
// program wrote them; those of earlier versions and of others, which have no checksum, are taken as they are.
#pragma once

#include <cstddef>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

namespace actformer {

/// The object and its checksum as a line, with its end.
std::string checked_line(const nlohmann::ordered_json& object);

struct CheckedLines {
    std::vector<nlohmann::ordered_json>
        objects;  ///< of the lines that are whole, in their order, their checksums left in
    std::vector<std::size_t> damaged;  ///< numbers of the others, from 1
    bool cut_short =
        false;  ///< the last line has no end, and is no object: its writer was stopped, or is still at it

    /// "FILE: line 3: damaged", or that its last line is cut short; empty where neither is.
    std::string fault(const std::filesystem::path& file) const;
};

/// No lines where there is no file. Throws Error where it cannot be read.
CheckedLines read_checked_lines(const std::filesystem::path& path);

}  // namespace actformer
