// A file for readers that take a path.
#pragma once

#include <sys/mman.h>
#include <unistd.h>

#include <string>
#include <string_view>

#include "tests/fuzz/fuzzing.hpp"

namespace actformer::fuzzing {

/// A file that lives in memory and has a path.
class FileInMemory {
  public:
    FileInMemory() : file_(::memfd_create("fuzz", 0)), path_("/proc/self/fd/" + std::to_string(file_)) {}
    ~FileInMemory() { ::close(file_); }
    FileInMemory(const FileInMemory&) = delete;
    FileInMemory& operator=(const FileInMemory&) = delete;
    void write(std::string_view bytes) const {
        demand(::ftruncate(file_, 0) == 0 &&
               ::pwrite(file_, bytes.data(), bytes.size(), 0) == static_cast<ssize_t>(bytes.size()));
    }
    const std::string& path() const { return path_; }

  private:
    int file_;
    std::string path_;
};

}  // namespace actformer::fuzzing
