// A split whose name holds a byte that is no text.
#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>

#include "tests/support/temp_dir.hpp"

namespace actformer::test {

inline constexpr const char* odd_split = "\xFF";
inline constexpr const char* odd_split_in_json = "\\xFF";

/// A dataset's copy, with all of its clips in that split too.
inline void copy_with_odd_split(const std::filesystem::path& from, const std::filesystem::path& to) {
    std::filesystem::copy(from, to, std::filesystem::copy_options::recursive);
    auto json = nlohmann::json::parse(read_file(to / "dataset.json"));
    json["splits"][odd_split_in_json] = nlohmann::json::array();
    json.erase("checksum");
    json.erase("program");
    write_file(to / "dataset.json", json.dump());
}

}  // namespace actformer::test
