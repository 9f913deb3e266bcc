// Memory that ran out while a file was read.
#pragma once

#include <filesystem>
#include <new>
#include <string>

namespace actformer {

/// Names the file. No Error: a file that there is no room for is not a bad one, which may be left out.
class NoMemoryFor : public std::bad_alloc {
  public:
    explicit NoMemoryFor(const std::filesystem::path& file)
        : text_(file.string() + ": not enough memory to read it") {}
    const char* what() const noexcept override { return text_.c_str(); }

  private:
    std::string text_;
};

}  // namespace actformer
