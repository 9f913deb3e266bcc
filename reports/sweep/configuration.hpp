// What a training's configuration says.
#pragma once

#include <yaml-cpp/yaml.h>

#include <filesystem>
#include <string>
#include <type_traits>
#include <vector>

#include "base/error.hpp"
#include "base/files/file.hpp"
#include "base/text/yaml.hpp"
#include "reports/sweep/job.hpp"

namespace actformer::reports {

/// Of a key; `otherwise` where there is no such file or key, it says no T, or the file is larger than any configuration. A text without
/// a value (`test_split:`) is empty, as for a training.
template <typename T>
T in_configuration(const std::filesystem::path& file, const std::string& key, T otherwise) {
    std::error_code unread;
    if (!std::filesystem::is_regular_file(file, unread)) return otherwise;
    std::vector<char> scratch;
    try {
        const YAML::Node root = YAML::Load(std::string(read_text(file, scratch, largest_yaml)));
        const auto said = root[key];
        if (said && said.IsNull()) return std::is_same_v<T, std::string> ? T() : otherwise;
        return said.as<T>(otherwise);
    } catch (const YAML::Exception&) {
        return otherwise;
    } catch (const Error&) {
        return otherwise;
    }
}

/// What `set`, else the configuration, says of a key; else `otherwise`.
inline std::string text_in(const Settings& set, const std::filesystem::path& config, const char* key,
                           const std::string& otherwise) {
    const auto found = set.find(key);
    return found == set.end() ? in_configuration<std::string>(config, key, otherwise) : found->second;
}

}  // namespace actformer::reports
