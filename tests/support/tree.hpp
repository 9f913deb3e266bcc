// What lies in a folder.
#pragma once

#include <filesystem>
#include <map>
#include <string>

#include "tests/support/temp_dir.hpp"

namespace actformer::test {

/// Bytes of all files by their paths below `folder`, without the locks that stay there.
inline std::map<std::string, std::string> tree(const std::filesystem::path& folder) {
    namespace fs = std::filesystem;
    std::map<std::string, std::string> files;
    for (const auto& entry : fs::recursive_directory_iterator(folder))
        if (entry.is_regular_file() && entry.path().filename() != "lock" &&
            entry.path().extension() != ".lock")
            files[fs::relative(entry.path(), folder).string()] = read_file(entry.path());
    return files;
}

}  // namespace actformer::test
