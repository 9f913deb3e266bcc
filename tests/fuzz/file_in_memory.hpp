// A file for readers that take a path.
#pragma once

#include <fcntl.h>
#include <unistd.h>

#include <filesystem>
#include <string>
#include <string_view>

#include "tests/fuzz/fuzzing.hpp"

namespace actformer::fuzzing {

/// A path of this process alone, in memory where files can be there.
inline std::filesystem::path path_in_memory(std::string_view name) {
    const std::filesystem::path shared = "/dev/shm";
    const auto folder = ::access(shared.c_str(), W_OK) == 0 ? shared : std::filesystem::temp_directory_path();
    return folder / ("fuzz-" + std::string(name) + "-" + std::to_string(::getpid()));
}

/// Has a real path, without which HDF5's library opens nothing, and goes with the program unless that crashes.
class FileInMemory {
  public:
    FileInMemory()
        : path_(path_in_memory("file")),
          file_(::open(path_.c_str(), O_RDWR | O_CREAT | O_TRUNC | O_CLOEXEC | O_NOFOLLOW, 0600)) {
        demand(file_ >= 0);
    }
    ~FileInMemory() {
        ::close(file_);
        ::unlink(path_.c_str());
    }
    FileInMemory(const FileInMemory&) = delete;
    FileInMemory& operator=(const FileInMemory&) = delete;
    void write(std::string_view bytes) const {
        demand(::ftruncate(file_, 0) == 0 &&
               ::pwrite(file_, bytes.data(), bytes.size(), 0) == static_cast<ssize_t>(bytes.size()));
    }
    const std::string& path() const { return path_; }

  private:
    std::string path_;
    int file_;
};

}  // namespace actformer::fuzzing
