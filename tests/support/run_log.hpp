// What a training logged.
#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>
#include <sstream>
#include <string>
#include <vector>

#include "tests/support/temp_dir.hpp"

namespace actformer::test {

/// The lines of `run`'s log.jsonl.
inline std::vector<nlohmann::json> log_of(const std::filesystem::path& run) {
    std::vector<nlohmann::json> lines;
    std::istringstream text(read_file(run / "log.jsonl"));
    for (std::string line; std::getline(text, line);) lines.push_back(nlohmann::json::parse(line));
    return lines;
}

}  // namespace actformer::test
