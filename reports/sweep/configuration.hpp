// What a training's configuration says.
#pragma once

#include <yaml-cpp/yaml.h>

#include <filesystem>
#include <string>

#include "reports/sweep/job.hpp"

namespace actformer::reports {

/// Of a key; `otherwise` where there is no such file or key, or it says no T.
template <typename T>
T in_configuration(const std::filesystem::path& file, const std::string& key, T otherwise) {
    std::error_code unread;
    if (!std::filesystem::is_regular_file(file, unread)) return otherwise;
    try {
        return YAML::LoadFile(file.string())[key].as<T>(otherwise);
    } catch (const YAML::Exception&) {
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
