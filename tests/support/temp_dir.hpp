// A folder that goes away with the test.
#pragma once

#include <stdlib.h>

#include <filesystem>
#include <fstream>
#include <iterator>
#include <stdexcept>
#include <string>

namespace actformer::test {

class TempDir {
  public:
    TempDir() {
        auto name = (std::filesystem::temp_directory_path() / "actformer-test-XXXXXX").string();
        if (!mkdtemp(name.data())) throw std::runtime_error("no temporary folder");
        path_ = name;
    }
    ~TempDir() {
        std::error_code ignored;
        std::filesystem::remove_all(path_, ignored);
    }
    TempDir(const TempDir&) = delete;
    TempDir& operator=(const TempDir&) = delete;

    const std::filesystem::path& path() const { return path_; }
    std::filesystem::path operator/(const std::string& name) const { return path_ / name; }

  private:
    std::filesystem::path path_;
};

/// A file of this name is taken away first, but for its permissions: ext4 waits for the disk where one is cut to nothing and written
/// again.
inline void write_file(const std::filesystem::path& path, const std::string& text) {
    std::filesystem::create_directories(path.parent_path());
    const auto before = std::filesystem::symlink_status(path);
    const bool again = std::filesystem::is_regular_file(before);
    if (again) std::filesystem::remove(path);
    std::ofstream(path, std::ios::binary) << text;
    if (again) std::filesystem::permissions(path, before.permissions());
}

inline std::string read_file(const std::filesystem::path& path) {
    std::ifstream file(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(file), {}};
}

}  // namespace actformer::test
